"""A sweep's rows are what tactr.solve gives, and its store is what xarray opens."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
import xarray

import tactr
from tactr import Annulus, FileError, Material, Robot, RobotError, Tube
from tactr.statics.parameters import with_value
from tactr.studies import Range, Samples, Study, Sweep, sweep
from tactr.studies import store as store_module


@pytest.fixture(scope="module")
def done(tendon_study, tmp_path_factory) -> Sweep:
    return sweep(tendon_study, tmp_path_factory.mktemp("done") / "tendons.zarr", threads=1)


def test_every_row_is_a_solve(done, tendon_study):
    data = xarray.open_zarr(done.path, chunks=None)
    assert dict(data.sizes)["sample"] == tendon_study.count == 120
    assert done.complete
    for i in (0, 7, 59, 60, 119):
        row = data.isel(sample=i)
        robot = with_value(tendon_study.robot, "tubes.inner.material.E", float(row["tubes.inner.material.E"]))
        tension = [float(row[f"tendons.{name}.tension"]) for name in ("outer", "inner")]
        rotation = {"inner": float(row["tubes.inner.rotation"])}
        alone = tactr.solve_batch(robot, tension=[tension], rotation=rotation)
        assert row.tip_position.values.tolist() == alone.tip_position[0].tolist()
        assert row.tip_quaternion.values.tolist() == alone.tip_quaternion[0].tolist()
        shape = tactr.solve(robot, tension=tension, rotation=rotation)
        assert done.status_names[int(row.status)] == shape.status.value
        assert row.tip_position.values == pytest.approx(shape.tip_position, abs=1e-10)
        assert row.tip_quaternion.values == pytest.approx(shape.tip_quaternion, abs=1e-9)
        assert float(row.energy) == pytest.approx(shape.energy, rel=1e-9)
        assert bool(row.stable) == shape.stability.stable
        assert float(row.stability_margin) == pytest.approx(shape.stability.margin, rel=1e-9)
        assert row.compliance.values == pytest.approx(shape.compliance(), rel=1e-9, abs=1e-12)
        jacobian = shape.tip_jacobian()
        by_name = row.jacobian.sel(actuator="tendons.inner.tension", pose=["x", "y", "z", "rx", "ry", "rz"])
        assert by_name.values == pytest.approx(jacobian.tension[:, 1], rel=1e-9, abs=1e-12)
        turned = row.jacobian.sel(actuator="tubes.inner.rotation")
        assert turned.values == pytest.approx(jacobian.rotation[:, 1], rel=1e-9, abs=1e-12)


def test_the_store_says_what_it_is(done, tendon_study):
    data = xarray.open_zarr(done.path, chunks=None)
    assert data["tendons.outer.tension"].attrs["units"] == "N"
    assert data["tubes.inner.material.E"].attrs["units"] == "Pa"
    assert data["tip_position"].attrs == {"units": "m", "long_name": "position of the tip, world axes"}
    assert data["tip_position"].dims == ("sample", "axis")
    assert json.loads(data.attrs["study"])["samples"] == {"count": 60, "method": "sobol", "seed": 3}
    assert tactr.io.loads(data.attrs["robot"]) == tendon_study.robot == done.robot
    assert data.attrs["versions"].startswith(f"tactr {tactr.__version__}, numpy ")
    assert data["tip_position"].encoding["chunks"] == (10, 3)


def test_displacements_and_shapes(tmp_path):
    robot = tactr.examples.load("two_tube_90")
    study = Study(
        robot,
        [Range("tendons.outer.displacement", 0.0, 3e-3)],
        samples=Samples(4, method="latin_hypercube"),
        outputs=["tip", "shape", "jacobian"],
        stations=5,
    )
    data = sweep(study, tmp_path / "pulled.zarr").dataset
    assert data.centreline.shape == (4, 5, 3)
    assert list(data.actuator.values[:2]) == ["tendons.outer.displacement", "tendons.inner.tension"]
    row = data.isel(sample=2)
    shape = tactr.solve(robot, displacement={"outer": float(row["tendons.outer.displacement"])}, stations=5)
    assert row.centreline.values == pytest.approx(shape.centreline, abs=1e-9)
    assert float(row.tension.sel(tendon="outer")) == pytest.approx(shape.tension[0], rel=1e-6)
    assert row.jacobian.values[:, 0] == pytest.approx(
        shape.tip_jacobian().displacement[:, 0], rel=1e-6, abs=1e-9
    )


def test_failures_are_rows_with_a_status(tmp_path):
    """Far too much tension for most, and stiffnesses at which nothing is left of a tube."""
    robot = tactr.examples.load("till_straight")
    (tendon, *_) = robot.tendons
    study = Study(robot, [Range(f"tendons.{tendon.name}.tension", 0.0, 1e6)], samples=Samples(16))
    found = sweep(study, tmp_path / "failed.zarr")
    status, tip = found.dataset.status.values, found.dataset.tip_position.values
    assert (status >= 0).all()
    failed = status != 0
    assert failed.any()
    assert np.isnan(tip[failed]).all()
    assert np.isfinite(tip[~failed]).all()
    assert np.isfinite(found.dataset[f"tendons.{tendon.name}.tension"].values).all()
    assert (found.dataset.stable.values[failed] == -1).all()
    summary = found.summary()
    assert sum(summary.statuses.values()) == 16
    assert summary.converged == pytest.approx(1 - failed.mean())


def test_invalid_configurations_are_rows_too(tmp_path):
    """A bore wider than the tube: the number may vary alone, but not everywhere together with the other."""
    robot = tactr.examples.load("two_tube_90")
    study = Study(
        robot,
        [
            Range("tubes.outer.section.inner_diameter", 0.81e-3, 1.0e-3),
            Range("tubes.inner.section.outer_diameter", 0.6e-3, 0.84e-3),
        ],
        samples=Samples(64),
    )
    found = sweep(study, tmp_path / "fit.zarr")
    bore = found.dataset["tubes.outer.section.inner_diameter"].values
    width = found.dataset["tubes.inner.section.outer_diameter"].values
    names = np.array(found.status_names)[found.dataset.status.values]
    assert (width > bore).any()
    assert ((names == "invalid") == (width > bore * (1 + 1e-9))).all()


def test_stepped_tubes_fit_or_are_invalid(tmp_path):
    """The inner tube's wide part, to sigma = 0.1 m, must end before the outer one's narrow bore begins. The
    ends of a range are not refused: what fits depends on the other tube."""
    soft = Material(E=5e9, nu=0.3)
    narrowing = [(0.0, Annulus(3e-3, 2.5e-3)), (0.1, Annulus(3e-3, 1.5e-3))]
    thinning = [(0.0, Annulus(2e-3, 1e-3)), (0.1, Annulus(1.2e-3, 1e-3))]
    outer = Tube("outer", length=0.2, section=narrowing, material=soft)
    robot = Robot([outer, Tube("inner", length=0.3, section=thinning, material=soft)])
    ranges = [Range(f"tubes.{name}.translation", -0.08, 0.0) for name in ("outer", "inner")]
    found = sweep(Study(robot, ranges, samples=Samples(64)), tmp_path / "steps.zarr")
    first, second = (found.dataset[axis.path].values for axis in ranges)
    names = np.array(found.status_names)[found.dataset.status.values]
    fits = second <= first
    assert 20 < fits.sum() < 44
    np.testing.assert_array_equal(names, np.where(fits, "converged", "invalid"))
    assert np.isnan(found.dataset.tip_position.values[~fits]).all()


def test_progress_counts_configurations(tendon_study, tmp_path):
    seen = []
    sweep(tendon_study, tmp_path / "x.zarr", progress=lambda done, count: seen.append((done, count)))
    assert seen == [(done, 120) for done in range(0, 121, 10)]
    seen.clear()
    sweep(tendon_study, tmp_path / "x.zarr", progress=lambda done, count: seen.append((done, count)))
    assert seen == []


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda study: replace(study, samples=Samples(60, seed=4)), "another study"),
        (lambda study: replace(study, chunk=20), "another study"),
        (lambda study: replace(study, robot=study.robot.replace(name="other")), "another robot"),
    ],
)
def test_another_studys_store_is_refused(done, tendon_study, change, told):
    with pytest.raises(FileError, match=told):
        sweep(change(tendon_study), done.path)


def test_another_versions_store_is_refused(done, tendon_study, monkeypatch):
    monkeypatch.setattr(store_module, "versions", lambda: "tactr 99.0")
    with pytest.raises(FileError, match="another set of versions"):
        sweep(tendon_study, done.path)


def test_what_is_no_store_is_refused_and_left_alone(tendon_study, tmp_path):
    (tmp_path / "mine.zarr").mkdir()
    (tmp_path / "mine.zarr" / "thesis.txt").write_text("years of work")
    for path in (tmp_path / "mine.zarr", tmp_path / "mine.zarr" / "thesis.txt"):
        with pytest.raises(FileError, match="no store of a sweep"):
            sweep(tendon_study, path)
        with pytest.raises(FileError, match="no store of a sweep"):
            Sweep(path)
    assert (tmp_path / "mine.zarr" / "thesis.txt").read_text() == "years of work"


def test_options_that_exclude_each_other(tendon_study, tmp_path):
    with pytest.raises(RobotError, match="more than one"):
        sweep(tendon_study, tmp_path / "x.zarr", threads=1, workers=2)
    with pytest.raises(RobotError, match="workers"):
        sweep(tendon_study, tmp_path / "x.zarr", workers=0)


def test_quantities(done):
    assert done.quantity("z") == pytest.approx(done.dataset.tip_position.values[:, 2])
    reach = {"tendons.outer.tension": 4.0, "tendons.inner.tension": 4.0, "tubes.inner.rotation": 6.0}
    assert {k: v for k, v in done.reach.items() if not k.endswith(".E")} == reach
    jacobian = done.dataset.jacobian.sel(actuator=list(reach)).values[5] * np.array(list(reach.values()))
    expected = np.linalg.det(jacobian[:3] @ jacobian[:3].T) ** (1 / 6)
    assert done.quantity("manipulability", slice(5, 6)) == pytest.approx([expected])
    with pytest.raises(RobotError, match="did you mean 'manipulability'"):
        done.quantity("manipulabilty")


def test_the_summary_counts(done):
    summary = done.summary(voxel=0.01)
    assert summary.statuses == {"converged": 120}
    assert summary.converged == summary.stable == 1.0
    assert summary.reached.tips == 120
    tips = done.dataset.tip_position.values
    assert summary.reached.voxels == len({tuple(key) for key in np.floor(tips / 0.01).astype(int)})
    low, median, high = np.quantile(1e3 * tips[:, 2], [0.05, 0.5, 0.95])
    found = summary.quantiles["z"]
    assert (found.low, found.median, found.high) == pytest.approx((low, median, high))
    assert "converged: 100 %" in str(summary)
    json.dumps(summary.to_dict())
    with pytest.raises(RobotError, match="voxel"):
        done.summary(voxel=-1.0)
    with pytest.raises(RobotError, match="at least"):
        done.summary(voxel=1e-12)
