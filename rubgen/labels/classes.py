"""Numbers of classes: every label whose value is one of a few words has a fixed integer for each word.

The numbers are the same in every data set, whichever classes it has. They never change; a new class gets a new number.
"""

from enum import StrEnum

from rubgen.labels.labels import Motion

MOTION_CLASSES: dict[str, int] = {
    Motion.PERIOD_1.value: 0,
    Motion.PERIOD_K.value: 1,
    Motion.QUASI_PERIODIC.value: 2,
    Motion.CHAOTIC.value: 3,
    Motion.STATIC.value: 4,
    Motion.UNDECIDED.value: -1,
}
"""Number of each class of motion. Only a casing is static. -1 is, as for most libraries, the absence of a class."""


def class_numbers(words: type[StrEnum]) -> dict[str, int]:
    """Return the number of each word of a class label: MOTION_CLASSES for motions, else the position in `words`."""
    if words is Motion:
        return MOTION_CLASSES
    return {member.value: number for number, member in enumerate(words)}
