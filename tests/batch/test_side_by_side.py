"""Configurations solved side by side: the shapes of one by one, the same bits whatever stands beside them."""

import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import _core
from tactr.batch.designs import design_of
from tactr.statics.held import MOST_STEPS

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
if not BENCHMARKS.exists():
    pytest.skip("no benchmarks folder: the robots are drawn there", allow_module_level=True)
sys.path.insert(0, str(BENCHMARKS))
random_robot = import_module("random_robots").random_robot
three_tubes = import_module("speed").three_tubes

TOLERANCE = 1e-6


def kernel(
    robot: tactr.Robot, tension: np.ndarray, rotation: np.ndarray, lanes: str, *, tolerance: float = TOLERANCE
) -> dict[str, Any]:
    """The kernel's batch, with chosen instructions."""
    design, items = design_of(robot, tolerance), len(tension)
    return _core.solve_batch(
        [design.core],
        np.ascontiguousarray(tension),
        np.ascontiguousarray(rotation),
        np.tile(design.translation, (items, 1)),
        np.full(items, design.residual_tolerance),
        np.zeros(items, dtype=np.uint8),
        np.zeros((1, 1)),
        tolerance,
        MOST_STEPS,
        [],
        1,
        lanes,
    )


def three_tube_rows(items: int) -> tuple[tactr.Robot, np.ndarray, np.ndarray]:
    """The robot of the benchmark at random tensions and rotations."""
    robot, rng = three_tubes(), np.random.default_rng(5)
    return robot, rng.uniform(0.0, 4.0, (items, 3)), rng.uniform(-0.8, 1.6, (items, 3))


def same(a: dict[str, Any], b: dict[str, Any]) -> None:
    """The same results bit by bit, where both were solved."""
    for name in ("status", "tip_position", "tip_quaternion", "tendon_length", "residual", "side_by_side"):
        np.testing.assert_array_equal(a[name], b[name])


def test_most_go_side_by_side_and_agree_with_one_by_one() -> None:
    """Also where Newton's first steps lead uphill, to the other side of a snap: one in seven of these."""
    rows = three_tube_rows(150)
    packed, alone = kernel(*rows, "baseline"), kernel(*rows, "none")
    assert packed["side_by_side"].mean() > 0.95 and not alone["side_by_side"].any()
    assert (packed["status"] == 0).all() and (packed["discretisation_error"] <= TOLERANCE).all()
    np.testing.assert_allclose(packed["tip_position"], alone["tip_position"], atol=TOLERANCE)
    np.testing.assert_allclose(packed["tendon_length"], alone["tendon_length"], atol=TOLERANCE)


def test_instructions_change_no_bit() -> None:
    rows = three_tube_rows(37)
    try:
        wide = kernel(*rows, "avx2")
    except ValueError as error:
        pytest.skip(str(error))
    same(kernel(*rows, "baseline"), wide)


def test_as_on_a_device_the_same_source_agrees_to_a_nanometre() -> None:
    """One configuration a thread, numbers in strided rows: run on this processor."""
    robot, tension, rotation = three_tube_rows(70)
    single = kernel(robot, tension, rotation, "single", tolerance=1e-9)
    assert single["side_by_side"].mean() > 0.8
    same(single, kernel(robot, tension, rotation, "baseline", tolerance=1e-9))
    for i in range(0, 70, 7):
        shape = tactr.solve(robot, tension=tension[i], rotation=rotation[i], tolerance=1e-9)
        np.testing.assert_allclose(single["tip_position"][i], shape.tip_position, atol=1e-9)


def test_neighbours_and_order_change_no_bit() -> None:
    robot, tension, rotation = three_tube_rows(45)
    order = np.random.default_rng(1).permutation(45)
    straight, mixed = (
        kernel(robot, tension, rotation, "widest"),
        kernel(robot, tension[order], rotation[order], "widest"),
    )
    for name in ("tip_position", "tip_quaternion", "tendon_length", "residual", "discretisation_error"):
        np.testing.assert_array_equal(mixed[name], straight[name][order])
    for i in (0, 17, 44):
        one = kernel(robot, tension[i : i + 1], rotation[i : i + 1], "widest")
        np.testing.assert_array_equal(one["tip_position"][0], straight["tip_position"][i])


def test_random_robots_as_one_by_one() -> None:
    """One to four tubes with all kinds of routings, loads and insertions; same status and stability."""
    packed, other_branch = 0, []
    for seed in range(60):
        robot = random_robot(seed)
        rng = np.random.default_rng(seed)
        own = design_of(robot, TOLERANCE)
        tension = own.tension * rng.uniform(0.5, 1.0, (5, len(own.tension)))
        rotation = own.rotation + rng.uniform(-0.3, 0.3, (5, len(own.rotation)))
        side, alone = kernel(robot, tension, rotation, "widest"), kernel(robot, tension, rotation, "none")
        packed += int(side["side_by_side"].sum())
        np.testing.assert_array_equal(side["status"], alone["status"])
        np.testing.assert_array_equal(side["unstable"], alone["unstable"])
        off = np.abs(side["tip_position"] - alone["tip_position"]).max(axis=1)
        met = (alone["status"] == 0) & (side["side_by_side"] == 1)
        other_branch += [(seed, i) for i in np.flatnonzero(met & (off > 2 * TOLERANCE))]
    assert packed > 80
    assert other_branch == []


def test_a_pack_of_designs_with_other_insertions() -> None:
    """Robots cut into other sections go in other packs, and come out as they are alone."""
    robot, rng = three_tubes(), np.random.default_rng(2)
    back = -rng.uniform(0.0, 0.13, (40, 3))
    batch = tactr.solve_batch(
        robot, translation=back, parameters={"tubes.tube 1.material.E": np.linspace(3e10, 6e10, 40)}
    )
    for i in range(0, 40, 5):
        shape = batch.shape(i)
        assert shape.status.value == batch.status_names[i]
        np.testing.assert_allclose(batch.tip_position[i], shape.tip_position, atol=TOLERANCE)


def test_what_winds_too_fast_for_packs_goes_one_by_one() -> None:
    """A helix of thousands of turns: no pack holds its steps, and it must not harm the batch."""
    tube = tactr.Tube(
        "tube", length=0.2, section=tactr.Annulus(2e-3, 1.6e-3), material=tactr.Material(E=60e9, nu=0.3)
    )
    robot = tactr.Robot([tube], [tactr.Tendon("helix", "tube", tactr.Helix(3e-3, 6.6e5), tension=1.0)])
    packed = kernel(robot, np.array([[1.0]]), np.zeros((1, 1)), "baseline")
    assert not packed["side_by_side"].any()
    same(packed, kernel(robot, np.array([[1.0]]), np.zeros((1, 1)), "none"))
