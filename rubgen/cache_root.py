"""Where rubgen keeps what it would otherwise make anew: compiled kernels and reduced blisks."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs

CACHE_VARIABLE = "RUBGEN_CACHE_DIR"


def cache_root() -> Path:
    """The folder of all caches: $RUBGEN_CACHE_DIR, or the user's cache folder of rubgen."""
    return Path(os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_dir("rubgen"))
