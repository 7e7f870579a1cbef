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

    frequency_hz: FrameFrequency
    damping: FrameDamping
    modal_mass_kg: ModalMass
    direction_deg: Direction
    casing_share: CasingShare = 1.0
    casing_order: FrameOrder = 1
    casing_angle_deg: Direction = 0.0


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Frame:
    """The modes through which forces of the disk's support reach housing and casing.

    One way: the frame moves sensors, and not the disk or the ring. Modes are uncoupled, as of a linear structure whose
    damping is small (Ewins, Modal Testing, 2000, chapter 2).
    """

    __repr__ = brief

    modes: Annotated[tuple[FrameMode, ...], Field(min_length=1, max_length=MOST_FRAME_MODES)]

    @property
    def memory_seconds(self) -> float:
        """Time in s after which the start of the slowest mode has decayed to 1e-4."""
        return FORGOTTEN / (2 * math.pi * min(mode.damping * mode.frequency_hz for mode in self.modes))
