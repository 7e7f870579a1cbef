"""The sample in datasets/ is small, sound, made from its recipe, and today's code makes its rub again."""

from pathlib import Path

import rubgen
from rubgen.dataset.making.regenerate import regenerate
from rubgen.dataset.manifest import identity_of
from rubgen.scenario.load import RECIPES

SAMPLE = Path(__file__).parents[2] / "datasets/sample"


def test_the_sample_is_below_one_megabyte():
    assert sum(path.stat().st_size for path in SAMPLE.rglob("*") if path.is_file()) < 1_000_000


def test_the_sample_is_that_of_its_recipe_and_sound():
    identity = rubgen.open(SAMPLE).manifest.identity
    assert identity.same_recipe(identity_of(rubgen.load_recipe(RECIPES / "sample.toml")))
    assert rubgen.verify(SAMPLE) == []


def test_a_rub_of_the_sample_is_made_again():
    runs = rubgen.open(SAMPLE).runs
    regular = runs.index[runs["rub"] & (runs["motion"] == "period-1")]
    assert len(regular) > 0
    assert runs["rub"].nunique() == 2
    assert regenerate(SAMPLE, regular[0]).moved == []
