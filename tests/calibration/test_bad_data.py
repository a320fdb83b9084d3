"""Bad data end in clear errors or in remarks with a name."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import tactr
from tactr import FileError, Frame, Measurements, Parameter, RobotError

from . import simulated

HEADER = "displacement.t0 [mm],displacement.t1 [mm],displacement.t2 [mm],tip.x [mm],tip.y [mm],tip.z [mm]"
ROBOT = simulated.displacement_robot()
FREE = [Parameter("tendons.*.compliance", common=True), "tendons.t0.zero"]


def table(rows: int = 12, factor: float = 1e3) -> np.ndarray:
    """Displacements and tips of the robot with noise, mm."""
    data = simulated.noisy(simulated.measured(ROBOT, "displacement", rows), np.random.default_rng(2))
    return np.column_stack([*data.displacement.values(), data.points[:, 0]]) * factor


def written(path: Path, rows: np.ndarray, header: str = HEADER) -> Path:
    lines = [",".join("" if np.isnan(v) else repr(float(v)) for v in row) for row in rows]
    path = path / "data.csv"
    path.write_text("# measured in a test\n" + "\n".join([header, *lines]) + "\n", encoding="utf-8")
    return path


def kinds(fit: tactr.Calibration) -> set[str]:
    return {remark.kind for remark in fit.remarks}


def test_good_data_have_no_remarks(tmp_path: Path) -> None:
    data = Measurements.read(written(tmp_path, table()))
    fit = tactr.calibrate(ROBOT, data, parameters=FREE)
    assert not fit.remarks and len(data) == 12 and data.lines is not None and data.lines[0] == 3


@pytest.mark.parametrize(
    ("header", "told"),
    [
        (HEADER.replace("tip.z", "tip.w"), r"'tip.w \[mm\]' is not known"),
        (HEADER.replace(",tip.z [mm]", ""), "tip.z is missing"),
        (HEADER.replace("tip.x [mm]", "tip.x"), "no unit.*tip.x .mm"),
        (HEADER.replace("tip.x [mm]", "tip.x [N]"), "is a force.*a length"),
        (HEADER.replace("tip.x [mm]", "tip.x [mn]"), "mn"),
        (HEADER.replace("t1 [mm]", "t0 [mm]"), "two columns"),
        (HEADER.replace("displacement", "pull"), "is not known"),
        ("tip.x [mm],tip.y [mm],tip.z [mm]", "actuated"),
    ],
)
def test_columns_that_cannot_be(header: str, told: str, tmp_path: Path) -> None:
    rows = (
        table()[:, -header.count(",") - 1 :]
        if header.startswith("tip")
        else table()[:, : header.count(",") + 1]
    )
    with pytest.raises(FileError, match=told) as caught:
        Measurements.read(written(tmp_path, rows, header))
    assert caught.value.line == 2


def test_a_column_named_by_the_mapping_is_missing(tmp_path: Path) -> None:
    path = written(tmp_path, table())
    with pytest.raises(FileError, match=r"no column 'x'.*tip\.x \[mm\]"):
        Measurements.read(path, columns={"tip.x": "x [mm]"})


def test_no_file_and_no_rows(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no such file"):
        Measurements.read(tmp_path / "none.csv")
    with pytest.raises(FileError, match="holds no rows"):
        Measurements.read(written(tmp_path, np.empty((0, 6))))


def test_text_in_a_cell(tmp_path: Path) -> None:
    path = written(tmp_path, table())
    path.write_text(
        path.read_text().replace("\n", "\n1,2,three,4,5,6\n", 2).replace("1,2,three,4,5,6\n", "", 1)
    )
    with pytest.raises(FileError, match=r"data.csv:3: displacement.t2: 'three' is not a number"):
        Measurements.read(path)


def test_a_tendon_that_the_robot_has_not(tmp_path: Path) -> None:
    data = Measurements.read(written(tmp_path, table(), HEADER.replace("t2", "t7")))
    with pytest.raises(RobotError, match=r"no tendon 't7'.*'t0'"):
        tactr.calibrate(ROBOT, data, parameters=["tubes.rod.E"])


@pytest.mark.parametrize("factor", [1e6, 1e3 * 25.4])
def test_units_too_large(factor: float, tmp_path: Path) -> None:
    """Micrometres or thousandths of an inch called mm."""
    data = Measurements.read(written(tmp_path, table(factor=factor)))
    with pytest.raises(RobotError, match="unit"):
        tactr.calibrate(ROBOT, data, parameters=FREE)


def test_units_too_small(tmp_path: Path) -> None:
    """Tips in metres called mm."""
    rows = table()
    rows[:, 3:] /= 1e3
    fit = tactr.calibrate(ROBOT, Measurements.read(written(tmp_path, rows)), parameters=["sensor.*"])
    assert "units" in kinds(fit)


def test_rows_without_numbers_are_left_out_and_named(tmp_path: Path) -> None:
    rows = table()
    rows[3, 4] = rows[7, 0] = np.nan
    data = Measurements.read(written(tmp_path, rows))
    assert len(data) == 10
    fit = tactr.calibrate(ROBOT, data, parameters=FREE)
    (remark,) = fit.remarks
    assert remark.kind == "missing-numbers" and "2 of 12 rows" in remark.text and "6, 10" in remark.text


def test_nothing_but_rows_without_numbers(tmp_path: Path) -> None:
    rows = table()
    rows[:, 0] = np.nan
    with pytest.raises(FileError, match="every row"):
        Measurements.read(written(tmp_path, rows))


def test_outliers_are_named_and_a_robust_loss_withstands_them(tmp_path: Path) -> None:
    rows = table(24)
    rows[5, 3:] += 25.0
    rows[17, 3:] -= 30.0
    data = Measurements.read(written(tmp_path, rows))
    true = 4e-4
    plain = tactr.calibrate(ROBOT, data, parameters=FREE)
    robust = tactr.calibrate(ROBOT, data, parameters=FREE, loss="cauchy")
    for fit in (plain, robust):
        (remark,) = [each for each in fit.remarks if each.kind == "outliers"]
        assert "line 8" in remark.text and "line 20" in remark.text
    estimate = robust["tendons.*.compliance"]
    assert estimate.value is not None and estimate.error is not None and plain["tendons.*.compliance"].error
    assert abs(estimate.value - true) < 3 * estimate.error < plain["tendons.*.compliance"].error


@pytest.mark.parametrize("flip", [(1, -1, 1), (-1, 1, 1)])
def test_left_handed_axes(flip: tuple[int, int, int], tmp_path: Path) -> None:
    rows = table()
    rows[:, 3:] *= flip
    fit = tactr.calibrate(ROBOT, Measurements.read(written(tmp_path, rows)), parameters=[*FREE, "sensor.*"])
    assert "left-handed-axes" in kinds(fit)


def test_turned_axes(tmp_path: Path) -> None:
    """x and y both point the other way."""
    rows = table()
    rows[:, 3:5] *= -1
    data = Measurements.read(written(tmp_path, rows))
    assert "turned-axes" in kinds(tactr.calibrate(ROBOT, data, parameters=FREE))
    turn = Parameter("sensor.rz", start=2.5)
    right = tactr.calibrate(ROBOT, data, parameters=[*FREE, turn])
    assert "turned-axes" not in kinds(right) and right["sensor.rz"].value == pytest.approx(np.pi, abs=0.05)


def test_fewer_numbers_than_parameters(tmp_path: Path) -> None:
    data = Measurements.read(written(tmp_path, table()[:2]))
    with pytest.raises(RobotError, match="10 free numbers, but only 6 coordinates measured in 2 rows"):
        tactr.calibrate(ROBOT, data, parameters=["sensor.*", "tendons.*.zero", "tubes.rod.E"])


def test_far_from_the_guide_without_a_free_sensor(tmp_path: Path) -> None:
    rows = table()
    rows[:, 3] += 2000.0
    data = Measurements.read(written(tmp_path, rows))
    with pytest.raises(RobotError, match=r"sensor\.x"):
        tactr.calibrate(ROBOT, data, parameters=FREE)
    moved = tactr.calibrate(ROBOT, data, parameters=[*FREE, "sensor.x"])
    assert moved["sensor.x"].value == pytest.approx(2.0, abs=1e-3)


def test_rows_without_an_equilibrium_are_named() -> None:
    """A tension at which the rod buckles far beyond what it can take."""
    robot = simulated.tension_robot()
    data = simulated.measured(robot, "tension", 8)
    tension = {name: values.copy() for name, values in data.tension.items()}
    tension["t0"][2] = 900.0
    fit = tactr.calibrate(robot, Measurements(data.points, tension=tension), parameters=["tubes.rod.E"])
    (remark,) = [each for each in fit.remarks if each.kind == "no-equilibrium"]
    assert "row 2" in remark.text and np.isnan(fit.error[2]) and np.isfinite(np.delete(fit.error, 2)).all()


@pytest.mark.parametrize(
    ("parameters", "told"),
    [
        (["tubes.rod.colour"], "nothing of the robot is called 'tubes.rod.colour'"),
        (["tendons.t0.zero", "tendons.*.zero"], "free twice"),
        (["tendons.t7.zero"], "only tendons whose displacement is measured have a zero"),
        ([3], "paths or Parameter objects"),
        ([Parameter("tubes.rod.E", lower=70e9)], "a start within"),
    ],
)
def test_parameters_that_cannot_be(parameters: list, told: str) -> None:
    data = simulated.measured(ROBOT, "displacement", 5)
    with pytest.raises(RobotError, match=told):
        tactr.calibrate(ROBOT, data, parameters=parameters)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"loss": "tukey"}, "loss.*huber"),
        ({"starts": 0}, "starts"),
        ({"noise": 0.0}, "noise"),
        ({"folds": 1}, "folds"),
        ({"folds": "group"}, "group"),
        ({"folds": np.zeros(5, bool)}, "folds"),
    ],
)
def test_options_that_cannot_be(options: dict, told: str) -> None:
    data = simulated.measured(ROBOT, "displacement", 5)
    with pytest.raises(RobotError, match=told):
        tactr.calibrate(ROBOT, data, parameters=FREE, **options)


def test_both_a_displacement_and_a_tension() -> None:
    data = Measurements(np.full((3, 3), 0.1), displacement={"t0": np.zeros(3)}, tension={"t0": np.ones(3)})
    with pytest.raises(RobotError, match="both measured"):
        tactr.calibrate(ROBOT, data, parameters=[])


def test_points_beyond_the_robot() -> None:
    data = Measurements(np.full((3, 3), 0.1), places=(0.5,), displacement={"t0": np.zeros(3)})
    with pytest.raises(RobotError, match="ends at 200 mm"):
        tactr.calibrate(ROBOT, data, parameters=[], frame=Frame())


def test_zeros_of_tendons_on_tubes_that_move() -> None:
    data = Measurements(
        np.full((9, 3), 0.1), displacement={"t0": np.zeros(9)}, rotation={"rod": np.linspace(0.0, 1.0, 9)}
    )
    with pytest.raises(RobotError, match=r"tendons\.t0\.zero.*rest_length"):
        tactr.calibrate(ROBOT, data, parameters=["tendons.t0.zero"])


@pytest.mark.parametrize("kind", ["tension", "displacement"])
def test_what_is_measured_cannot_be_free(kind: str) -> None:
    robot = simulated.tension_robot() if kind == "tension" else ROBOT
    robot = robot.with_actuation(tension={"t0": 1.0})
    data = Measurements(np.full((9, 3), 0.1), **{kind: {"t0": np.linspace(0.0, 1e-3, 9)}})  # pyright: ignore
    with pytest.raises(RobotError, match=r"tendons\.t0\.tension: the data say"):
        tactr.calibrate(robot, data, parameters=["tendons.t0.tension"])


def test_tubes_that_the_data_turn_cannot_be_free() -> None:
    data = Measurements(np.full((9, 3), 0.1), rotation={"rod": np.linspace(0.0, 1.0, 9)})
    with pytest.raises(RobotError, match=r"tubes\.rod\.rotation: the data say"):
        tactr.calibrate(ROBOT, data, parameters=["tubes.rod.rotation"])


def test_tendons_that_push_are_named_with_their_line(tmp_path: Path) -> None:
    rows = table()
    rows[4, 1] = -0.5
    header = HEADER.replace("displacement", "tension").replace("[mm]", "[N]", 3)
    rows[:, :3] = np.abs(rows[:, :3])
    rows[4, 1] *= -1
    data = Measurements.read(written(tmp_path, rows, header))
    with pytest.raises(RobotError, match=r"tension\.t1: -0\.5 N in line 7; expected at least 0 N"):
        tactr.calibrate(simulated.tension_robot(), data, parameters=["tubes.rod.E"])


def test_a_near_miss_of_a_path_is_answered_first() -> None:
    data = simulated.measured(ROBOT, "displacement", 5)
    with pytest.raises(RobotError, match=r"'tubes.rood.E'; expected such as 'tubes.rod.material.E'"):
        tactr.calibrate(ROBOT, data, parameters=["tubes.rood.E"])


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace(",", ";"),
        lambda text: text.replace(",", "\t"),
        lambda text: text.replace("\n", "\r\n"),
        lambda text: "\ufeff" + text,
        lambda text: text.replace("\n", ",,\n"),
        lambda text: text.replace("[mm]", "(mm)"),
    ],
)
def test_dialects_of_csv_say_the_same(change, tmp_path: Path) -> None:
    path = written(tmp_path, table())
    plain = Measurements.read(path)
    path.write_bytes(change(path.read_text(encoding="utf-8")).encode())
    again = Measurements.read(path)
    np.testing.assert_array_equal(again.points, plain.points)
    assert list(again.displacement) == list(plain.displacement)
    assert again.lines is not None and plain.lines is not None and (again.lines == plain.lines).all()


def decimal_commas(text: str) -> str:
    return re.sub(r"(\d)\.(\d)", r"\1,\2", text)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda text: "", "data.csv: is empty"),
        (lambda text: text.replace(HEADER, f"# {HEADER}"), "data.csv:3: .*no names.*not behind a #"),
        (
            lambda text: decimal_commas(text.replace(",", ";")),
            "csv:3: displacement.t0: .* with a decimal point",
        ),
        (decimal_commas, "csv:3: 12 cells, but the head names 6 columns.*decimal points"),
    ],
)
def test_files_that_say_something_else(change, told: str, tmp_path: Path) -> None:
    path = written(tmp_path, table())
    path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(FileError, match=told):
        Measurements.read(path)


def test_other_encodings_are_named(tmp_path: Path) -> None:
    path = written(tmp_path, table())
    path.write_bytes(path.read_text(encoding="utf-8").replace("[mm]", "[µm]").encode("latin-1"))
    with pytest.raises(FileError, match="data.csv:2: is not a text in UTF-8"):
        Measurements.read(path)


def test_a_group_missing_at_the_end_of_a_line_is_empty(tmp_path: Path) -> None:
    path = written(tmp_path, table(), HEADER + ",group")
    assert Measurements.read(path).group == ("",) * 12


def test_the_mapping_may_repeat_the_unit_that_the_head_has(tmp_path: Path) -> None:
    header = "d [mm],b,c,x [mm],y,z"
    path = written(tmp_path, table(), header)
    columns = {"displacement.t0": "d [mm]", "tip.x": "x [mm]", "tip.y": "y [mm]", "tip.z": "z [mm]"}
    assert Measurements.read(path, columns=columns).points == pytest.approx(table()[:, None, 3:] / 1e3)
