"""All figures and conclusions, in the order of the page. A new one: its module, and its line here."""

from __future__ import annotations

from rubgen.studies.zeng2019 import figure06, figure07, figure08, figure09
from rubgen.studies.zeng2019.section import Section

SECTIONS: tuple[Section, ...] = (
    figure06.SECTION,
    figure07.SECTION,
    figure08.SECTION,
    figure09.SECTION,
)
