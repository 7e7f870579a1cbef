"""Scenario, labels and descriptions of channels in an MCAP file, as types."""

import math
from functools import cache
from typing import Annotated, Any

from mcap.records import Channel
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from rubgen.io.mcap.content import McapContent
from rubgen.io.mcap.records import DamageError
from rubgen.labels.labels import Motion
from rubgen.scenario import Scenario

MOST_SAMPLES = 2**28
"""Largest number of samples of all channels of a file: a gigabyte."""

Whole = Annotated[int, Field(ge=-(2**63), lt=2**63, strict=True)]
Number = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Single = bool | Whole | Number | None
LabelName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,99}$")]
LabelValue = Single | Annotated[str, Field(max_length=200)] | list[Single]


class RequiredLabels(BaseModel):
    """Labels without which a run cannot be shown."""

    model_config = ConfigDict(strict=False, extra="ignore")
    rub: Annotated[bool, Field(strict=True)]
    motion: Motion
    motion_blisk: Motion
    motion_casing: Motion


class ChannelFacts(BaseModel):
    """Metadata of a channel of samples; MCAP has them as text."""

    model_config = ConfigDict(extra="ignore")
    unit: str
    quantity: str
    axis: str
    location: str
    range_min: Annotated[float, Field(allow_inf_nan=False)]
    range_max: Annotated[float, Field(allow_inf_nan=False)]
    resolution: Annotated[float, Field(allow_inf_nan=False, ge=0)]
    noise_rms: Annotated[float, Field(allow_inf_nan=False, ge=0)] = 0.0


def checked_scenario(content: McapContent) -> tuple[dict[str, Any], Scenario]:
    """The scenario as in the file, and as a `Scenario`. Raises DamageError where this rubgen cannot read it."""
    plain = content.document("scenario.json")
    scenario: Scenario = _validated(_adapter(Scenario), plain, "its scenario is of another rubgen")
    samples = scenario.signal_seconds * scenario.sensing.sample_rate_hz
    if not 0 < samples * max(len(content.topics("/raw/")) + len(content.topics("/clean/")), 1) <= MOST_SAMPLES:
        raise DamageError(f"its scenario asks {samples:.3g} samples a channel; that is no run of rubgen")
    return plain, scenario


def checked_labels(content: McapContent) -> dict[str, Any]:
    """The labels, each a value or a list of values. Raises DamageError where they are not labels."""
    labels = content.document("labels.json")
    _validated(_adapter(dict[LabelName, LabelValue]), labels, "labels.json is not what rubgen writes")
    _validated(_adapter(RequiredLabels), labels, "labels.json is not what rubgen writes")
    return labels


def check_facts(channel: Channel) -> None:
    """Raise DamageError where unit, place or range of a channel is missing or wrong."""
    facts: ChannelFacts = _validated(_adapter(ChannelFacts), channel.metadata, f"metadata of {channel.topic}")
    if not math.isfinite(facts.range_max - facts.range_min) or facts.range_max < facts.range_min:
        raise DamageError(f"metadata of {channel.topic}: the range is empty")


def _validated(adapter: TypeAdapter[Any], values: object, what: str) -> Any:
    try:
        return adapter.validate_python(values)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])[:100]
        raise DamageError(f"{what} ({where}: {' '.join(first['msg'].split())[:150]})") from None


@cache
def _adapter(kind: Any) -> TypeAdapter[Any]:
    return TypeAdapter(kind)
