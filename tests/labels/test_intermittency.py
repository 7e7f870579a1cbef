import numpy as np
import pytest

from rubgen.labels.motion.intermittency import is_intermittent, segments

TURNS = 500


def logistic(r: float) -> np.ndarray:
    x, orbit = 0.3, []
    for _ in range(TURNS + 1000):
        x = r * x * (1 - x)
        orbit.append(x)
    return np.array(orbit[1000:])


def part(values: np.ndarray) -> list[np.ndarray]:
    return [values[:, None, None]]


def test_made_stretches_are_found_with_their_turns() -> None:
    values = np.tile([0.2, 0.7], 250)
    chaos = logistic(4.0)
    for first, last in ((100, 160), (300, 420)):
        values[first:last] = chaos[first:last]
    found = segments(part(values))
    assert [segment.period for segment in found] == [2, 0, 2, 0, 2]
    assert [segment.start for segment in found] == pytest.approx([0, 100, 160, 300, 420], abs=3)
    assert (found[0].start, found[-1].end) == (0, TURNS)
    assert is_intermittent(found)


def test_type_1_intermittency_beside_the_period_3_window() -> None:
    # Pomeau and Manneville 1980: below r = 1 + sqrt(8) the orbit stays near period 3 for long, then bursts.
    for r in (3.8282, 3.828):
        found = segments(part(logistic(r)))
        assert is_intermittent(found)
        assert 3 in {segment.period for segment in found}
    assert not is_intermittent(segments(part(logistic(3.835))))


@pytest.mark.parametrize("r", [4.0, 3.9, 3.5])
def test_chaos_all_along_and_periods_do_not_switch(r: float) -> None:
    assert not is_intermittent(segments(part(logistic(r))))


def test_a_short_disturbance_is_no_switching() -> None:
    values = np.ones(TURNS)
    values[250:255] = [0.0, 0.5, 0.9, 0.1, 0.3]
    assert [segment.period for segment in segments(part(values))] == [1]
    values[200:225] = logistic(4.0)[:25]
    assert not is_intermittent(segments(part(values)))  # a twentieth of the record
