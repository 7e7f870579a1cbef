"""Check the numbers of a machine's meshes. A problem is a sentence with key, value and remedy."""

from __future__ import annotations

import math

from rubgen.machine.machine import BladeRow, Casing, Disk


def disk_nodes(disk: Disk) -> int:
    """Return the number of nodes of the disk's mesh.

    A ring through the corners of elements has two nodes an element. A ring between two of these has one node for each
    element.
    """
    return disk.circumferential_elements * (3 * disk.radial_elements + 2)


def pitch_problem(disk: Disk, blades: BladeRow) -> str | None:
    """Return a problem if the blades do not meet corner nodes of the rim; else None."""
    elements, count = disk.circumferential_elements, blades.count
    if elements % count:
        return (
            f"disk.circumferential_elements = {elements}: must be a multiple of blades.count = {count}, "
            f"for every blade needs a node at the rim; try {count * max(1, round(elements / count))}"
        )
    return None


def node_problem(casing: Casing) -> str | None:
    """Return a problem if the number of casing nodes is not divisible by 4 and by the lobes; None without a problem."""
    step = math.lcm(4, casing.lobes)
    if casing.nodes % step == 0:
        return None
    nearest = step * max(round(casing.nodes / step), -(-12 // step))
    return f"casing.nodes = {casing.nodes}: must be divisible by 4 and by casing.lobes = {casing.lobes}; take {nearest}"
