"""What the page says about the studies besides their numbers."""

from __future__ import annotations

INTRODUCTION = """
# Sensitivity

What a user does not see moves results too: the step, the numbers of modes and nodes, the turns that are thrown away.
Each is varied alone, all else by default, in five runs of the preset `zeng2019`:

- light: 10,000 rev/min with a lateral support stiffness of 2e8 N/m, without friction and with 0.01;
- heavier: 11,400 rev/min; without friction;
- chaotic: 9,000 rev/min, without friction and with 0.01.

Records have 500 turns, orders cover the last 100. `+-` is the standard error of the mean impulse from ten parts of the
record: what a chaotic run's numbers are uncertain by, whatever is varied. Changes are relative to the yardstick of each
study, given in its section; figures are linear within 1 % and logarithmic beyond, the grey bar stands at the default,
the mark's shape is the class of motion. Zones are `equal` when the label says symmetric.

`make sensitivity` makes this page, its figures and `out/sensitivity/`; finished runs are kept there, so a study that
was stopped goes on where it stood. `python -m validation.sensitivity steps` makes one of them, `--quick` a small
version of all in `out/sensitivity-quick/`.
"""
FOLLOWS = """
## What follows

- **Steps a turn: 1,024 stays the default and the least for data.** Half the step leaves nearly all labels of the
  paper's sweep and the impulse of its period-1 runs within 2 % (next section). It is no converged solution: the
  scheme is of first order in contact. Against 8,192 steps the light rub lacks 0.1 % of impulse and orders, the
  heavier one 2 % of its impulse, 10 % of order 2 and a third of order 4 of the force. Who compares amplitudes rather
  than classes takes 4,096 or more. 256 is stable at these speeds, but calls the light rub quasi-periodic and takes 8
  % off the heavier one.
- **Modes of blades and disk: 4 and 4 are enough**, fewer would do. In period-1 runs more of them change impulses by
  less than 0.01 % and orders by less than 1 %.
- **Modes of the blisk: 4 keep labels, impulses and the orders of the force within 0.3 %, but not order 3 of the disk
  centre**: it is 5 % too large in the light rub and 45 % in the heavier one; 12 modes do not mend it, 40 do. Who
  needs it sets `blisk_modes = 40` in the reduction; order 1, far larger, is good to 0.1 % with 4.
- **Casing modes: 11 by definition, as in the paper.** Two more or fewer change impulses by up to some tens of
  percent, and classes with them; with 5 and with 23 some of the runs end as diverged. Nothing converges here: data
  with different numbers are data of different machines.
- **Casing nodes: 180 are enough** for labels, and for impulses within 0.1 %; 60 are not for order 4 of the force.
- **Settle turns: `auto` is on the safe side.** In these five runs 50 turns, 10 after closing, give the same labels
  and the same period-1 impulses within 0.02 %: contact damps more than the linear system, on whose slowest decay
  `auto` rests. It stays the default, because a run that hardly rubs has that decay alone.
- **Period-1 means within 1 % of the motion**, the radius inside which `docs/labels.md` takes points as one. The
  casing of the light rub strays by half of that, the bound from which 0-1 test and exponent may contradict, and they
  do: with other steps or nodes it strays a little more and is `undecided`, and with friction 0.01 and
  8,192 steps it is period-3 by name. Impulses and orders hardly move.
- Mean impulses of the chaotic runs scatter by up to some 8 % whatever is varied, without a trend (casing modes and
  256 steps apart): 500 turns tell no more.
"""
REMARKS = {
    "halving": """
The paper's sweep, 2,460 to 14,940 rev/min by 120, at 1,024 and at 2,048 steps a turn. `K` is the indicator of the 0-1
test (chaotic from 0.7), `stray` the rms distance of the section's points from their mean over the size of the motion
(period-1 up to 0.01), the exponent Lyapunov's largest with its standard error, all as `docs/labels.md` defines them.
""",
    "steps": """
Yardstick: 8,192. Gap and normal are taken at n+1, the force acts from n: in contact the scheme is of first order in the
step, without contact of second. The verification measures it: the stator's phase in full annular rub is off by 5.4e-3
rad at 1,024 steps. With three lobes, take a number of steps that three divides, so that all lobes see the same steps.
""",
    "blade_modes": "Fixed-interface modes of each blade in the first step of the reduction. Yardstick: 16.",
    "disk_modes": "Fixed-interface modes of the disk in the first step of the reduction. Yardstick: 40.",
    "blisk_modes": """
Fixed-interface modes of the coupled blisk in the second step; the tips' translations stay in any case. Yardstick: 86,
the paper's own reference. Modes of higher frequency need smaller steps; where stability raised them, the table says so.
""",
    "casing_modes": """
Yardstick: 11. This is no convergence study, for there is none: tips pass at 419 m/s, waves of the ring travel at 66 to
153 m/s, so contact feeds each wave that is added. The number of casing modes belongs to the definition of the model.
""",
    "casing_nodes": """
Yardstick: 720. Springs stand at the nodes, so their stiffness is divided as nodes are added; the ring stays the same.
The undeformed surface is smooth with any number of nodes.
""",
    "settle_turns": """
Turns before the record, the closing of the clearance (40 turns) included. Yardstick: 800. `auto` follows from the
slowest decay of the linear system: here 266 turns (light), 365 (heavier) and 211 (chaotic).
""",
}
