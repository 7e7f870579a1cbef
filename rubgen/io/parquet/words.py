"""Words of classes for people, and their numbers for files."""

from collections.abc import Mapping

import pyarrow as pa
import pyarrow.compute as pc

from rubgen.labels.classes import class_numbers
from rubgen.labels.registry import LABELS

NUMBERS = {label.name: class_numbers(label.words) for label in LABELS if label.words and label.kind == "text"}
"""Number of each word, by the name of the column."""


def with_numbers(row: Mapping[str, object]) -> dict[str, object]:
    """Return a row of labels with numbers in place of the words of classes, as in files. None stays None."""
    return {
        name: NUMBERS[name][str(value)] if name in NUMBERS and value is not None else value
        for name, value in row.items()
    }


def with_words(table: pa.Table) -> pa.Table:
    """Return a table with words in place of the numbers of classes, in columns with the name and type of a class.

    A number that is no class of the column becomes the text "class" and the number. Null stays null.
    """
    for place, name in enumerate(table.column_names):
        if name in NUMBERS and pa.types.is_integer(table.schema.field(name).type):
            table = table.set_column(place, pa.field(name, pa.string()), _words(table[name], NUMBERS[name]))
    return table


def _words(column: pa.ChunkedArray, numbers: Mapping[str, int]) -> pa.ChunkedArray:
    place = pc.index_in(column, pa.array(numbers.values(), column.type))
    words = pc.take(pa.array(list(numbers)), place)
    return pc.coalesce(words, pc.binary_join_element_wise("class", column.cast(pa.string()), " "))
