"""Draw a virtual machine: candidates in a fixed order, of which the first sane one is used."""

import zlib
from collections import Counter, OrderedDict
from collections.abc import Callable, Mapping

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.brief import counted
from rubgen.errors import UserError
from rubgen.machine import Machine
from rubgen.scenario.machines.keys import MACHINE_KEYS, with_values
from rubgen.scenario.scenario import VirtualMachine
from rubgen.scenario.tables.machines import MachineTable

DIMENSIONS = 64
"""Dimensions that are always generated, so a key that is added later changes no machine of an existing recipe."""
MOST_REMEMBERED = 16
"""Machines that are remembered: the runs of a machine follow each other."""
Problem = Callable[[int, Machine], str | None]
"""Why a candidate of the machine of that number is not used; None where it is sane."""


def candidate(table: MachineTable, files: tuple[Machine, ...], seed: int, number: int, tried: int) -> Machine:
    """Draw candidate number `tried` of virtual machine number `number`. It depends on no other machine.

    - table: `[machines]` of the recipe.
    - files: the machines of the recipe's files. Virtual machine m changes file m modulo their number.
    - seed: seed of the recipe.

    Candidate 0 is the next point of the file's own scrambled Sobol sequence. Every later candidate has its own random
    stream. All candidates of a machine have the same pattern of mistuning. Raises UserError where the values make no
    machine.
    """
    of, place = number % len(files), number // len(files)
    point = _sobol(seed, of, place) if tried == 0 else _stream(seed, number, tried).random(DIMENSIONS)
    drawn = dict(zip((entry.key for entry in MACHINE_KEYS), point.tolist(), strict=False))
    values = {entry.key: each.quantile(drawn[entry.key]) for entry, each in table.distributions()}
    if not values:
        return files[of]
    return with_values(files[of], values, int(_stream(seed, number, 0).integers(2**31)))


class Population:
    """The virtual machines of a recipe. A machine is drawn and checked at the first call that needs it."""

    def __init__(
        self, table: MachineTable, files: tuple[Machine, ...], seed: int, problem: Problem, known: Mapping[int, int]
    ) -> None:
        """Take ranges and bounds, the machines of the files, the seed, and the check of a candidate.

        `known` is the candidate of each machine that was checked before, as recorded.
        """
        self.table, self.files, self.seed, self.problem, self.known = table, files, seed, problem, known
        self._recent: OrderedDict[int, tuple[Machine, VirtualMachine]] = OrderedDict()

    def machine(self, number: int) -> tuple[Machine, VirtualMachine]:
        """Return virtual machine `number`, from 0, and its record: the first of its candidates that passes the check.

        A machine in `known` has its recorded candidate, which is not checked again. If none of `table.tries` candidates
        passes, the machine is the file's, and the record has the reason as its `problem`.
        """
        if number not in self._recent:
            self._recent[number] = self._chosen(number)
            if len(self._recent) > MOST_REMEMBERED:
                self._recent.popitem(last=False)
        return self._recent[number]

    def _chosen(self, number: int) -> tuple[Machine, VirtualMachine]:
        refused: Counter[str] = Counter()
        for tried in range(self.known.get(number, 0), self.table.tries):
            try:
                machine = candidate(self.table, self.files, self.seed, number, tried)
                reason = None if number in self.known else self.problem(number, machine)
            except UserError as error:
                reason = str(error)
            if reason is None:
                return machine, VirtualMachine(number=number, candidate=tried)
            refused[reason.partition(" = ")[0][:60]] += 1
        causes = ", ".join(f"{cause} {counted(times, 'time')}" for cause, times in refused.most_common(3))
        text = (
            f"machine {number}: none of {counted(self.table.tries, 'candidate')} is sane ({causes}); the last: "
            f"{reason}; change the ranges of machines.vary or the bounds of [machines], or raise machines.tries"
        )
        virtual = VirtualMachine(number=number, candidate=self.table.tries, problem=text)
        return self.files[number % len(self.files)], virtual


def _sobol(seed: int, of: int, place: int) -> FloatArray:
    from scipy.stats import qmc  # slow to import, and only needed here

    engine = qmc.Sobol(d=DIMENSIONS, scramble=True, rng=np.random.default_rng([seed, of, zlib.crc32(b"machines")]))
    if place:
        engine.fast_forward(place)  # fast_forward(0) overflows
    point: FloatArray = engine.random(1)[0]
    return point


def _stream(seed: int, number: int, tried: int) -> np.random.Generator:
    return np.random.default_rng([seed, number, tried, zlib.crc32(b"candidate")])
