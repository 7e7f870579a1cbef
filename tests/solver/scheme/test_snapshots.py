"""What a snapshot holds."""

import numpy as np
from kernel_arrays import contact_work

from rubgen.solver.scheme.motion_kernels import Motion
from rubgen.solver.scheme.state_kernels import Snapshots, keep_snapshot


def test_a_snapshot_holds_two_states_and_their_gaps_under_its_number():
    rng = np.random.default_rng(1)
    before, now = (Motion(rng.normal(size=16), rng.normal(size=(2, 8)), rng.normal(size=11)) for _ in range(2))
    work = contact_work(3)
    work.step_gaps[:] = rng.normal(size=(3, 3))
    snapshots = Snapshots(np.array([4, 8, 9]), np.zeros((3, 2, 16)), np.zeros((3, 2, 3)))
    assert keep_snapshot(snapshots, 1, before, now, work) == 2
    np.testing.assert_array_equal(snapshots.z[1], [before.z, now.z])
    np.testing.assert_array_equal(snapshots.step_gaps[1], work.step_gaps[:2])
    assert not snapshots.z[[0, 2]].any()
    before.z[:] = work.step_gaps[:] = np.nan  # a copy, no view
    assert np.isfinite(snapshots.z).all()
    assert np.isfinite(snapshots.step_gaps).all()
