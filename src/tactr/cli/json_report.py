"""The result of a solve as JSON. The keys are part of the interface: they are documented here and do not
change meaning."""

from __future__ import annotations

import json
import re
from typing import Any


def json_report(shape: Any) -> str:
    """JSON text of a shape, SI units (the ending of a key is its unit), world axes.

    Always there: robot (name), converged, status, message, residual (largest scaled equation), iterations,
    discretisation_error_m, displacement_error_m (0 without displacements), solve_time_s. Where converged:
    stability (stable, margin: 1 unloaded, 0 at the limit, conjugate_points_m, and warning: a text or null),
    tip (position_m, quaternion_wxyz), tubes (name, length_m, translation_m, rotation_rad, tip_position_m),
    tendons (name, tube, tension_N, length_m, displacement_m, given: "tension" or "displacement", slack),
    slack (names of the slack ones),
    transition_points (s_m, position_m), centreline (s_m, position_m).
    """
    report = {
        "robot": shape.robot.name,
        "converged": bool(shape.converged),
        "status": str(getattr(shape.status, "value", shape.status)),
        "message": shape.message,
        "residual": _finite(shape.residual),
        "iterations": int(shape.iterations),
        "discretisation_error_m": _finite(shape.discretisation_error),
        "displacement_error_m": _finite(shape.displacement_error),
        "solve_time_s": _finite(shape.solve_time),
    }
    text = json.dumps(report | (_geometry(shape) if shape.converged else {}), indent=2, allow_nan=False)
    return re.sub(
        r"\[\s+([-+.0-9eE,\s]+?)\s+\]", lambda match: f"[{' '.join(match[1].split())}]", text
    )  # vectors on one line


def _geometry(shape: Any) -> dict[str, Any]:
    points, places = shape.transition_points
    tips = shape.sample(sorted({tube.tip for tube in shape.robot.tubes}))
    tip_at = dict(zip(tips.s.tolist(), tips.centreline.tolist(), strict=True))
    return {
        "stability": _stability(shape.stability),
        "tip": {"position_m": shape.tip_position.tolist(), "quaternion_wxyz": shape.tip_quaternion.tolist()},
        "tubes": [
            {
                "name": tube.name,
                "length_m": tube.length,
                "translation_m": tube.translation,
                "rotation_rad": tube.rotation,
                "tip_position_m": tip_at[tube.tip],
            }
            for tube in shape.robot.tubes
        ],
        "tendons": [
            {
                "name": tendon.name,
                "tube": tendon.tube,
                "tension_N": _tension(tendon.tension, tension),
                "length_m": float(drawn.length),
                "displacement_m": pulled,
                "given": "tension" if tendon.displacement is None else "displacement",
                "slack": drawn.slack,
            }
            for tendon, drawn, tension, pulled in zip(
                shape.robot.tendons, shape.tendons, shape.tension, _displacements(shape), strict=True
            )
        ],
        "slack": list(shape.slack),
        "transition_points": [
            {"s_m": float(s), "position_m": point.tolist()} for s, point in zip(places, points, strict=True)
        ],
        "centreline": {"s_m": shape.s.tolist(), "position_m": shape.centreline.tolist()},
    }


def _displacements(shape: Any) -> list[float | None]:
    """Null where there is no rest state to count from."""
    from tactr.errors import NotConverged

    try:
        return shape.displacement.tolist()
    except NotConverged:
        return [None] * len(shape.robot.tendons)


def _stability(stability: Any) -> dict[str, Any]:
    return {
        "stable": stability.stable,
        "margin": _finite(stability.margin),
        "conjugate_points_m": stability.conjugate_points.tolist(),
        "warning": None if stability.stable and not stability.near_limit else str(stability),
    }


def _tension(given: Any, found: float) -> Any:
    if hasattr(given, "sigma"):
        return {"sigma_m": list(given.sigma), "values_N": list(given.values)}
    return float(found)


def _finite(value: float) -> float | None:
    number = float(value)
    return number if abs(number) < float("inf") else None
