"""The state of the controls, and the robot that it makes of the one loaded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from tactr.robot import PointLoad, Robot
from tactr.viewer.controls import AXES, Control, Kind

HostChoice = Literal["as in the file", "own (B)", "outermost (A)"]
HOSTS: dict[HostChoice, str | None] = {"as in the file": None, "own (B)": "own", "outermost (A)": "outermost"}


@dataclass(frozen=True)
class State:
    """What the user has set, from a robot on. moved: values in SI units of the controls that were moved, by
    kind and name; the others stay as the robot has them. host: who guides the tendons. loads: whether the
    robot's own loads act.
    """

    robot: Robot
    moved: Mapping[tuple[Kind, str], float] = field(default_factory=dict)
    host: HostChoice = "as in the file"
    loads: bool = True

    def with_value(self, key: tuple[Kind, str], value: float) -> State:
        """The state with one control at a value in SI units."""
        return replace(self, moved={**self.moved, key: value})

    def value(self, control: Control) -> float:
        """Value of a control in its own unit."""
        return control.factor * self.moved[control.key] if control.key in self.moved else control.value

    @property
    def tip_force(self) -> tuple[float, float, float]:
        """Force at the tip of the innermost tube, N, world axes."""
        x, y, z = (self.moved.get(("force", axis), 0.0) for axis in AXES)
        return x, y, z

    @property
    def actuation(self) -> dict[str, dict[str, float]]:
        """What was moved, as ``tactr.solve`` takes it."""
        found: dict[str, dict[str, float]] = {}
        for (kind, name), value in self.moved.items():
            if kind == "insertion":
                value = min(value - self.robot.tube(name).length, 0.0)
            if kind != "force":
                found.setdefault("translation" if kind == "insertion" else kind, {})[name] = value
        return found

    @property
    def structure(self) -> Robot:
        """The robot as loaded, with the host and the loads that were chosen."""
        robot, host = self.robot, HOSTS[self.host]
        changes: dict[str, Any] = {}
        if host is not None:
            changes["tendons"] = tuple(replace(tendon, host=host) for tendon in robot.tendons)
        if not self.loads or any(self.tip_force):
            own = robot.loads if self.loads else ()
            tip = [PointLoad(robot.tubes[-1].name, force=self.tip_force)] if any(self.tip_force) else []
            changes["loads"] = (*own, *tip)
        return robot.replace(**changes) if changes else robot

    @property
    def actuated(self) -> Robot:
        """The robot that all this makes. Raises RobotError."""
        return self.structure.with_actuation(**self.actuation)


def as_python(state: State, source: str) -> str:
    """A program that solves the robot in this state; source: what loads it: 'tactr.load("a.yaml")'."""
    lines = ["import tactr"]
    moved = [f"{name}={values!r}" for name, values in state.actuation.items()]
    changes = []
    if (host := HOSTS[state.host]) is not None:
        lines.insert(0, "from dataclasses import replace\n")
        changes.append(f"tendons=[replace(t, host={host!r}) for t in robot.tendons]")
    if not state.loads or any(state.tip_force):
        own = "*robot.loads, " if state.loads else ""
        tip = ""
        if any(state.tip_force):
            tip = f"tactr.PointLoad({state.robot.tubes[-1].name!r}, force={state.tip_force!r})"
        changes.append(f"loads=[{own}{tip}]")
    lines += ["", f"robot = {source}"]
    lines += [f"robot = robot.replace({change})" for change in changes]
    lines.append(f"shape = tactr.solve({', '.join(['robot', *moved])})")
    lines.append("print(shape.tip_position, shape.stability)")
    return "\n".join(lines) + "\n"
