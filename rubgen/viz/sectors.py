"""Sectors of the casing."""

import numpy as np

from rubgen.arrays import FloatArray, IntArray


def sector_of(angle: FloatArray, sectors: int) -> IntArray:
    """Number of the sector, of so many equal ones, in which each polar angle (rad) lies; sector 0 lies about 0."""
    width = 2 * np.pi / sectors
    return np.floor(np.mod(angle + width / 2, 2 * np.pi) / width).astype(np.int64) % sectors
