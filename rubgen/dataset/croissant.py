"""Describe a data set in Croissant 1.1 (JSON-LD) with RAI and provenance, for machine-learning tools."""

import re
from pathlib import Path
from typing import Any

import pyarrow as pa

from rubgen.dataset.files import sha256_of, write_json
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Identity
from rubgen.dataset.tables import RUNS, SECTIONS, tables_of
from rubgen.dataset.tally import Tally, tally_of
from rubgen.io.columns import Role
from rubgen.io.parquet.features import is_list
from rubgen.io.parquet.sensors import SENSORS_SCHEMA
from rubgen.labels import MOTION_CLASSES

PARQUET = "application/x-parquet"
TYPES = {"string": "sc:Text", "bool": "sc:Boolean", "int64": "sc:Integer", "double": "sc:Float", "float": "sc:Float"}
_OTHER = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "conformsTo": "dct:conformsTo",
    "cr": "http://mlcommons.org/croissant/",
    "rai": "http://mlcommons.org/croissant/RAI/",
    "prov": "http://www.w3.org/ns/prov#",
    "data": {"@id": "cr:data", "@type": "@json"},
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "dct": "http://purl.org/dc/terms/",
    "description": {"@container": "@language"},
    "examples": {"@id": "cr:examples", "@type": "@json"},
    "name": {"@container": "@language"},
    "sc": "https://schema.org/",
}
"""Terms that are not of Croissant's own vocabulary, or of a type."""
_TERMS = """
    @language @vocab arrayShape citeAs column conformsTo containedIn cr rai prov data dataType dct description
    equivalentProperty examples extract field fileProperty fileObject fileSet format includes isArray isLiveDataset
    jsonPath key md5 name parentField path recordSet references regex repeated replace samplingRate sc separator source
    subField transform
"""
CONTEXT: dict[str, Any] = {term: _OTHER.get(term, f"cr:{term}") for term in _TERMS.split()}
PUBLISHED = "2026-11-28"
"""Date of this version of rubgen. A set has no date of its own: its bytes follow from the recipe and the versions."""
PAPER = "https://doi.org/10.1016/j.ast.2019.105481"
CITATION = (
    "@misc{{rubgen, title={{{name}: labelled blade-rub data from a finite-element blisk in a flexible casing}}, "
    "author={{The rubgen developers}}, note={{made with rubgen {version}}}, year={{2026}}}}"
)


def write_croissant(layout: Layout, identity: Identity) -> None:
    """Write croissant.json of a data set.

    `runs.parquet` and `sensors.parquet` must exist: they are read for their sha256.
    """
    write_json(layout.croissant, croissant(layout, identity))


def croissant(layout: Layout, identity: Identity) -> dict[str, Any]:
    """Describe a data set as a JSON-LD object of Croissant 1.1.

    It has a record set for `runs`, for `sensors` and for each table of the set but `sections`, one for the splits and
    one for the classes of motion. `runs.parquet` and `sensors.parquet` are read for their sha256, and the runs are
    counted.
    """
    recipe, recorded = identity.recipe, identity.recorded()
    version = identity.packages["rubgen"]
    tally = tally_of(layout.runs)
    distribution = [_file(layout.runs), _file(layout.sensors)]
    records = [
        _record_set("runs", RUNS.schema(recorded), {"fileObject": {"@id": "runs.parquet"}}),
        _record_set("sensors", SENSORS_SCHEMA, {"fileObject": {"@id": "sensors.parquet"}}),
    ]
    for table in tables_of(recipe["output"]["formats"]):
        file_set = {"@type": "cr:FileSet", "@id": f"{table.name}-files", "includes": f"{table.name}/*.parquet"}
        distribution.append({**file_set, "encodingFormat": PARQUET})
        if table is not SECTIONS:
            records.append(_record_set(table.name, table.schema(recorded), {"fileSet": {"@id": f"{table.name}-files"}}))
    return {
        "@context": CONTEXT,
        "@type": "sc:Dataset",
        "name": recipe["name"],
        "description": f"{recipe['runs']} simulated runs of a bladed disk that may rub its flexible oval casing.",
        "conformsTo": ["http://mlcommons.org/croissant/1.1", "http://mlcommons.org/croissant/RAI/1.0"],
        "license": recipe["license"],
        "version": _semantic(version),
        "datePublished": PUBLISHED,
        "creator": {"@type": "sc:Organization", "name": "The rubgen developers"},
        "citeAs": CITATION.format(name=recipe["name"], version=version),
        "keywords": ["blade rub", "rotordynamics", "condition monitoring", "time series", "simulation"],
        **_responsible(tally),
        "prov:wasDerivedFrom": {"@id": PAPER},
        "prov:wasGeneratedBy": {"@type": "prov:Activity", "prov:wasAssociatedWith": f"rubgen {version}"},
        "distribution": distribution,
        "recordSet": [_splits(tally), _classes(), *records],
    }


def _responsible(tally: Tally) -> dict[str, Any]:
    """Return what RAI asks about: where the data come from, what is missing, what they are for."""
    failed = sum(each.runs - each.status["ok"] for each in tally.splits.values())
    runs = sum(each.runs for each in tally.splits.values())
    rarer = ", ".join(f"{x.key} {x.good:.4g} against {x.failed:.4g} {x.unit}".rstrip() for x in tally.shifts)
    where = f" Means of good against failed runs: {rarer}." if rarer else ""
    return {
        "rai:dataCollection": "Simulated: finite elements, reduced, integrated through contact with friction; virtual "
        "sensors with noise, range and ADC. No plant was measured and no person is concerned.",
        "rai:dataCollectionType": ["Software Collection"],
        "rai:dataCollectionMissingData": f"{failed} of {runs} runs failed and have no signals.{where}",
        "rai:dataAnnotationProtocol": "Labels come from the true motion, never from the recorded channels.",
        "rai:dataBiases": [
            "Runs that fail are missing, mostly the most severe rubs.",
            "Sensors and labels are known better than in the field, and conditions have the shares of the recipe.",
            "Windows of one run, and runs of one machine, are nearly equal: split by machine_id, never at random.",
        ],
        "rai:dataLimitations": "Linear ring, no heat, one contact point a blade. Learn, do not certify with it.",
        "rai:dataUseCases": ["Learning and testing of detection, severity, place and kind of blade rubs and faults."],
        "rai:personalSensitiveInformation": ["None."],
    }


def _file(path: Path) -> dict[str, Any]:
    return {
        "@type": "cr:FileObject",
        "@id": path.name,
        "name": path.name,
        "contentUrl": path.name,
        "encodingFormat": PARQUET,
        "sha256": sha256_of(path),
    }


def _splits(tally: Tally) -> dict[str, Any]:
    return {
        "@type": "cr:RecordSet",
        "@id": "splits",
        "name": "splits",
        "description": "Splits of the set. A machine is in one split alone.",
        "dataType": "cr:Split",
        "key": {"@id": "splits/name"},
        "field": [{"@type": "cr:Field", "@id": "splits/name", "name": "name", "dataType": "sc:Text"}],
        "data": [{"splits/name": name} for name in tally.splits],
    }


def _classes() -> dict[str, Any]:
    fields = (("number", "sc:Integer"), ("name", "sc:Text"))
    return {
        "@type": "cr:RecordSet",
        "@id": "motion_classes",
        "name": "motion_classes",
        "description": "Numbers of the classes of motion, the same in every set; -1 is no class.",
        "dataType": "sc:Enumeration",
        "key": {"@id": "motion_classes/number"},
        "field": [
            {"@type": "cr:Field", "@id": f"motion_classes/{name}", "name": name, "dataType": kind}
            for name, kind in fields
        ],
        "data": [
            {"motion_classes/number": number, "motion_classes/name": word} for word, number in MOTION_CLASSES.items()
        ],
    }


def _record_set(name: str, types: pa.Schema, source: dict[str, Any]) -> dict[str, Any]:
    fields = [_field(name, field, source) for field in types]
    keys = [{"@id": f"{name}/{key}"} for key in ("run_id", "window", "channel") if key in types.names]
    return {
        "@type": "cr:RecordSet",
        "@id": name,
        "name": name,
        "key": keys if len(keys) > 1 else keys[0],
        "field": fields,
    }


def _field(record_set: str, column: pa.Field, source: dict[str, Any]) -> dict[str, Any]:
    facts = {key.decode(): value.decode() for key, value in column.metadata.items()}
    role = facts.get("role", "")
    notes = [facts["meaning"], *([f"in {facts['unit']}"] if facts.get("unit") else []), *([role] if role else [])]
    notes += [f"classes {facts['classes']}"] if "classes" in facts else []
    listed = is_list(column.type)
    kind = TYPES[str(column.type.value_type if listed else column.type)]
    kinds = [kind, *_MEANT.get(column.name, []), *(["cr:Label"] if role == Role.TARGET.value else [])]
    field: dict[str, Any] = {
        "@type": "cr:Field",
        "@id": f"{record_set}/{column.name}",
        "name": column.name,
        "description": ", ".join(notes),
        "dataType": kinds if len(kinds) > 1 else kind,
        "source": {**source, "extract": {"column": column.name}},
    }
    if not listed:
        return field
    shape = column.type.list_size if pa.types.is_fixed_size_list(column.type) else -1
    return field | {"isArray": True, "arrayShape": str(shape)}


_MEANT = {"split": ["cr:Split"]}
"""What the columns of that name are to Croissant."""


def _semantic(version: str) -> str:
    """Return the three leading numbers of a version: Croissant allows no more."""
    return ".".join([*re.findall(r"\d+", version), "0", "0"][:3])
