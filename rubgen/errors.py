"""Errors that are addressed to the user."""

from __future__ import annotations


class RubgenError(Exception):
    """Base of every error that rubgen raises on purpose."""


class UserError(RubgenError):
    """A mistake in what the user gave: one line that says where, what, what is allowed and how to mend it.

    The command line prints the message alone and exits with 2.
    """
