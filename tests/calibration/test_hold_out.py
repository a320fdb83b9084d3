"""Rows held out are predicted by a calibration that has not seen them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import Measurements

from . import simulated

FREE = ["tubes.rod.E", "sensor.x", "sensor.y"]


def data(rows: int = 20) -> Measurements:
    clean = simulated.measured(simulated.tension_robot(), "tension", rows)
    return simulated.noisy(clean, np.random.default_rng(4))


def calibrated(measurements: Measurements, **options) -> tactr.Calibration:
    return tactr.calibrate(simulated.tension_robot(60e9), measurements, parameters=FREE, **options)


def test_a_given_split_is_a_calibration_on_the_others() -> None:
    rows = data()
    mask = np.arange(20) % 3 == 0
    held = calibrated(rows, folds=mask).hold_out
    other = calibrated(rows.rows(~mask))
    assert held is not None and held.folds == ("rows held out",)
    np.testing.assert_allclose(held.error[mask], other.errors(rows.rows(mask)), rtol=1e-5)
    assert np.isnan(held.error[~mask]).all() and (held.fold == np.where(mask, 0, -1)).all()


def test_blocks_and_groups() -> None:
    rows = replace(data(), group=("a", "b") * 10)
    blocks, groups = (calibrated(rows, folds=folds).hold_out for folds in (4, "group"))
    assert blocks is not None and groups is not None
    assert (blocks.fold == np.repeat(np.arange(4), 5)).all() and blocks.folds[1] == "row 5 to row 9"
    assert groups.folds == ("a", "b") and (groups.fold == np.arange(20) % 2).all()
    assert groups.means.shape == (2,) and groups.missing == 0


def test_the_error_of_a_true_model_is_that_of_the_sensor() -> None:
    """The mean length of a vector of three normal numbers of deviation 1 is sqrt(8 / pi)."""
    fit = calibrated(data(48), folds=3)
    assert fit.hold_out is not None
    assert fit.hold_out.mean == pytest.approx(simulated.NOISE * np.sqrt(8 / np.pi), rel=0.15)
    assert fit.hold_out.mean > fit.error.mean()
    assert fit.noise == pytest.approx(simulated.NOISE, rel=0.15)


def test_rows_alike_in_time_are_told() -> None:
    """A drift that the model knows nothing of."""
    rows = data(40)
    drift = 3e-3 * np.sin(np.linspace(0.0, 6.0, 40))
    moved = replace(rows, points=rows.points + drift[:, None, None])
    kinds = {remark.kind for remark in calibrated(moved).remarks}
    assert "alike-errors" in kinds and "alike-errors" not in {r.kind for r in calibrated(rows).remarks}


def test_nothing_free_judges_the_robot() -> None:
    rows = data()
    fit = tactr.calibrate(simulated.tension_robot(), rows, parameters=[])
    assert not fit.estimates and fit.error.mean() == pytest.approx(1.6 * simulated.NOISE, rel=0.3)
    assert fit.robot == simulated.tension_robot()


def test_progress_is_told() -> None:
    seen: list[tuple[str, int, int]] = []
    calibrated(data(6), folds=2, progress=lambda *told: seen.append(told))
    assert {name for name, _, _ in seen} >= {"calibrating", "fold 1 of 2", "fold 2 of 2"}
    assert all(0 <= row < rows for _, row, rows in seen)
