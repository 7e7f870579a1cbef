"""Describe a data set in Croissant 1.0 (JSON-LD), for machine-learning tools."""

import re
from typing import Any

from rubgen.dataset.files import sha256_of, write_json
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Identity
from rubgen.io.columns import Column, scalar_columns, signal_columns

PARQUET = "application/x-parquet"
TYPES = {
    "text": "sc:Text",
    "texts": "sc:Text",
    "flag": "sc:Boolean",
    "class": "sc:Integer",
    "integer": "sc:Integer",
    "number": "sc:Float",
    "integers": "sc:Integer",
    "numbers": "sc:Float",
    "signal": "sc:Float",
}
_OTHER = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "conformsTo": "dct:conformsTo",
    "cr": "http://mlcommons.org/croissant/",
    "rai": "http://mlcommons.org/croissant/RAI/",
    "data": {"@id": "cr:data", "@type": "@json"},
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "dct": "http://purl.org/dc/terms/",
    "examples": {"@id": "cr:examples", "@type": "@json"},
    "sc": "https://schema.org/",
}
"""Terms that are not of Croissant's own vocabulary, or of a type."""
_TERMS = """
    @language @vocab citeAs column conformsTo cr rai data dataType dct equivalentProperty examples extract field
    fileProperty fileObject fileSet format includes isLiveDataset jsonPath key md5 parentField path recordSet
    references regex repeated replace samplingRate sc separator source subField transform
"""
CONTEXT: dict[str, Any] = {term: _OTHER.get(term, f"cr:{term}") for term in _TERMS.split()}


def write_croissant(layout: Layout, identity: Identity) -> None:
    """Write croissant.json beside the files that it describes. `runs.parquet` must be there: its sha256 is named."""
    write_json(layout.croissant, croissant(layout, identity))


def croissant(layout: Layout, identity: Identity) -> dict[str, Any]:
    """Describe a data set as a JSON-LD object of Croissant 1.0.

    It has the record set `runs`, and `signals` where the set has Parquet data. `runs.parquet` is read for its sha256.
    """
    recipe = identity.recipe
    runs_file = {
        "@type": "cr:FileObject",
        "@id": "runs.parquet",
        "name": "runs.parquet",
        "contentUrl": layout.runs.name,
        "encodingFormat": PARQUET,
        "sha256": sha256_of(layout.runs),
    }
    distribution = [runs_file]
    around, faults = "surroundings" in recipe, identity.fault_kinds
    scalars = scalar_columns(
        identity.sensor_set, surroundings=around, faults=faults, machines=identity.machine_keys, drawing=recipe
    )
    records = [_record_set("runs", scalars, {"fileObject": {"@id": "runs.parquet"}})]
    if "parquet" in recipe["output"]["formats"]:
        includes = "data/*.parquet"
        distribution.append({"@type": "cr:FileSet", "@id": "data", "includes": includes, "encodingFormat": PARQUET})
        signals = signal_columns(identity.sensor_set, clean=recipe["sensors"]["keep_clean"])
        records.append(_record_set("signals", scalars + signals, {"fileSet": {"@id": "data"}}))
    sections = "sections/*.parquet"
    distribution.append({"@type": "cr:FileSet", "@id": "sections", "includes": sections, "encodingFormat": PARQUET})
    return {
        "@context": CONTEXT,
        "@type": "sc:Dataset",
        "name": recipe["name"],
        "description": f"{recipe['runs']} simulated runs of a bladed disk that may rub its flexible oval casing.",
        "conformsTo": "http://mlcommons.org/croissant/1.0",
        "license": recipe["license"],
        "version": _semantic(identity.packages["rubgen"]),
        "distribution": distribution,
        "recordSet": records,
    }


def _record_set(name: str, columns: tuple[Column, ...], source: dict[str, Any]) -> dict[str, Any]:
    fields = [_field(name, column, source) for column in columns]
    return {"@type": "cr:RecordSet", "@id": name, "name": name, "key": {"@id": f"{name}/run_id"}, "field": fields}


def _field(record_set: str, column: Column, source: dict[str, Any]) -> dict[str, Any]:
    unit = f", in {column.unit}" if column.unit else ""
    field: dict[str, Any] = {
        "@type": "cr:Field",
        "@id": f"{record_set}/{column.name}",
        "name": column.name,
        "description": f"{column.meaning}{unit}",
        "dataType": TYPES[column.kind],
        "source": {**source, "extract": {"column": column.name}},
    }
    return field | ({"repeated": True} if column.kind in ("texts", "integers", "numbers", "signal") else {})


def _semantic(version: str) -> str:
    """Return the three leading numbers of a version: Croissant allows no more."""
    return ".".join([*re.findall(r"\d+", version), "0", "0"][:3])
