import json

from rubgen.labels.to_json import labels_to_json

NAMES = [
    "rub",
    "contact_duty",
    "contact_impulse_per_turn_n_s",
    "blades_touched",
    "contact_zones",
    "contact_zone_centres_rad",
    "contact_zone_widths_rad",
    "contact_zones_symmetric",
    "contact_touches",
    "contact_friction_work_per_turn_j",
    "contact_severity",
    "free_penetration_m",
    "rub_extent",
    "blade_touches",
    "blade_impulses_per_turn_n_s",
    "whirl",
    "whirl_index",
    "motion_blisk",
    "motion_casing",
    "motion",
    "period_blisk",
    "period_casing",
    "period",
    "motion_confidence",
    "motion_symmetric",
    "motion_intermittent",
    "motion_segment_starts_s",
    "motion_segment_periods",
    "tip_chatter",
    "stray_blisk",
    "stray_casing",
    "zero_one_k",
    "has_2fr",
    "orders_present",
    "lyapunov_per_turn",
    "lyapunov_per_second",
    "lyapunov_error",
    "lyapunov_convergence",
    "onset_speed_rpm",
    "end_of_rub_speed_rpm",
    "change_times_s",
    "change_speeds_rpm",
    "change_rub",
    "change_impulse_per_turn_n_s",
    "change_motion_classes",
    "window_starts_s",
    "window_speeds_rpm",
    "window_rub",
    "window_contact_duty",
    "window_impulse_per_turn_n_s",
]


def test_labels_have_their_public_names(rub_run):
    taps = ["blisk_x", "casing_acc_0", "contact_force"]
    endings = [
        "orders",
        "even_share",
        "odd_share",
        "dominant_order",
        "order_phases_rad",
        "order_floors",
    ]
    endings += ["fractional_amplitudes", "blade_passing"]
    assert list(labels_to_json(rub_run.labels)) == NAMES + [f"{tap}_{ending}" for tap in taps for ending in endings]


def test_labels_survive_json(rub_run, free_run):
    for run in (rub_run, free_run):
        plain = labels_to_json(run.labels)
        assert json.loads(json.dumps(plain, allow_nan=False)) == plain


def test_what_is_undefined_is_null(free_run):
    plain = labels_to_json(free_run.labels)
    assert plain["contact_force_even_share"] is None
    assert plain["contact_zones_symmetric"] is None
    assert plain["contact_zone_centres_rad"] == []
