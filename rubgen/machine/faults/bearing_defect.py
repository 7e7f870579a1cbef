"""A local defect of a rolling bearing."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator
from pydantic.dataclasses import dataclass

from rubgen.arrays import FloatArray
from rubgen.machine.faults.fault import Fault, Severity, Strikes
from rubgen.machine.quantities import STRICT, BallCount, Direction, Length, about, real

BALL_DENSITY = 7800.0
"""Of steel, kg/m3."""
LOAD_ZONE = 0.5
"""Stribeck's load distribution factor: half of the circumference carries load."""
LOAD_EXPONENT = 1.5
"""Of point contact of balls (Hertz)."""
LEAST_SPACING = 0.1
"""Least distance of two blows as a share of the mean."""
ContactAngle = Annotated[float, real(ge=0, le=60)]
Slip = Annotated[float, real(ge=0, le=0.2)]
DefectWidth = Annotated[float, real(ge=0, le=0.1)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class BearingDefect(Fault):
    """A spall on a race or a ball of the bearing that carries the disk, or a broken cage; its blows pass the frame.

    With n balls of diameter d on the pitch diameter D and g = d / D cos(contact angle), the orders of the shaft's speed
    are (SKF; Randall and Antoni 2011)

    - cage: (1 - g) / 2
    - outer: n (1 - g) / 2, at a place in the direction of the load
    - inner: n (1 + g) / 2, in and out of the load zone at order 1
    - ball: D / d (1 - g^2) / 2 a turn of the ball, with a blow on each race, in and out of the zone with the cage

    The distances of blows differ by `slip` of their mean, normal and independent (Antoni and Randall 2003). A blow has
    the impulse m V 2 w / d: a ball of mass m and speed V along the race tilts into a spall of width w and out again,
    its direction turns by w / d twice. The ball neither bounces nor is pressed, so real blows are harder. In the load
    zone a blow has the share (1 - (1 - cos psi) / (2 e))^(3/2), e = 0.5, at the angle psi from the load at `load_deg`
    (Stribeck; McFadden and Smith 1984). The cage strikes with its ball's impulse at any angle.

    The default bearing is plausible for the preset. It is not a certain type of bearing.
    """

    STRIKES: ClassVar = True
    SEVERITY: ClassVar = Severity(
        column="bearing_defect_m", unit="m", meaning="width of the bearing's defect along the way of the balls"
    )
    kind: Annotated[Literal["bearing-defect"], about("Kind of this fault.")] = "bearing-defect"
    place: Annotated[
        Literal["outer", "inner", "ball", "cage"],
        about("Where the bearing is damaged. It decides the order of the blows and how they are modulated."),
    ] = "outer"
    width_m: Annotated[
        DefectWidth, about("Width of the defect along the way of the balls. Blows are proportional to it.")
    ]
    balls: Annotated[BallCount, about("Number of balls, from the bearing's data sheet.")] = 13
    ball_diameter_m: Annotated[Length, about("Diameter of a ball, from the bearing's data sheet.")] = 0.022
    pitch_diameter_m: Annotated[
        Length, about("Diameter of the circle of the balls' centres, from the bearing's data sheet.")
    ] = 0.115
    contact_angle_deg: Annotated[
        ContactAngle, about("Angle between the load on a ball and the radial plane, from the bearing's data sheet.")
    ] = 0.0
    slip: Annotated[
        Slip,
        about(
            "Scatter of the distances of two blows as a share of their mean. 0 makes a strictly "
            "periodic train, which no bearing has."
        ),
    ] = 0.015
    load_deg: Annotated[
        Direction, about("Direction of the load on the bearing from +X. 270 is downwards, along gravity.")
    ] = 270.0

    @model_validator(mode="after")
    def _balls_have_room(self) -> Self:
        room = self.pitch_diameter_m * math.sin(math.pi / self.balls)
        if self.ball_diameter_m > room:
            most = f"{self.balls} balls on pitch_diameter_m = {self.pitch_diameter_m:g} have room for {room:.4g} m each"
            raise ValueError(f"ball_diameter_m = {self.ball_diameter_m:g}: {most}; lower it or balls")
        if self.width_m > self.ball_diameter_m:
            raise ValueError(f"width_m = {self.width_m:g}: wider than a ball, {self.ball_diameter_m:g} m; lower it")
        return self

    @property
    def severity(self) -> float:
        """The width of the defect in m."""
        return self.width_m

    @property
    def order(self) -> float:
        """Mean number of blows in a turn of the shaft; a defect of a ball strikes both races."""
        return self.orders[self.place] * (2 if self.place == "ball" else 1)

    @property
    def orders(self) -> dict[str, float]:
        """Defect frequency over the frequency of the shaft, for each `place` of the defect: outer, inner, ball, cage.

        `ball` is the spin frequency of a ball (BSF), half the frequency of its blows.
        """
        ratio = self.ball_diameter_m / self.pitch_diameter_m * math.cos(math.radians(self.contact_angle_deg))
        spin = self.pitch_diameter_m / self.ball_diameter_m * (1 - ratio**2) / 2
        cage, outer, inner = (1 - ratio) / 2, self.balls * (1 - ratio) / 2, self.balls * (1 + ratio) / 2
        return {"outer": outer, "inner": inner, "ball": spin, "cage": cage}

    def impulse(self, speed: FloatArray) -> FloatArray:
        """Return the impulse of a blow under full load, in N s, at speeds (any,) of the shaft in rad/s."""
        mass = BALL_DENSITY * math.pi / 6 * self.ball_diameter_m**3
        along = {
            "outer": self.orders["cage"] * self.pitch_diameter_m / 2,
            "inner": (1 - self.orders["cage"]) * self.pitch_diameter_m / 2,
            "ball": self.orders["ball"] * self.ball_diameter_m / 2,
            "cage": self.orders["cage"] * self.pitch_diameter_m / 2,
        }
        return np.asarray(2 * mass * speed * along[self.place] * self.width_m / self.ball_diameter_m)

    def strikes(self, turned: FloatArray, speed: FloatArray, rng: np.random.Generator) -> Strikes:
        """Draw the blows of the defect on the bearing housing.

        - turned (steps,): angle of the shaft at the steps, rad, rising; at least one.
        - speed (steps,): speed of the shaft at the steps, rad/s.
        - rng: random numbers.

        Returns the blows in order of time: angle of the shaft, impulse (N s) and direction (rad from +X, inertial) of
        each. Outside of the load zone the impulse is 0. The blows are drawn backward from the last angle, so that the
        last blows do not depend on the length of the record.
        """
        mean = 2 * math.pi / self.order
        start, cage, defect = rng.uniform(0, 1, 3)
        spread = rng.spawn(1)[0].standard_normal(2 + int((turned[-1] - turned[0]) / mean / (1 - self.slip)))
        spaces = mean * np.maximum(1 + self.slip * spread, LEAST_SPACING)
        at = turned[-1] - start * mean - np.concatenate([[0.0], np.cumsum(spaces)])
        at = at[at >= turned[0]][::-1]
        load = math.radians(self.load_deg)
        direction = {
            "outer": np.full(at.size, load),
            "inner": at + 2 * math.pi * defect,
            "ball": self.orders["cage"] * at + 2 * math.pi * cage,
            "cage": self.orders["cage"] * at + 2 * math.pi * cage,
        }[self.place]
        share = np.ones(at.size) if self.place == "cage" else load_share(direction - load)
        return Strikes(
            turned=at, impulse_n_s=share * self.impulse(np.interp(at, turned, speed)), direction_rad=direction
        )


def load_share(angle: FloatArray) -> FloatArray:
    """Return the load of a ball over the largest ball load at angles (any,) in rad from the load's direction.

    The distribution is Stribeck's.
    """
    return np.asarray(np.maximum(1 - (1 - np.cos(angle)) / (2 * LOAD_ZONE), 0.0) ** LOAD_EXPONENT)
