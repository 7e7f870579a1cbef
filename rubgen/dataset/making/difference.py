"""How the data set that is there differs from the one that is asked for."""

from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Identity
from rubgen.errors import UserError


def check_same(layout: Layout, there: Identity, asked: Identity, *, versions: bool = False) -> None:
    """Raise UserError, with the first key that differs, where the directory is of another recipe.

    With `versions` the packages must be the same too.
    """
    if not there.same_recipe(asked):
        key, old, new = _first_difference(there, asked)
        raise UserError(
            f"--out {layout.root}: holds the output of another recipe ({key} = {old!r}, asked for {new!r}); "
            "give another directory"
        )
    if versions and there.packages != asked.packages:
        names = sorted(name for name in asked.packages if there.packages.get(name) != asked.packages[name])
        name = names[0] if names else "packages"
        raise UserError(
            f"--out {layout.root}: begun with {name} {there.packages.get(name)}, now it is {asked.packages.get(name)}; "
            "finish it with the old version or give another directory"
        )


def _first_difference(there: Identity, asked: Identity) -> tuple[str, object, object]:
    for part in ("recipe", "machine", "sensors"):
        old, new = _flat(getattr(there, part)), _flat(getattr(asked, part))
        for key in [*new, *old]:
            if old.get(key) != new.get(key):
                return key if part == "recipe" else f"{part}.{key}", old.get(key), new.get(key)
    return "recipe", None, None


def _flat(values: dict[str, object], prefix: str = "") -> dict[str, object]:
    flat: dict[str, object] = {}
    for key, each in values.items():
        value = _by_name(each) if isinstance(each, list) else each
        flat |= _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return flat


def _by_name(listed: list[object]) -> object:
    """A list of tables by their names or numbers; any other list as it is."""
    tables = [each for each in listed if isinstance(each, dict)]
    return {str(each.get("name", i)): each for i, each in enumerate(tables)} if len(tables) == len(listed) else listed
