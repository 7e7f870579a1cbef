"""All figures and conclusions, in the order of the page. A new one: its module, and its line here."""

from __future__ import annotations

from validation.zeng2019.conclusions import causes, conclusion1, conclusion2, conclusion3, friction, scale
from validation.zeng2019.figures import (
    figure06,
    figure07,
    figure08,
    figure09,
    figure10,
    figure11,
    figure16,
    figure17,
    figure18,
    figure19,
    figure20,
    figure21,
    figures12to15,
)
from validation.zeng2019.section import Section

SECTIONS: tuple[Section, ...] = (
    figure06.SECTION,
    figure07.SECTION,
    figure08.SECTION,
    figure09.SECTION,
    figure10.SECTION,
    figure11.SECTION,
    *figures12to15.SECTIONS,
    figure16.SECTION,
    figure17.SECTION,
    figure18.SECTION,
    figure19.SECTION,
    figure20.SECTION,
    figure21.SECTION,
    friction.SECTION,
    conclusion1.SECTION,
    conclusion2.SECTION,
    conclusion3.SECTION,
    causes.SECTION,
    scale.SECTION,
)
