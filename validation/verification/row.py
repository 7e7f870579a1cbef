"""One line of the verification table."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Row:
    """A value that rubgen found beside the one that an independent source gives, in the same unit.

    `tolerance` is absolute: the row is ok when |found - expected| <= tolerance. A value that must lie in a range has
    its middle as `expected`; a bound that nothing may break is counted, with 0 expected.
    """

    quantity: str
    source: str
    expected: float
    found: float
    tolerance: float

    @property
    def ok(self) -> bool:
        """Whether the found value is within the tolerance; NaN is not."""
        return abs(self.found - self.expected) <= self.tolerance

    def as_dict(self) -> dict[str, str | float | bool]:
        """The row as `out/verification.json` holds it."""
        return {
            "quantity": self.quantity,
            "source": self.source,
            "expected": self.expected,
            "found": self.found,
            "tolerance": self.tolerance,
            "ok": self.ok,
        }


def within(quantity: str, source: str, expected: float, found: float, tolerance: float) -> Row:
    """A row with an absolute tolerance."""
    return Row(
        quantity=quantity,
        source=source,
        expected=float(expected),
        found=float(found),
        tolerance=float(tolerance),
    )


def relative(quantity: str, source: str, expected: float, found: float, share: float) -> Row:
    """A row whose tolerance is a share of the expected value's size."""
    return within(quantity, source, expected, found, share * abs(expected))
