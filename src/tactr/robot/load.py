"""External loads: at a point, along a length, and gravity."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Literal

from tactr.robot import _check as check

Vector3 = tuple[float, float, float]
Axes = Literal["world", "body"]
AXES: tuple[Axes, ...] = ("world", "body")


@dataclass(frozen=True)
class PointLoad:
    """A force (N) and a moment (N m) on a tube at one place.

    tube: its name. at: sigma in m, the tube's own arc length from its proximal end; None for its tip. axes:
    "world" (fixed in space, z along the guide) or "body" (turns with the tube's material frame). Raises
    RobotError.
    """

    tube: str
    _: KW_ONLY
    force: Vector3 = (0.0, 0.0, 0.0)
    moment: Vector3 = (0.0, 0.0, 0.0)
    at: float | None = None
    axes: Axes = "world"

    def __post_init__(self) -> None:
        with check.owned("PointLoad"):
            check.store(self, tube=check.name("tube", self.tube), axes=check.choice("axes", self.axes, AXES))
            check.store(self, force=check.vector("force", self.force, "N"))
            check.store(self, moment=check.vector("moment", self.moment, "N m"))
            if self.at is not None:
                check.store(self, at=check.real("at", self.at, "m", least=0))


@dataclass(frozen=True)
class DistributedLoad:
    """A force (N/m) and a moment (N m/m = N) per length of the robot.

    tube: name of the loaded tube; None for the outermost tube present at each section. start, end: m; sigma
    of that tube, or s from the guide's exit when tube is None; end None for as far as there is a tube. axes:
    "world" or "body" (the loaded tube's material frame). Raises RobotError.
    """

    tube: str | None = None
    _: KW_ONLY
    force: Vector3 = (0.0, 0.0, 0.0)
    moment: Vector3 = (0.0, 0.0, 0.0)
    start: float = 0.0
    end: float | None = None
    axes: Axes = "world"

    def __post_init__(self) -> None:
        with check.owned("DistributedLoad"):
            if self.tube is not None:
                check.store(self, tube=check.name("tube", self.tube))
            check.store(self, axes=check.choice("axes", self.axes, AXES))
            check.store(self, force=check.vector("force", self.force, "N/m"))
            check.store(self, moment=check.vector("moment", self.moment, "N"))
            start = check.real("start", self.start, "m", least=0)
            check.store(self, start=start)
            if self.end is not None:
                check.store(self, end=check.real("end", self.end, "m", above=start, hint="after the start"))


@dataclass(frozen=True)
class Gravity:
    """The weight of every tube. acceleration: m/s^2 in world axes, z along the guide (default: the robot
    points up).

    Every tube needs a density. Raises RobotError.
    """

    acceleration: Vector3 = (0.0, 0.0, -9.81)

    def __post_init__(self) -> None:
        with check.owned("Gravity"):
            check.store(self, acceleration=check.vector("acceleration", self.acceleration, "m/s^2"))


Load = PointLoad | DistributedLoad | Gravity
LOADS = (PointLoad, DistributedLoad, Gravity)
