"""One entry of the registry is all that a label needs: column, JSON, schema and the types of its values agree."""

import jsonschema
import pytest

from rubgen.io.columns import scalar_columns
from rubgen.labels.registry import LABELS, TAP_LABELS
from rubgen.labels.to_json import labels_to_json
from rubgen.sensors.load import default_sensor_set

TYPES = {"text": str, "flag": bool, "integer": int, "number": float}


@pytest.mark.parametrize("contact", [True, False])
def test_values_are_of_their_kind(make_synthetic_run, contact):
    labels = make_synthetic_run(contact=contact).labels
    values = labels_to_json(labels)
    for label in LABELS:
        value, kind = values[label.name], label.kind
        if kind not in TYPES:
            assert {type(one) for one in value} <= {TYPES[kind.removesuffix("s")]}, label.name
        else:
            assert value is None or type(value) is TYPES[kind], label.name
        assert label.words is None or value is None or kind != "text" or value in {word.value for word in label.words}


def test_every_label_is_one_column_with_its_unit():
    columns = {column.name: column for column in scalar_columns(default_sensor_set())}
    for label in LABELS:
        column = columns[label.name]
        kind = "class" if label.words and label.kind == "text" else label.kind
        assert (column.kind, column.unit, column.meaning) == (kind, label.unit, label.meaning)
        assert column.nullable


def test_names_are_unique_and_say_their_unit():
    names = [label.name for label in LABELS]
    assert len(set(names)) == len(names)
    ends = {"rad": "_rad", "N s": "_n_s", "s": "_s", "m": "_m", "J": "_j", "rev/min": "_rpm"}
    assert [label.name for label in LABELS if not label.name.endswith(ends.get(label.unit, ""))] == []
    assert len({label.ending for label in TAP_LABELS}) == len(TAP_LABELS)


def test_the_schema_knows_the_numbers_of_a_class():
    from schemas.make import schemas

    properties = schemas()["run.schema.json"]["properties"]
    jsonschema.validate(properties["rub_extent"]["classes"]["partial"], properties["rub_extent"])
    jsonschema.validate(properties["motion"]["classes"]["undecided"], properties["motion"])
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(-1, properties["rub_extent"])
