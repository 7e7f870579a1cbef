"""What the page says about the studies besides their numbers."""

from __future__ import annotations

INTRODUCTION = """
# Sensitivity

Results also depend on numerical settings: the time step, the numbers of modes and nodes, and the turns before the
record. Each study varies one setting and leaves all others at their defaults. It uses five runs of the preset
`zeng2019`:

- light: 10,000 rev/min with a lateral support stiffness of 2e8 N/m, without friction and with friction 0.01;
- heavier: 11,400 rev/min, without friction;
- chaotic: 9,000 rev/min, without friction and with friction 0.01.

Records have 500 turns. Orders are computed from the last 100 turns. `+-` is the standard error of the mean impulse,
from ten parts of the record. It is the uncertainty of the numbers of a chaotic run, whatever is varied. Changes are
relative to the reference value of each study, which its section states. The axes of the figures are linear within 1 %
and logarithmic beyond. The grey bar marks the default. The shape of a mark is the class of motion. Zones are `equal`
if the label says symmetric.

`make sensitivity` makes this page, its figures and `out/sensitivity/`. It keeps finished runs there, so a stopped study
continues where it stopped. `python -m validation.sensitivity steps` makes one study. `--quick` makes a small version of
all studies in `out/sensitivity-quick/`.
"""
FOLLOWS = """
## Conclusions

- **Steps a turn: 1,024 stays the default, and the minimum for data.** With half the step, nearly all labels of the
  paper's sweep stay the same, and the impulse of its period-1 runs changes by less than 2 % (next section). The
  solution is not converged, because the scheme is of first order in contact. Compared with 8,192 steps, impulse and
  orders of the light rub are 0.1 % too small. In the heavier rub the impulse is 2 % too small, order 2 of the force
  10 %, and order 4 of the force a third. To compare amplitudes instead of classes, use 4,096 steps or more. 256 steps
  are stable at these speeds, but then the light rub is labelled quasi-periodic and the impulse of the heavier rub is
  8 % too small.
- **Modes of blades and disk: 4 and 4 are enough.** Fewer would also be enough. In period-1 runs, more modes change
  impulses by less than 0.01 % and orders by less than 1 %.
- **Modes of the blisk: with 4, labels are right, and impulses and the orders of the force are right within 0.3 %. Order
  3 of the disk centre is not**: it is 5 % too large in the light rub and 45 % in the heavier rub. 12 modes do not
  correct it, 40 do. If you need order 3, set `blisk_modes = 40` in the reduction. Order 1 is far larger and is right
  within 0.1 % with 4 modes.
- **Casing modes: 11 by definition, as in the paper.** Two more or two fewer modes change impulses by up to some tens of
  percent, and classes too. With 5 and with 23 modes some of the runs diverge. The results do not converge: data with
  different numbers of casing modes are data of different machines.
- **Casing nodes: 180 are enough** for labels, and for impulses within 0.1 %. 60 are too few for order 4 of the force.
- **Settle turns: `auto` is on the safe side.** In these five runs 50 turns, 10 of them after closing, have the same
  labels and the same period-1 impulses within 0.02 %. `auto` uses the slowest decay of the linear system, and contact
  adds damping. `auto` stays the default, because a run that hardly rubs has only the decay of the linear system.
- **Period-1 means within 1 % of the motion.** This is the radius within which points of the section count as equal
  ([labels](labels/motion.md#clusters)). The casing of the light rub strays by half of it. From this bound on, 0-1
  test and exponent may contradict the class, and they do. With other steps or nodes the casing strays a little more,
  and the run is `undecided`; with friction 0.01 and 8,192 steps it is `period-3`. Impulses and orders hardly change.
- The mean impulses of the chaotic runs vary by up to about 8 % in all studies, without a trend (except with other
  casing modes and with 256 steps). Records of 500 turns cannot resolve smaller differences.
"""
REMARKS = {
    "halving": """
The runs are the sweep of the paper, 2,460 to 14,940 rev/min in steps of 120, with 1,024 and with 2,048 steps a turn.
`K` is the indicator of the 0-1 test (chaotic from 0.7). `stray` is the rms distance of the points of the section from
their mean, divided by the size of the motion (period-1 up to 0.01). The exponent is the largest Lyapunov exponent with
its standard error. [Labels](labels/motion.md) defines all three.
""",
    "steps": """
Reference: 8,192. Gap and normal are taken at step n+1, and the force acts from step n. So the scheme is of first order
in the step in contact, and of second order without contact. The verification measures this: the phase of the stator in
full annular rub has an error of 5.4e-3 rad at 1,024 steps. With three lobes, use a number of steps divisible by three,
so that all lobes have the same steps.
""",
    "blade_modes": "Fixed-interface modes of each blade in the first step of the reduction. Reference: 16.",
    "disk_modes": "Fixed-interface modes of the disk in the first step of the reduction. Reference: 40.",
    "blisk_modes": """
Fixed-interface modes of the coupled blisk in the second step. The reduction always keeps the translations of the tips.
Reference: 86, the number of the paper's own reference. Modes of higher frequency need smaller steps. Where stability
required more steps, the table states their number.
""",
    "casing_modes": """
Reference: 11. This is not a convergence study, because there is no convergence: tips pass at 419 m/s, and waves of the
ring travel at 66 to 153 m/s, so contact excites every additional wave. The number of casing modes is part of the
definition of the model.
""",
    "casing_nodes": """
Reference: 720. Springs are attached to the nodes. With more nodes each spring is softer, so that the ring stays the
same. The undeformed surface is smooth with any number of nodes.
""",
    "settle_turns": """
Turns before the record, including the closing of the clearance (40 turns). Reference: 800. `auto` follows from the
slowest decay of the linear system: here 266 turns (light), 365 (heavier) and 211 (chaotic).
""",
}
