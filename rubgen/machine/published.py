"""Values that Zeng et al. (2019) published of their machine, doi 10.1016/j.ast.2019.105481, for comparison."""

BLISK_HZ = {
    1: 68.55,
    2: 68.55,
    3: 143.65,
    4: 143.65,
    5: 155.37,
    39: 164.43,
    40: 164.43,
    41: 210.60,
    42: 417.32,
}
"""Natural frequencies at rest by the number of the mode, counted from 1: tilt twice, lateral twice, blade umbrella,
blades with one nodal diameter twice, axial, torsion."""
CASING_HZ = (180.98, 181.04, 181.05, 181.22, 181.54, 181.99, 181.99, 183.35, 183.36, 186.54, 186.54)


def blisk_deviation(frequencies_hz: list[float]) -> dict[int, float]:
    """Return the relative deviation of blisk frequencies (ascending, Hz) from the published values, by mode from 1."""
    return {mode: frequencies_hz[mode - 1] / hz - 1 for mode, hz in BLISK_HZ.items() if mode <= len(frequencies_hz)}


def casing_deviation(frequencies_hz: list[float]) -> dict[int, float]:
    """Return the relative deviation of casing frequencies (ascending, Hz) from the published values, by mode from 1."""
    pairs = zip(frequencies_hz, CASING_HZ, strict=False)
    return {mode: hz / published - 1 for mode, (hz, published) in enumerate(pairs, start=1)}
