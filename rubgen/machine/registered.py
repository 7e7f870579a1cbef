"""Find the laws that are registered as keys of a record: a field of the type `SomeLaw | None`."""

from typing import Any, get_args, get_type_hints


def registered(record: Any, law: Any) -> dict[str, Any]:
    """Return L by field name, for each field of the class `record` with a type `L | None`, L a subclass of `law`."""
    return {
        key: kind
        for key, hint in get_type_hints(record).items()
        for kind in get_args(hint)
        if isinstance(kind, type) and issubclass(kind, law)
    }


def given(record: Any, law: Any) -> dict[str, Any]:
    """Return the values of the fields of `record` that are laws, by field name. Fields that are None are left out."""
    values = {key: getattr(record, key) for key in registered(type(record), law)}
    return {key: value for key, value in values.items() if value is not None}
