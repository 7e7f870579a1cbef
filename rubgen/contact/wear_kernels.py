"""Wear of the liner by the contacts of one step."""

from rubgen.contact.contact_kernels import ContactWork
from rubgen.contact.liner_kernels import WORK, Liner, Wear, remove, worn_depth
from rubgen.jit import allocation_free_kernel, inlined_kernel


@inlined_kernel
def wear_where_lined(count: int, liner: Liner, dt: float, work: ContactWork, wear: Wear) -> None:
    """`wear_liner` where there is one."""
    if liner.bins > 0:
        wear_liner(count, liner, dt, work, wear)


@allocation_free_kernel
def wear_liner(count: int, liner: Liner, dt: float, work: ContactWork, wear: Wear) -> None:
    """Add the work on the receding surface, then wear it: volume = rate lam |v_rel| dt at each contact's foot.

    Archard, J. Appl. Phys. 24 (1953): V = K F s / H; `liner.rate` is K / H. The gaps of this step used the present
    depth. The gaps of two steps before used `wear.earlier[0]`. Per step the surface has therefore receded by half the
    difference of the two depths.
    """
    for m in range(count):
        if work.lam[m] > 0.0:
            psi = work.psi[work.blade[m]]
            receded = worn_depth(wear.depth, psi)[0] - worn_depth(wear.earlier[0], psi)[0]
            wear.sums[WORK] += 0.5 * work.lam[m] * receded
    for i in range(liner.bins):
        wear.earlier[0, i] = wear.earlier[1, i]
        wear.earlier[1, i] = wear.depth[i]
    for m in range(count):
        if work.lam[m] > 0.0:
            remove(liner, work.psi[work.blade[m]], liner.rate * work.lam[m] * work.sliding[m] * dt, wear)
