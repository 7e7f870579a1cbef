"""Describe columns to Hugging Face's `datasets`, in the metadata of an Arrow schema.

`datasets` reads the key `huggingface` of the schema (`Features.from_arrow_schema`). A class becomes a ClassLabel, whose
numbers are the places of its names; -1 is no class.
"""

import json
from collections.abc import Iterable
from typing import Any

import pyarrow as pa

from rubgen.io.columns import Column
from rubgen.labels.classes import class_numbers

DTYPES = {"double": "float64", "float": "float32"}
"""Names of Arrow types that differ from those of `datasets`."""


def features_json(columns: Iterable[Column], fields: Iterable[pa.Field]) -> str:
    """Return the value of the metadata key `huggingface`, as JSON: the features of `columns`.

    `fields` are the Arrow fields of the columns, in the same order.
    """
    features = {column.name: _feature(column, field.type) for column, field in zip(columns, fields, strict=True)}
    return json.dumps({"info": {"features": features}})


def is_list(kind: pa.DataType) -> bool:
    """Return whether an Arrow type is that of lists, of any or of one length."""
    return bool(pa.types.is_list(kind) or pa.types.is_fixed_size_list(kind))


def _feature(column: Column, kind: pa.DataType) -> dict[str, Any]:
    if is_list(kind):
        length = kind.list_size if pa.types.is_fixed_size_list(kind) else -1
        return {"feature": _feature(column, kind.value_type), "length": length, "_type": "Sequence"}
    if column.words:
        numbers = class_numbers(column.words)
        return {"names": [word for word, number in numbers.items() if number >= 0], "_type": "ClassLabel"}
    return {"dtype": DTYPES.get(str(kind), str(kind)), "_type": "Value"}
