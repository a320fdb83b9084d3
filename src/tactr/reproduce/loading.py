"""Two tubes loaded and unloaded. Without friction both ways are the same; friction would be a line more."""

from __future__ import annotations

import numpy as np

from tactr import examples
from tactr.plotting.palette import tube_colour
from tactr.reproduce.records import Case, Check, Drawn, Experiment, Graph, Line, Panel, verdict
from tactr.reproduce.steel_tube import replaced, with_fitted_steel
from tactr.statics import Shape, follow, solve

OUTER, INNER = 3.0, 2.0  # N, of the two-tube trials
STEPS = 16  # of each tendon, one way

SETTING = (
    "The two-tube robot with tendons 90° apart, as the outer tube's tendon (OT) rules Y and the inner tube's "
    "(IT) X. Tensions are not printed: OT to 3 N, then IT to 2 N as in the two-tube trials, and released the "
    "other way round. Friction is not modelled yet, and the paper does not model it either."
)


def run() -> Experiment:
    """Solve it."""
    robot = with_fitted_steel(examples.load("two_tube_90"))
    up = _tensions()
    shapes = follow(robot, {"tension": np.vstack([up, up[-2::-1]])}).shapes
    loading, unloading = shapes[: len(up)], shapes[len(up) - 1 :][::-1]
    loaded = solve(robot)
    return Experiment(
        "loading",
        "Loading and unloading",
        SETTING,
        (Case("OT 3 N, IT 2 N", loaded),),
        (
            (
                Panel("Every fourth step", "space", _stages(loading)),
                _graph("OT alone", 0, 1, up[: STEPS + 1], loading[: STEPS + 1], unloading[: STEPS + 1]),
                _graph("IT, with OT at 3 N", 1, 0, up[STEPS:], loading[STEPS:], unloading[STEPS:]),
            ),
        ),
        "The tip over the tension that is changed, loading and unloading. The paper's figure shows the tip's "
        "error, which needs the measured shapes.",
        _checks(loading, unloading),
        (),
        findings=(
            "The growth of the error in unloading that the paper reports is hysteresis. The model has none, "
            "so its two lines coincide; a friction model would open a loop here.",
        ),
        replaced=replaced(),
        printed="curves only",
    )


def _tensions() -> np.ndarray:
    """OT up, then IT up: (points, 2) in N."""
    outer, inner = np.linspace(0.0, OUTER, STEPS + 1), np.linspace(0.0, INNER, STEPS + 1)
    first = np.column_stack([outer, np.zeros_like(outer)])
    return np.vstack([first, np.column_stack([np.full(STEPS, OUTER), inner[1:]])])


def _stages(loading: tuple[Shape, ...]) -> tuple[Drawn, ...]:
    places = range(0, len(loading), 4)
    labels = {0: "rest", STEPS: "OT 3 N", 2 * STEPS: "OT 3 N, IT 2 N"}
    return tuple(Drawn(loading[k], labels.get(k, ""), faded=k < 2 * STEPS) for k in places)


def _graph(title, tendon: int, axis: int, tensions: np.ndarray, loading, unloading) -> Graph:
    def tips(shapes) -> np.ndarray:
        return np.array([1e3 * shape.tip_position[axis] for shape in shapes])

    x = tensions[:, tendon]
    lines = (
        Line("loading", x, tips(loading), tube_colour(tendon)),
        Line("unloading", x, tips(unloading), "#222222", dashed=True),
    )
    return Graph(title, f"tension of {('OT', 'IT')[tendon]} (N)", f"tip {'xy'[axis]} (mm)", lines)


def _checks(loading, unloading) -> tuple[Check, ...]:
    tips = np.array([shape.tip_position for shape in loading])
    back = np.array([shape.tip_position for shape in unloading])
    apart = 1e3 * float(np.linalg.norm(tips - back, axis=1).max())
    outer, inner = 1e3 * (tips[STEPS] - tips[0]) + 0.0, 1e3 * (tips[-1] - tips[STEPS]) + 0.0
    return (
        Check(
            "The outer tube's tendon is primarily responsible for bending in Y",
            f"it moves the tip by x = {outer[0]:.1f}, y = {outer[1]:.1f} mm",
            verdict(abs(outer[1]) > abs(outer[0])),
        ),
        Check(
            "The inner tube's tendon governs bending in X",
            f"it moves the tip by x = {inner[0]:.1f}, y = {inner[1]:.1f} mm",
            verdict(abs(inner[0]) > abs(inner[1])),
        ),
        Check(
            "The model has no hysteresis (the paper's section on limitations)",
            f"loading and unloading are at most {1e3 * apart:.2f} um apart at the tip",
            verdict(apart < 2e-3),
        ),
        Check("The error's curves", "their numbers are not printed", "cannot be checked"),
    )
