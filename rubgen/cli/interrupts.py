"""Make Ctrl-C and SIGTERM end every command in the same way."""

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any


@contextmanager
def terminable() -> Iterator[None]:
    """Raise KeyboardInterrupt in the block for SIGTERM and SIGINT (Ctrl-C), also where the shell ignores SIGINT.

    Compiled code of other libraries may swallow or print this exception, and fail later with an exception of its own.
    After a signal, messages of these libraries are not printed, and KeyboardInterrupt is raised in place of their
    exception. The handlers from before the block are restored after it. Outside the main thread, which cannot handle
    signals, nothing is changed.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came = False

    def interrupt(_signal: int, _frame: FrameType | None) -> None:
        nonlocal came
        came = True
        raise KeyboardInterrupt

    def unless_it_came(hook: Callable[..., object]) -> Callable[..., None]:
        def said(*problem: Any) -> None:
            if not came:
                hook(*problem)

        return said

    saved = {name: signal.signal(name, interrupt) for name in (signal.SIGTERM, signal.SIGINT)}
    hooks = sys.unraisablehook, sys.excepthook
    sys.unraisablehook, sys.excepthook = unless_it_came(sys.unraisablehook), unless_it_came(sys.excepthook)
    try:
        yield
    except Exception:
        if came:
            raise KeyboardInterrupt from None
        raise
    finally:
        sys.unraisablehook, sys.excepthook = hooks
        for name, handler in saved.items():
            signal.signal(name, handler)
