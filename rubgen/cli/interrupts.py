"""Ctrl-C and a polite kill, which end every command in the same way."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any


@contextmanager
def terminable() -> Iterator[None]:
    """A polite kill raises KeyboardInterrupt, and so does Ctrl-C where the shell has switched it off.

    Compiled code of other libraries may swallow the exception and fail later with one of its own: what is raised after
    an interrupt is that interrupt. Signals can be handled in the main thread alone; elsewhere nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came = False

    def interrupt(_signal: int, _frame: FrameType | None) -> None:
        nonlocal came
        came = True
        raise KeyboardInterrupt

    def swallowed(problem: Any) -> None:
        if not came:
            said(problem)

    saved = {name: signal.signal(name, interrupt) for name in (signal.SIGTERM, signal.SIGINT)}
    said, sys.unraisablehook = sys.unraisablehook, swallowed
    try:
        yield
    except Exception:
        if came:
            raise KeyboardInterrupt from None
        raise
    finally:
        sys.unraisablehook = said
        for name, handler in saved.items():
            signal.signal(name, handler)
