"""What can be moved, and how far: one control for every slider, from the robot and its limits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from tactr.robot import Robot, Stiffness, Tendon, TensionProfile, Tube
from tactr.statics.actuation import innermost_place

Kind = Literal["tension", "displacement", "rotation", "insertion", "force"]
AXES = ("x", "y", "z")
ROUNDING = 1e-6  # mm
STEPS, SHORTEST = 200, 1e-6  # of a slider; its length, where it cannot move
FALLBACK_TENSION, FALLBACK_FORCE = 5.0, 0.1
LEAST_OUTSIDE = 0.05  # of a tube's length, by default
QUARTER_TURN = 0.5 * math.pi
DISPLACEMENT_SHARE = 0.05  # of the tube's length, by default


@dataclass(frozen=True)
class Control:
    """One slider. kind; name: of the tendon, the tube, or the axis of the tip force; unit, and what of it one
    SI unit is (factor); low, high, step, value: in that unit. An insertion is the length outside the guide.
    """

    kind: Kind
    name: str
    unit: str
    factor: float
    low: float
    high: float
    step: float
    value: float

    def shown(self, value: float) -> float:
        """A value as a slider shows it: to a tenth of a step, between its ends."""
        return min(max(round(value, 1 - math.floor(math.log10(self.step))), self.low), self.high)

    @property
    def key(self) -> tuple[Kind, str]:
        """By which a state finds its value."""
        return self.kind, self.name


def controls(robot: Robot) -> list[Control]:
    """The controls of a robot, in the order in which they are shown. A tension profile has none."""
    plain = [tendon for tendon in robot.tendons if not isinstance(tendon.tension, TensionProfile)]
    made = [_tendon(robot, tendon) for tendon in plain]
    made += [_rotation(tube) for tube in robot.tubes]
    made += [_insertion(robot, tube) for tube in robot.tubes]
    return made + [_force(robot, axis) for axis in AXES]


def most_tension(robot: Robot) -> float:
    """Tension of the darkest colour, N: about the largest of the robot, or of its sliders."""
    held = [max(t.tension.values) for t in robot.tendons if isinstance(t.tension, TensionProfile)]
    largest = max([*held, *map(_plain, robot.tendons)], default=1.0)
    if largest > 0:
        return round_up(largest)
    return max(_tension_range(robot, tendon)[1] for tendon in robot.tendons)


def _tendon(robot: Robot, tendon: Tendon) -> Control:
    if tendon.displacement is not None:
        given = tendon.limits.displacement if tendon.limits else None
        reach = round_up(max(2.0 * abs(tendon.displacement), _share(robot, tendon)))
        low, high = given or (min(0.0, -reach if tendon.displacement < 0 else 0.0), reach)
        return _control("displacement", tendon.name, "mm", 1e3, low, high, tendon.displacement)
    low, high = _tension_range(robot, tendon)
    return _control("tension", tendon.name, "N", 1.0, low, high, _plain(tendon))


def _share(robot: Robot, tendon: Tendon) -> float:
    return DISPLACEMENT_SHARE * robot.tube(tendon.tube).length


def _tension_range(robot: Robot, tendon: Tendon) -> tuple[float, float]:
    """As given; otherwise to twice its tension, or the largest of the robot, or to what bends the tube of a
    robot without tensions by a right angle."""
    if tendon.limits is not None and tendon.limits.tension is not None:
        return tendon.limits.tension
    largest = _plain(tendon) or max(_plain(other) for other in robot.tendons)
    if largest > 0:
        return 0.0, round_up(2.0 * largest)
    tube = robot.tube(tendon.tube)
    x, y = tendon.routing.r(tube.length if tendon.end is None else tendon.end)
    stiffness, offset = _bending(tube), math.hypot(x, y)
    bends = QUARTER_TURN * stiffness / (offset * tube.length) if stiffness and offset else FALLBACK_TENSION
    return 0.0, round_up(bends)


def _plain(tendon: Tendon) -> float:
    return tendon.tension if isinstance(tendon.tension, float) else 0.0


def _rotation(tube: Tube) -> Control:
    given = tube.limits.rotation if tube.limits else None
    low, high = given or (-math.pi, math.pi)
    return _control("rotation", tube.name, "deg", 180.0 / math.pi, low, high, tube.rotation)


def _insertion(robot: Robot, tube: Tube) -> Control:
    furthest_in = -innermost_place(robot, tube)
    given = tube.limits.translation if tube.limits else None
    low, high = given or (_millimetres(LEAST_OUTSIDE * tube.length) - tube.length, 0.0)
    low = max(low, _millimetres(furthest_in + tube.length) - tube.length)  # ends of tendons stay outside
    low, high = min(low, tube.translation), max(high, tube.translation)
    return _control("insertion", tube.name, "mm", 1e3, low + tube.length, high + tube.length, tube.tip)


def _millimetres(length: float) -> float:
    """The next whole millimetre, m."""
    return 1e-3 * math.ceil(1e3 * length - ROUNDING)


def _force(robot: Robot, axis: str) -> Control:
    """To what bends the robot's innermost tube by about a right angle."""
    tube = robot.tubes[-1]
    stiffness = _bending(tube)
    most = round_up(QUARTER_TURN * stiffness / tube.tip**2) if stiffness else FALLBACK_FORCE
    return _control("force", axis, "N", 1.0, -most, most, 0.0)


def _bending(tube: Tube) -> float | None:
    first = tube.parts[0].stiffness
    return max(first.EI_x, first.EI_y) if isinstance(first, Stiffness) else None


def _control(
    kind: Kind, name: str, unit: str, factor: float, low: float, high: float, value: float
) -> Control:
    """Limits in SI units; widened to the value, which a robot file may put beyond its limits."""
    ends = (round(factor * end, 9) for end in (min(low, value), max(high, value)))
    low, high = ends
    step = round_up(max(high - low, SHORTEST) / STEPS)
    return Control(kind, name, unit, factor, low, high, step, factor * value)


def round_up(number: float) -> float:
    """The next 1, 2 or 5 times a power of ten."""
    power = math.floor(math.log10(number))
    return next(
        float(f"{step}e{power}") for step in (1, 2, 5, 10) if float(f"{step}e{power}") >= number * (1 - 1e-9)
    )
