"""Laws of the normal contact force: which one a table `[contact]` chooses, and what they may use."""

import math
import sys
from dataclasses import dataclass

import numpy as np
import pytest
from pydantic import ValidationError
from pydantic.dataclasses import dataclass as validated_dataclass

from rubgen.machine.quantities import STRICT
from rubgen.machine.registered import registered
from rubgen.scenario import ContactLaw
from rubgen.scenario.contact_laws.contact_law import NORMAL_LAWS
from rubgen.scenario.contact_laws.law import NormalLaw
from rubgen.scenario.contact_laws.rigid import Rigid


@dataclass(frozen=True)
class Foot(Rigid):
    """A law of a test, under a key of its own."""


@validated_dataclass(frozen=True, kw_only=True, config=STRICT)
class WithFoot(ContactLaw):
    foot: Foot | None = None


def test_a_law_is_chosen_by_its_key():
    assert registered(WithFoot, NormalLaw) == registered(ContactLaw, NormalLaw) | {"foot": Foot}
    assert WithFoot(foot=Foot()).normal == Foot()
    assert WithFoot(restitution=0.5).normal == Rigid()


def test_only_one_law_makes_the_normal_force():
    with pytest.raises(ValidationError, match="foot and restitution: only one of them can make the normal force"):
        WithFoot(foot=Foot(), restitution=0.5)


@pytest.mark.parametrize("gap", [-1e-6, 0.0, 2e-6])
def test_a_rigid_contact_closes_its_gap_or_bears_nothing(gap):
    """`gap` is that of a contact with a force of 100 N, in a structure of 10 nm/N."""
    compliance, present = 1e-8, 100.0
    force = Rigid.respond(np.zeros(0), present, gap, compliance, math.nan)
    left = gap + compliance * (force - present)
    assert min(force * compliance, left) == pytest.approx(0.0, abs=1e-20)
    assert force == pytest.approx(max(0.0, present - gap / compliance))


@pytest.mark.parametrize("law", NORMAL_LAWS)
def test_what_is_compiled_stands_in_the_file_of_the_law(law):
    """The key of compiled kernels is made of these files."""
    own = vars(sys.modules[law.__module__])
    for name in set(law.respond.__code__.co_names) & set(own):
        assert own[name] is math or isinstance(own[name], int | float), name
