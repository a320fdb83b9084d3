"""Two tubes loaded and unloaded. Without friction both ways are the same; with friction they are not."""

from __future__ import annotations

import numpy as np

from tactr import examples
from tactr.plotting.palette import tube_colour
from tactr.reproduce.effects import effects
from tactr.reproduce.loading_friction import COEFFICIENT, COLOURS, Loop, friction_effect, loop_of
from tactr.reproduce.records import Case, Check, Drawn, Experiment, Graph, Line, Panel, verdict
from tactr.reproduce.steel_tube import replaced, with_fitted_steel
from tactr.statics import Shape, follow, solve

OUTER, INNER = 3.0, 2.0  # N, of the two-tube trials
STEPS = 16  # of each tendon, one way
EVERY = 2  # of these steps, with friction

SETTING = (
    "The two-tube robot with tendons 90° apart, as the outer tube's tendon (OT) rules Y and the inner tube's "
    "(IT) X. Tensions are not printed: OT to 3 N, then IT to 2 N as in the two-tube trials, and released the "
    "other way round. The paper's model has no friction; the friction shown here, of tendons along their "
    f"channels, is assumed: a coefficient of {COEFFICIENT}."
)


def run() -> Experiment:
    """Solve it."""
    robot = with_fitted_steel(examples.load("two_tube_90"))
    up = _tensions()
    shapes = follow(robot, {"tension": np.vstack([up, up[-2::-1]])}).shapes
    loading, unloading = shapes[: len(up)], shapes[len(up) - 1 :][::-1]
    cases = (Case("OT 3 N, IT 2 N", solve(robot)),)
    loop = loop_of(robot, up[::EVERY])
    corner = STEPS // EVERY
    first, then = loop.part(slice(None, corner + 1)), loop.part(slice(corner, None))
    return Experiment(
        "loading",
        "Loading and unloading",
        SETTING,
        cases,
        (
            (
                Panel("Every fourth step", "space", _stages(loading)),
                _graph(
                    "OT alone", 0, 1, up[: STEPS + 1], loading[: STEPS + 1], unloading[: STEPS + 1], first
                ),
                _graph("IT, with OT at 3 N", 1, 0, up[STEPS:], loading[STEPS:], unloading[STEPS:], then),
            ),
            (
                _error_graph("OT: from the model without friction", 0, first),
                _error_graph("IT: from the model without friction", 1, then),
            ),
        ),
        "Above: the tip over the tension that is changed, loading and unloading, without friction and with "
        "friction†, which is assumed. Below: how far the tip with friction is from the model without, the "
        "error that such friction would leave it with. The paper's figure shows the tip's error, which needs "
        "the measured shapes.",
        _checks(loading, unloading, loop),
        (friction_effect(robot, loop), *effects(cases, replaced())),
        findings=(
            "The growth of the error in unloading that the paper reports is hysteresis. The model has none, "
            f"so its two lines coincide. With an assumed coefficient of {COEFFICIENT} between tendons and "
            f"channels the two ways are up to {1e3 * loop.width.max():.2f} mm apart at the tip, and start to "
            "part at once where the tension is turned back.",
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


def _graph(title, tendon: int, axis: int, tensions: np.ndarray, loading, unloading, loop: Loop) -> Graph:
    def tips(shapes) -> np.ndarray:
        return np.array([1e3 * shape.tip_position[axis] for shape in shapes])

    x = tensions[:, tendon]
    lines = (
        Line("loading", x, tips(loading), tube_colour(tendon)),
        Line("unloading", x, tips(unloading), "#222222", dashed=True),
        Line(
            "friction†, loading", loop.tensions[:, tendon], 1e3 * loop.loading[:, axis], COLOURS[0], thin=True
        ),
        Line(
            "friction†, unloading",
            loop.tensions[:, tendon],
            1e3 * loop.unloading[:, axis],
            COLOURS[1],
            thin=True,
        ),
    )
    return Graph(title, f"tension of {('OT', 'IT')[tendon]} (N)", f"tip {'xy'[axis]} (mm)", lines)


def _error_graph(title: str, tendon: int, loop: Loop) -> Graph:
    x = loop.tensions[:, tendon]
    lines = (
        Line("friction†, loading", x, 1e3 * loop.error(loop.loading), COLOURS[0], thin=True),
        Line("friction†, unloading", x, 1e3 * loop.error(loop.unloading), COLOURS[1], thin=True),
        Line("one from the other", x, 1e3 * loop.width, "#222222", dashed=True),
    )
    return Graph(title, f"tension of {('OT', 'IT')[tendon]} (N)", "distance at the tip (mm)", lines)


def _checks(loading, unloading, loop: Loop) -> tuple[Check, ...]:
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
        Check(
            "The error grows smoothly when loading, and more in unloading",
            f"its curves' numbers are not printed; {_grows(loop)}",
            "cannot be checked",
        ),
    )


def _grows(loop: Loop) -> str:
    """What assumed friction does to the error of a model without, which is no measurement."""
    error, corner = 1e3 * loop.error(loop.loading), STEPS // EVERY
    grows = "grows at every step" if (np.diff(error) > -1e-3).all() else "does not grow at every step"
    back = 1e3 * loop.width
    return (
        f"with the friction assumed the distance from the model without it {grows} of loading, to "
        f"{error[corner]:.2f} mm (OT) and {error[-1]:.2f} mm (IT); a model that met the loading would be off "
        f"by up to {back.max():.2f} mm in unloading"
    )
