"""The shared cases: published equations solved by an independent shooting code, good to 1e-8 m."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import (
    Annulus,
    DistributedLoad,
    Helix,
    Material,
    PointLoad,
    Robot,
    Straight,
    Tendon,
    Tube,
)

NAMES = (
    "one_tube_helical_loaded",
    "two_tubes_orthogonal_own",
    "two_tubes_orthogonal_outermost",
    "two_precurved_tubes_no_tendon",
    "three_tubes_mixed",
)


def robot_of(case: dict[str, Any]) -> Robot:
    tubes = [
        Tube(
            f"tube {i}",
            length=tube["length"],
            section=Annulus(tube["outer_diameter"], tube["inner_diameter"]),
            material=Material(E=tube["youngs_modulus"], G=tube["shear_modulus"]),
            precurvature=tube["precurvature"],
            rotation=rotation,
        )
        for i, (tube, rotation) in enumerate(zip(case["tubes"], case["base_rotation"], strict=True))
    ]
    tendons = [
        Tendon(
            f"tendon {j}", f"tube {t['tube']}", routing_of(t["routing"]), host=t["host"], tension=t["tension"]
        )
        for j, t in enumerate(case["tendons"])
    ]
    loads: list[PointLoad | DistributedLoad] = []
    if "tip_force" in case:
        loads.append(PointLoad(tubes[-1].name, force=case["tip_force"], moment=case["tip_moment"]))
    if "distributed_force" in case:
        loads.append(DistributedLoad(force=case["distributed_force"]))
    return Robot(tubes, tendons, loads)


def routing_of(entry: dict[str, Any]) -> Straight | Helix:
    if entry["kind"] == "straight":
        return Straight(entry["x"], entry["y"])
    return Helix(entry["radius"], entry["rate"], entry["phase"])


@pytest.mark.parametrize("name", NAMES)
def test_case_within_a_tenth_of_a_micrometre_at_every_station(shared: Path, name: str) -> None:
    case = json.loads((shared / "cases.json").read_text(encoding="utf-8"))["cases"][name]
    shape = tactr.solve(robot_of(case), tolerance=1e-8, stations=len(case["centerline"]))
    assert shape.converged, shape.message
    np.testing.assert_allclose(shape.centreline, case["centerline"], rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(shape.tip_position, case["tip_position"], rtol=0.0, atol=1e-8)


def test_no_case_is_left_out(shared: Path) -> None:
    assert set(json.loads((shared / "cases.json").read_text(encoding="utf-8"))["cases"]) == set(NAMES)
