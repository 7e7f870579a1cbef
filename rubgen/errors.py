"""Errors that are addressed to the user."""

from __future__ import annotations

import warnings


class RubgenError(Exception):
    """Base of every error that rubgen raises on purpose."""


class UserError(RubgenError):
    """A mistake in what the user gave: one line that says where, what, what is allowed and how to mend it.

    The command line prints the message alone and exits with 2.
    """


class RubgenWarning(UserWarning):
    """What is allowed but surely not meant, or was done in another way than asked: one line, and the work goes on.

    The command line prints the message alone on stderr.
    """


def warn(message: str) -> None:
    """Warn the user in one line, whatever called this."""
    warnings.warn(message, RubgenWarning, stacklevel=2)
