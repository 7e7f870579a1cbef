"""The frame between the disk's support and what is fastened to it: bearing housing and casing."""

import math
from typing import Annotated

from pydantic import Field
from pydantic.dataclasses import dataclass

from rubgen.brief import brief
from rubgen.machine.quantities import (
    STRICT,
    CasingShare,
    Direction,
    FrameDamping,
    FrameFrequency,
    FrameOrder,
    ModalMass,
    about,
)

MOST_FRAME_MODES = 64
FORGOTTEN = math.log(1e4)
"""Number of time constants after which a start has decayed to 1e-4."""


@dataclass(frozen=True, kw_only=True, config=STRICT)
class FrameMode:
    """One mode of the frame, a damped oscillator that the force of the disk on its support drives.

    The bearing housing moves by q along `direction_deg`: q'' + 2 d w q' + w^2 q = F / m, with w = 2 pi `frequency_hz`,
    d the `damping` ratio, F the force along that direction, and m the `modal_mass_kg`, the mass that moves with the
    housing. The casing moves radially outward by `casing_share` q cos(`casing_order` (phi - `casing_angle_deg`)) at
    the polar angle phi.
    """

    frequency_hz: Annotated[
        FrameFrequency, about("Natural frequency of the mode. Take it from a modal test or a model of the frame.")
    ]
    damping: Annotated[FrameDamping, about("Damping ratio of the mode. A lower one lets the mode ring longer.")]
    modal_mass_kg: Annotated[
        ModalMass, about("Mass that moves with the bearing housing. A smaller one makes a louder mode.")
    ]
    direction_deg: Annotated[Direction, about("Direction in which the bearing housing moves, from +X.")]
    casing_share: Annotated[
        CasingShare,
        about("Motion of the casing over that of the housing, at its largest. 0 keeps the mode off the casing."),
    ] = 1.0
    casing_order: Annotated[
        FrameOrder,
        about(
            "Number of waves of the casing's motion around it. 0 breathes, 1 moves the casing as a "
            "whole, 2 makes it oval."
        ),
    ] = 1
    casing_angle_deg: Annotated[
        Direction, about("Angle of the first largest outward motion of the casing, from +X.")
    ] = 0.0


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Frame:
    """The modes through which forces of the disk's support reach housing and casing.

    The frame moves sensors, but not the disk or the ring. Modes are uncoupled, as of a linear structure whose damping
    is small (Ewins, Modal Testing, 2000, chapter 2).
    """

    __repr__ = brief

    modes: Annotated[
        tuple[FrameMode, ...], Field(min_length=1, max_length=MOST_FRAME_MODES), about("The modes of the frame.")
    ]

    @property
    def memory_seconds(self) -> float:
        """Time in s after which the free motion of the slowest mode has decayed to 1e-4."""
        return FORGOTTEN / (2 * math.pi * min(mode.damping * mode.frequency_hz for mode in self.modes))
