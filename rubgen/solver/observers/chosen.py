"""Choose the observers of a run."""

import math

from rubgen.scenario.rotation import Rotation
from rubgen.solver.observers.companion import CompanionGrowth, DecayGrowth, piece_ends
from rubgen.solver.observers.observer import Observer
from rubgen.solver.observers.orbit import Orbit
from rubgen.solver.observers.orders import ChangingOrders, WindowOrders
from rubgen.solver.observers.sections import Sections
from rubgen.solver.observers.symmetry import Symmetry
from rubgen.solver.observers.tail import Tail
from rubgen.solver.observers.touches import TouchKeeper
from rubgen.solver.observers.track import TrackKeeper
from rubgen.solver.speed.driver import SpeedDriver
from rubgen.solver.speed.repeated import RepeatedDriver
from rubgen.solver.wants import Wants

LEAST_TAIL_TURNS = 100


def chosen_observers(driver: SpeedDriver, record: int, wants: Wants) -> list[Observer]:
    """Return the observers of a record of `record` turns.

    Every run has taps, sections, touches, track and orbit. At a changing speed its orders are added. At a steady speed
    orders, symmetry and, if wanted, the companion are added, or the known decay where a free turn is repeated. At a
    steady speed the snapshots that they need are requested from the stepper.
    """
    stepper, steady = driver.stepper, driver.rotation.is_steady
    observers: list[Observer] = [
        Tail(wants.taps, tail_turns(driver, record, wants)),
        Sections(record, len(stepper.system.M)),
        TouchKeeper(stepper, record),
        TrackKeeper(driver, record, record - math.floor(_signal_turns(driver.rotation, record, wants.tail_seconds))),
        Orbit(LEAST_TAIL_TURNS if steady else None),
    ]
    if not steady:
        return [*observers, ChangingOrders(driver, record)]
    symmetry = Symmetry(stepper)
    observers += [WindowOrders(*stepper.result.taps.shape), symmetry]
    if wants.companion and isinstance(driver, RepeatedDriver):
        observers.append(DecayGrowth(driver.decay * stepper.dt * stepper.steps, record))
    elif wants.companion:
        observers.append(CompanionGrowth(stepper, stops=wants.companion_stops))
    pieces = piece_ends(stepper.steps) if wants.companion else ()
    stepper.take_snapshots(sorted({*symmetry.steps, *pieces}))
    return observers


def tail_turns(driver: SpeedDriver, record: int, wants: Wants) -> int:
    """Return the number of turns that the taps cover: `wants.tail_seconds` at the fastest speed, at least 100 turns.

    They are at most all turns of the run. `record` is the number of turns of the record.
    """
    asked = math.ceil(wants.tail_seconds * driver.rotation.fastest / (2 * math.pi))
    return min(max(LEAST_TAIL_TURNS, asked), driver.settle + record)


def _signal_turns(rotation: Rotation, record: int, seconds: float) -> float:
    """Return the number of turns in the last `seconds` of a record of `record` turns."""
    if rotation.is_steady:
        return seconds * rotation.fastest / (2 * math.pi)
    end = rotation.time_of(2 * math.pi * record)
    return record - float(rotation.angle(max(end - seconds, 0.0))) / (2 * math.pi)
