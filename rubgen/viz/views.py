"""How the Rerun viewer arranges a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import rerun.blueprint as rrb

    from rubgen.labels.labels import Labels
    from rubgen.sensors.channel import Recording

FIRST_ORDERS = ("contact_force", "blisk_x", "casing_acc_0")


def arrangement(recording: Recording, labels: Labels) -> rrb.Blueprint:
    """Signals over time on the left, orbit, order amplitudes and labels on the right."""
    import rerun.blueprint as rrb

    quantities = dict.fromkeys(channel.quantity.replace(" ", "_") for channel in recording.channels.values())
    taps = sorted(labels.orders, key=lambda tap: FIRST_ORDERS.index(tap) if tap in FIRST_ORDERS else len(FIRST_ORDERS))
    signals = [
        rrb.Tabs(
            *(
                rrb.TimeSeriesView(origin=f"/{rate}/{quantity}", name=f"{quantity} ({title})")
                for quantity in quantities
            ),
            name=title,
            active_tab=f"{active} ({title})",
        )
        for rate, title, active in (("preview", "whole run", "force"), ("detail", "full rate", "acceleration"))
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
