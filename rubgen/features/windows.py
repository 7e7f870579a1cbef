"""Cut a recording into windows of a time or of whole turns."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.features.turns import within

LEAST_SAMPLES = 64
"""The fewest samples in a window that features are computed from."""


@dataclass(frozen=True)
class Window:
    """The length of a window, in s or in turns. Windows follow each other without a gap; a shorter rest is left out."""

    length: float
    unit: Literal["s", "turns"]

    def __str__(self) -> str:
        return f"{self.length:g}{self.unit}"

    def cuts(self, samples: int, rate_hz: float, pulses: FloatArray) -> list[tuple[int, int]]:
        """Return first sample and number of samples of each window of a signal with `samples` samples.

        `rate_hz` is the sample rate. `pulses` are the times of the pulses in s from the first sample. A window of turns
        begins with the last sample at or before its first pulse, and ends with the first sample at or after its last
        pulse: two successive windows share one or two samples. The list is empty if the signal has no whole window.
        """
        if self.unit == "s":
            size = round(self.length * rate_hz)
            return [(size * number, size) for number in range(samples // size)]
        places = within(pulses, samples, rate_hz)[:: int(self.length)] * rate_hz
        first = np.maximum(np.floor(places), 0).astype(int)
        last = np.minimum(np.ceil(places), samples - 1).astype(int)
        return [(int(a), int(b - a + 1)) for a, b in zip(first[:-1], last[1:], strict=True)]

    def longest(self, samples: int, rate_hz: float, pulses: FloatArray) -> str:
        """Return the length of the longest possible window of a signal, in this window's unit: "1s" or "100turns".

        The signal has `samples` samples at `rate_hz`. `pulses` are the times of the pulses in s from the first sample.
        """
        if self.unit == "s":
            return f"{samples / rate_hz:g}s"
        return f"{max(within(pulses, samples, rate_hz).size - 1, 0)}turns"


def parse_window(text: str, rate_hz: float) -> Window:
    """Read a length such as "0.25s" or "16turns". Raises UserError for any other text and for too short a window.

    A window has at least one turn, or at least LEAST_SAMPLES samples at the sample rate `rate_hz`.
    """
    found = re.fullmatch(r"(\d+\.?\d*|\.\d+) ?(s|turns?)", text.strip())
    if not found:
        raise UserError(f"--window {text:.40}: unknown length; give seconds such as 0.25s, or turns such as 16turns")
    length = float(found[1])
    if found[2] != "s":
        if length < 1 or length != int(length):
            raise UserError(f"--window {text}: must be whole turns, at least one; give for example 16turns")
        return Window(length, "turns")
    if round(length * rate_hz) < LEAST_SAMPLES:
        least = f"{LEAST_SAMPLES / rate_hz:g}s"
        raise UserError(
            f"--window {text}: has fewer than {LEAST_SAMPLES} samples at {rate_hz:g} Hz; give {least} or more"
        )
    return Window(length, "s")
