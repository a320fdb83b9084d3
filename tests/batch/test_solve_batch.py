"""A batch gives what tactr.solve gives, item by item, and no item can harm another."""

from typing import Any

import numpy as np
import pytest

import tactr
from tactr import Annulus, Helix, Material, PointLoad, Robot, RobotError, Straight, Tendon, Tube

OUTPUTS = ("shape", "jacobian", "compliance", "stability", "energy", "strain")


def two_tubes(**changes: float) -> Robot:
    """Two precurved tubes, a straight and a helical tendon, a force at the tip."""
    nitinol = Material(E=changes.get("E", 60e9), nu=0.3)
    tubes = [
        Tube(
            "outer",
            length=0.1,
            section=Annulus(1.4e-3, 1.1e-3),
            material=nitinol,
            precurvature=(3.0, 0.0, 0.0),
        ),
        Tube(
            "inner",
            length=changes.get("length", 0.18),
            section=Annulus(0.9e-3, 0.6e-3),
            material=Material(E=75e9, nu=0.33),
            precurvature=(0.0, 5.0, 0.0),
            rotation=0.4,
        ),
    ]
    tendons = [
        Tendon("pull", "outer", Straight(0.0, 4e-3), tension=2.0),
        Tendon("wind", "inner", Helix(3e-3, 9.0), tension=1.0),
    ]
    return Robot(tubes, tendons, [PointLoad("inner", force=(changes.get("load", 0.02), 0.0, -0.01))])


@pytest.fixture(scope="module")
def actuation() -> dict[str, Any]:
    rng = np.random.default_rng(3)
    return {
        "tension": rng.uniform(0.0, 3.0, (12, 2)),
        "rotation": rng.uniform(-1.0, 1.0, (12, 2)),
        "translation": -rng.uniform(0.0, 0.05, (12, 2)),
    }


def test_everything_asked_for_is_what_a_shape_says(actuation: dict[str, Any]) -> None:
    robot = two_tubes()
    batch = tactr.solve_batch(robot, **actuation, outputs=OUTPUTS, stations=21)
    assert batch.converged.all()
    assert batch.centreline is not None and batch.jacobian is not None and batch.s is not None
    assert batch.margin is not None and batch.stable is not None
    assert batch.energy is not None and batch.compliance is not None and batch.strain is not None
    for i in range(len(batch)):
        own: dict[str, Any] = {name: rows[i] for name, rows in actuation.items()}
        shape = tactr.solve(robot, **own, stations=21)
        near: dict[str, Any] = {"rtol": 2e-4, "atol": 1e-9}  # two solves to 1 um
        np.testing.assert_allclose(batch.tip_position[i], shape.tip_position, atol=1e-6)
        np.testing.assert_allclose(batch.tip_quaternion[i], shape.tip_quaternion, atol=1e-5)
        np.testing.assert_allclose(batch.tendon_length[i], [t.length for t in shape.tendons], atol=1e-6)
        np.testing.assert_allclose(batch.s[i], shape.s, atol=1e-15)
        np.testing.assert_allclose(batch.centreline[i], shape.centreline, atol=1e-6)
        jacobian = shape.tip_jacobian()
        for field in jacobian._fields:
            np.testing.assert_allclose(getattr(batch.jacobian, field)[i], getattr(jacobian, field), **near)
        np.testing.assert_allclose(batch.compliance[i], shape.compliance(), rtol=2e-4, atol=1e-6)
        np.testing.assert_allclose(batch.energy[i], shape.energy, **near)
        assert batch.stable[i] == shape.stability.stable
        np.testing.assert_allclose(batch.margin[i], shape.stability.margin, **near)
        rest = [(3.0, 0.0, 0.0), (0.0, 5.0, 0.0)]
        for k, tube in enumerate(shape.tubes):
            worst = np.abs(tube.u - rest[k]).max(axis=0)
            np.testing.assert_allclose(batch.strain[i, k, :3], worst, rtol=1e-4, atol=1e-6)
            np.testing.assert_allclose(
                batch.strain[i, k, 5], np.abs(tube.v[:, 2] - 1.0).max(), rtol=1e-3, atol=1e-12
            )


def test_bad_items_fail_alone(actuation: dict[str, Any]) -> None:
    robot = two_tubes()
    good = tactr.solve_batch(robot, **actuation)
    tension, translation = actuation["tension"].copy(), actuation["translation"].copy()
    tension[2, 0], tension[5, 1], translation[7, 1], tension[9] = np.nan, -1.0, -0.5, 1e7
    bad = tactr.solve_batch(robot, tension=tension, rotation=actuation["rotation"], translation=translation)
    assert (bad.status_names[[2, 5, 7]] == "invalid").all()
    assert not bad.converged[9] and bad.status_names[9] != "invalid"
    assert "pull" in bad.message(2) and "nan" in bad.message(2)
    assert "-1 N" in bad.message(5) and "at least 0" in bad.message(5)
    assert "translation" in bad.message(7)
    assert "no equilibrium" in bad.message(9)
    assert np.isnan(bad.tip_position[[2, 5, 7, 9]]).all()
    others = [0, 1, 3, 4, 6, 8, 10, 11]
    np.testing.assert_array_equal(bad.tip_position[others], good.tip_position[others])
    assert bad.shape(0).converged and len(bad) == 12 and "invalid" in repr(bad)


@pytest.mark.parametrize("threads", [2, 4])
def test_threads_change_no_bit(actuation: dict[str, Any], threads: int) -> None:
    rows: dict[str, Any] = {name: np.tile(table, (20, 1)) for name, table in actuation.items()}
    one = tactr.solve_batch(two_tubes(), **rows, threads=1, outputs=("shape",), stations=5)
    many = tactr.solve_batch(two_tubes(), **rows, threads=threads, outputs=("shape",), stations=5)
    np.testing.assert_array_equal(one.tip_position, many.tip_position)
    np.testing.assert_array_equal(one.centreline, many.centreline)


def test_order_changes_no_bit(actuation: dict[str, Any]) -> None:
    order = np.random.default_rng(0).permutation(12)
    straight = tactr.solve_batch(two_tubes(), **actuation)
    mixed: dict[str, Any] = {name: rows[order] for name, rows in actuation.items()}
    shuffled = tactr.solve_batch(two_tubes(), **mixed)
    np.testing.assert_array_equal(shuffled.tip_position, straight.tip_position[order])
    one: dict[str, Any] = {name: rows[4:5] for name, rows in actuation.items()}
    alone = tactr.solve_batch(two_tubes(), **one)
    np.testing.assert_array_equal(alone.tip_position[0], straight.tip_position[4])


def test_designs_are_robots_built_one_by_one() -> None:
    E, length, load = np.linspace(40e9, 80e9, 5), np.linspace(0.15, 0.2, 5), np.linspace(-0.02, 0.03, 5)
    batch = tactr.solve_batch(
        two_tubes(),
        rotation={"inner": 0.7},
        parameters={"tubes.outer.material.E": E, "tubes.inner.length": length, "loads.0.force.x": load},
        outputs=("shape",),
        stations=11,
    )
    for i in range(5):
        robot = two_tubes(E=E[i], length=length[i], load=load[i])
        shape = tactr.solve(robot, rotation={"inner": 0.7}, stations=11)
        assert batch.centreline is not None
        np.testing.assert_allclose(batch.centreline[i], shape.centreline, atol=1e-6)
        np.testing.assert_array_equal(batch.shape(i).tip_position, shape.tip_position)


def test_a_design_that_cannot_be_is_invalid() -> None:
    batch = tactr.solve_batch(two_tubes(), parameters={"tubes.outer.material.E": [60e9, -1.0]})
    assert list(batch.status_names) == ["converged", "invalid"]
    assert "tubes.outer.material.E" in batch.message(1)


def test_displacements_give_tensions() -> None:
    pulled = np.array([1e-3, 2e-3])
    batch = tactr.solve_batch(two_tubes(), displacement={"pull": pulled}, outputs=("jacobian",))
    for i in range(2):
        shape = tactr.solve(two_tubes(), displacement={"pull": pulled[i]})
        np.testing.assert_array_equal(batch.tip_position[i], shape.tip_position)
        np.testing.assert_array_equal(batch.tension[i], shape.actuator_forces.tension)
        assert batch.jacobian is not None
        np.testing.assert_array_equal(batch.jacobian.displacement[i], shape.tip_jacobian().displacement)


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"tension": np.zeros((4, 3))}, "tension"),
        ({"tension": {"push": 1.0}}, "tension"),
        ({"tension": np.zeros((3, 2)), "rotation": np.zeros((4, 2))}, "rotation"),
        ({"outputs": ("tips",)}, "outputs"),
        ({"threads": 0}, "threads"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"stations": 1, "outputs": ("shape",)}, "stations"),
        ({"parameters": {"tubes.middle.length": 1.0}}, "tubes.middle.length"),
        ({"device": "gpu"}, "device"),
    ],
)
def test_wrong_shapes_and_settings_raise(given: dict[str, Any], field: str) -> None:
    with pytest.raises(RobotError, match=field):
        tactr.solve_batch(two_tubes(), **given)


def test_an_empty_batch_is_empty() -> None:
    batch = tactr.solve_batch(two_tubes(), tension=np.zeros((0, 2)))
    assert len(batch) == 0 and batch.tip_position.shape == (0, 3)


def stepped_tubes(first: float = 0.0, second: float = -0.05) -> Robot:
    """The outer bore narrows and the inner tube thins at sigma = 0.1 m: they fit where the inner one's wide
    part ends behind the narrow bore."""
    soft = Material(E=5e9, nu=0.3)
    narrowing = [(0.0, Annulus(3e-3, 2.5e-3)), (0.1, Annulus(3e-3, 1.5e-3))]
    thinning = [(0.0, Annulus(2e-3, 1e-3)), (0.1, Annulus(1.2e-3, 1e-3))]
    outer = Tube("outer", length=0.2, section=narrowing, material=soft, translation=first)
    inner = Tube("inner", length=0.3, section=thinning, material=soft, translation=second)
    return Robot([outer, inner], [Tendon("pull", "inner", Straight(3e-3, 0.0), tension=1.0)])


def test_stepped_tubes_that_do_not_fit_are_invalid_alone() -> None:
    translation = -np.random.default_rng(8).uniform(0.0, 0.09, (60, 2))
    fits = translation[:, 1] <= translation[:, 0]
    batch = tactr.solve_batch(stepped_tubes(), translation=translation, tension={"pull": 0.5})
    assert 10 < fits.sum() < 50
    np.testing.assert_array_equal(batch.status_names == "invalid", ~fits)
    np.testing.assert_array_equal(batch.converged, fits)
    assert np.isnan(batch.tip_position[~fits]).all()
    good = tactr.solve_batch(stepped_tubes(), translation=translation[fits], tension={"pull": 0.5})
    np.testing.assert_array_equal(batch.tip_position[fits], good.tip_position)
    message = batch.message(int(np.flatnonzero(~fits)[0]))
    assert "tubes[1].section[0].outer_diameter: 0.002 m does not fit into the bore 0.0015 m" in message


def test_stepped_designs_that_do_not_fit_are_invalid_alone() -> None:
    """Each item a robot of its own, its step elsewhere."""
    rng = np.random.default_rng(9)
    step, moved = rng.uniform(0.09, 0.14, 40), -rng.uniform(0.0, 0.05, 40)
    batch = tactr.solve_batch(
        stepped_tubes(), translation={"inner": moved}, parameters={"tubes.inner.section.1.0": step}
    )
    fits = moved + step <= 0.1
    assert 10 < fits.sum() < 30
    np.testing.assert_array_equal(batch.status_names == "invalid", ~fits)
    np.testing.assert_array_equal(batch.converged, fits)


def test_numbers_of_a_design_change_together() -> None:
    """A wider inner tube needs the wider bore, and that the wider outer tube: none fits by itself."""
    paths = ("tubes.inner.section.outer_diameter", "tubes.outer.section.inner_diameter")
    paths += ("tubes.outer.section.outer_diameter",)
    wide = tactr.solve_batch(two_tubes(), parameters=dict(zip(paths, (1.5e-3, 1.6e-3, 1.9e-3), strict=True)))
    assert list(wide.status_names) == ["converged"]
    tubes = wide.robot(0).tubes
    assert tubes[0].section == Annulus(1.9e-3, 1.6e-3) and tubes[1].section == Annulus(1.5e-3, 0.6e-3)
    bad = tactr.solve_batch(two_tubes(), parameters=dict(zip(paths, (1.5e-3, 1.6e-3, -1.0), strict=True)))
    assert "-1 m" in bad.message(0) and all(path in bad.message(0) for path in paths[1:])
    assert paths[0] not in bad.message(0)
