"""Read lists of names from options."""

from rubgen.errors import UserError


def names_in(option: str, text: str | None) -> list[str] | None:
    """Return the names in `text`, which have commas between them; None for None.

    Raises UserError, which names `option`, where a name is empty.
    """
    if text is None:
        return None
    names = [name.strip() for name in text.split(",")]
    if not all(names):
        raise UserError(f"{option} {text!r:.60}: has an empty name; give names with commas between them")
    return names
