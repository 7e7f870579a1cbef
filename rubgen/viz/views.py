"""How the Rerun viewer arranges a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rerun.blueprint as rrb

if TYPE_CHECKING:
    from rubgen.labels.labels import Labels
    from rubgen.sensors.channel import Recording

FIRST_ORDERS = ("contact_force", "blisk_x", "casing_acc_0")


def arrangement(recording: Recording, labels: Labels) -> rrb.Blueprint:
    """Signals over time on the left, orbit, order amplitudes and labels on the right."""
    taps = sorted(labels.orders, key=lambda tap: FIRST_ORDERS.index(tap) if tap in FIRST_ORDERS else len(FIRST_ORDERS))
    signals = [
        _signal_tabs(recording, "preview", "whole run", active="contact_force"),
        _signal_tabs(recording, "detail", "full rate", active="acceleration"),
    ]
    left = rrb.Vertical(
        *signals,
        rrb.Tabs(
            rrb.TimeSeriesView(origin="/contact/angle", name="casing angle of contact, deg"),
            rrb.TimeSeriesView(origin="/contact/impulse", name="impulse, N s"),
            rrb.TimeSeriesView(origin="/contact/blade", name="blade"),
            name="contact",
        ),
        rrb.StateTimelineView(origin="/labels/motion", name="motion"),
        row_shares=[3, 3, 3, 2.4],
    )
    right = rrb.Vertical(
        rrb.Spatial2DView(origin="/orbit", name="orbit of the disk centre, um; points once a turn"),
        rrb.Tabs(*(rrb.BarChartView(origin=f"/orders/{tap}", name=f"orders of {tap}") for tap in taps), name="orders"),
        rrb.TextDocumentView(origin="/labels/text", name="labels"),
    )
    return rrb.Blueprint(
        rrb.Horizontal(left, right, column_shares=[3, 2]),
        rrb.TimePanel(state="collapsed", timeline="time"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        auto_views=False,
    )


def _signal_tabs(recording: Recording, rate: str, title: str, *, active: str) -> rrb.Tabs:
    names = {quantity: f"{quantity} ({title})" for quantity in recording.by_quantity()}
    views = [rrb.TimeSeriesView(origin=f"/{rate}/{quantity}", name=name) for quantity, name in names.items()]
    return rrb.Tabs(*views, name=title, active_tab=names.get(active, 0))
