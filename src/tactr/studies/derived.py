"""A number for each configuration of a sweep, by name: to colour, to count, to draw."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.studies import measures

if TYPE_CHECKING:
    from tactr.studies.result import Sweep

Rows = slice | np.ndarray
SHOWN = {
    "m": (1e3, "mm"),
    "rad": (np.degrees(1.0), "deg"),
    "J": (1e3, "mJ"),
    "N/m": (1e-3, "N/mm"),
    "Pa": (1e-9, "GPa"),
}
OF_THE_TIP = ("x", "y", "z")
NOT_SHOWN = ("status", "residual")


@dataclass(frozen=True)
class Named:
    """A quantity as people see it: its label, the unit it is shown in, and what takes SI there."""

    label: str
    unit: str
    factor: float

    def __str__(self) -> str:
        return f"{self.label} ({self.unit})" if self.unit else self.label


def names(sweep: Sweep) -> tuple[str, ...]:
    """All that a sweep can be asked for."""
    data = sweep.dataset
    plain = [name for name, array in data.items() if array.dims == ("sample",) and name not in NOT_SHOWN]
    by_tendon = [
        f"{name}.{tendon}"
        for name in ("tension", "tendon_length")
        if name in data
        for tendon in data["tendon"].values
    ]
    return (*OF_THE_TIP, *_computed_of(sweep), *map(str, plain), *by_tendon)


def named(sweep: Sweep, name: str) -> Named:
    """Label and unit of a quantity. Raises RobotError for what there is not."""
    _check(sweep, name)
    if name in OF_THE_TIP:
        label, unit = f"{name} of the tip", "m"
    elif name in _UNITS:
        label, unit = name.replace("_", " "), _UNITS[name]
    else:
        array = sweep.dataset[_array(sweep, name)]
        label, unit = (name if "." in name else name.replace("_", " ")), array.attrs["units"]
    factor, shown = SHOWN.get(unit, (1.0, "" if unit == "1" else unit))
    return Named(label, shown, factor)


def derived(sweep: Sweep, name: str, rows: Rows = slice(None)) -> np.ndarray:
    """A quantity of the configurations of these rows, SI units, NaN where there is none. Raises
    RobotError."""
    _check(sweep, name)
    data = sweep.dataset
    if name in OF_THE_TIP:
        return data["tip_position"][rows, OF_THE_TIP.index(name)].values
    if name in _UNITS:
        return _COMPUTED[name](sweep, rows)
    array = _array(sweep, name)
    if array == name:
        values = data[array][rows].values
        return np.where(values < 0, np.nan, values) if values.dtype == np.int8 else values
    column = list(data["tendon"].values).index(name.partition(".")[2])
    return data[array][rows, column].values


def _array(sweep: Sweep, name: str) -> str:
    return name if name in sweep.dataset else name.partition(".")[0]


def _check(sweep: Sweep, name: str) -> None:
    known = names(sweep)
    if name not in known:
        problem, expected = f"the sweep has no {check.show(name)}", check.near(name, known)
        if name in _NEEDS:
            problem += f", which needs the output {_NEEDS[name]}"
        raise RobotError("quantity", problem, expected, value=name)


def _jacobian(sweep: Sweep, rows: Rows) -> np.ndarray:
    """Per full range, of the actuators that vary in the study."""
    reach = sweep.reach
    columns = [k for k, name in enumerate(sweep.dataset["actuator"].values) if name in reach]
    scale = np.array([reach[str(name)] for name in sweep.dataset["actuator"].values[columns]])
    return measures.strokes(sweep.dataset["jacobian"][rows].values[..., columns], scale)


def _condition(sweep: Sweep, rows: Rows) -> np.ndarray:
    length = max(tube.tip for tube in sweep.robot.tubes)
    return measures.condition(_jacobian(sweep, rows), length)


_UNITS = {"manipulability": "m", "isotropy": "1", "condition": "1", "tip_stiffness": "N/m"}
_NEEDS = {
    "manipulability": "jacobian",
    "isotropy": "jacobian",
    "condition": "jacobian",
    "tip_stiffness": "compliance",
    "stability_margin": "stability",
    "stable": "stability",
    "energy": "energy",
}
_COMPUTED: dict[str, Callable[[Sweep, Rows], np.ndarray]] = {
    "manipulability": lambda sweep, rows: measures.manipulability(_jacobian(sweep, rows)),
    "isotropy": lambda sweep, rows: measures.isotropy(_jacobian(sweep, rows)),
    "condition": _condition,
    "tip_stiffness": lambda sweep, rows: measures.tip_stiffness(sweep.dataset["compliance"][rows].values),
}


def _computed_of(sweep: Sweep) -> list[str]:
    found = []
    if "jacobian" in sweep.dataset and set(sweep.dataset["actuator"].values) & set(sweep.reach):
        found += ["manipulability", "isotropy", "condition"]
    return [*found, *(["tip_stiffness"] if "compliance" in sweep.dataset else [])]
