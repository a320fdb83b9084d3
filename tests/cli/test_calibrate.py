"""The command `calibrate`."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import numpy as np
import pytest

import tactr
from tactr import Material, Robot, Rod, Straight, Tendon, Tube

TRUE = 52e9


def robot(E: float) -> Robot:
    rod = Tube("rod", length=0.2, section=Rod(1e-3), material=Material(E=E, nu=0.3))
    return Robot([rod], [Tendon(f"t{k}", "rod", Straight.polar(5e-3, 2.0 * k)) for k in range(3)])


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    """A robot file with a wrong modulus, and tips of the true one, 8 mm markers on it, in 10 rows."""
    rng = np.random.default_rng(5)
    tensions = rng.uniform(0.0, 2.0, (10, 3))
    header = "tension.t0 [N],tension.t1 [N],tension.t2 [N],tip.x [mm],tip.y [mm],tip.z [mm],group"
    lines = ["# weighed and filmed", header]
    for k, tension in enumerate(tensions):
        shape = tactr.solve(robot(TRUE), tension=tension)
        tip = shape.tip_position + 8e-3 * shape.tip_orientation[:, 2] + rng.normal(0.0, 1e-4, 3)
        lines.append(
            ",".join([*map(repr, map(float, tension)), *map(repr, map(float, 1e3 * tip)), "ab"[k // 5]])
        )
    tactr.save(robot(65e9), tmp_path / "robot.yaml")
    (tmp_path / "data.csv").write_text("\n".join(lines) + "\n")
    return tmp_path / "robot.yaml", tmp_path / "data.csv"


FREE = ("--free", "tubes.rod.E", "--set", "marker.z=8 mm")


def test_a_calibration_and_its_files(run, files, tmp_path):
    saved, plotted = tmp_path / "calibrated.yaml", tmp_path / "residuals.png"
    words = (*FREE, "--folds", "group", "--save", str(saved), "--plot", str(plotted))
    code, out, err = run("calibrate", *map(str, files), *words)
    assert (code, err) == (0, "")
    assert "tubes.rod.material.E" in out and "held out: mean" in out and "2 folds" in out
    assert f"wrote {saved}" in out and plotted.stat().st_size > 10_000
    assert tactr.load(saved).tubes[0].material.E == pytest.approx(TRUE, rel=0.01)  # pyright: ignore


def test_the_saved_robot_with_the_settings_told_fits_as_well(run, files, tmp_path):
    saved = tmp_path / "calibrated.yaml"
    free = ("--free", "tubes.rod.E", "sensor.rx", "sensor.[xyz]", "--set", "marker.z=8 mm")
    _, out, _ = run("calibrate", *map(str, files), *free, "--save", str(saved))
    told = shlex.split(out.splitlines()[-1].partition(": ")[2])
    assert told[0] == "--set" and len(told) == 6
    _, again, _ = run("calibrate", str(saved), str(files[1]), *told)
    (error,), (error_again,) = ([x for x in o.splitlines() if x.startswith("error:")] for o in (out, again))
    assert error == error_again


def test_json(run, files):
    code, out, _ = run("calibrate", *map(str, files), *FREE, "--json")
    (estimate,) = json.loads(out)["estimates"]
    assert code == 0 and estimate["name"] == "tubes.rod.material.E" and estimate["unit"] == "Pa"
    low, high = estimate["interval_95"]
    assert low < TRUE < high and json.loads(out)["frame"]["marker"] == [0.0, 0.0, 8e-3]


def test_bounds_priors_and_common_numbers(run, files):
    words = ("--common", "tendons.*.routing.x", "--free", "tubes.rod.E", "marker.z")
    words += ("--bounds", "tubes.rod.E=60 GPa, 80 GPa", "--prior", "marker.z=8 mm, 1 mm")
    code, out, _ = run("calibrate", *map(str, files), *words)
    assert code == 0 and "at its bound" in out and "warning: at-bound" in out


def test_without_free_numbers_the_robot_is_judged(run, files):
    code, out, _ = run("calibrate", *map(str, files), "--set", "marker.z=8 mm", "tubes.rod.material.E=52 GPa")
    assert code == 0 and out.startswith("10 rows") and "mean 0.1" in out


def test_other_columns(run, files, tmp_path):
    header = "tension.t0 [N],tension.t1 [N],tension.t2 [N],tip.x [mm],tip.y [mm],tip.z [mm],group"
    files[1].write_text(files[1].read_text().replace(header, "cell_0,c1,c2,px,py,pz,note"))
    mapping = tmp_path / "columns.yaml"
    mapping.write_text("tension.t0: cell_0 [N]\ntension.t1: cell_9 [N]\ntip.x: px [mm]\n")
    code, _, err = run("calibrate", *map(str, files), *FREE, "--columns", str(mapping))
    assert code == 2 and "no column 'cell_9'" in err
    names = {"tension.t0": "cell_0 [N]", "tension.t1": "c1 [N]", "tension.t2": "c2 [N]"}
    names |= {"tip.x": "px [mm]", "tip.y": "py [mm]", "tip.z": "pz [mm]", "group": "note"}
    mapping.write_text("\n".join(f"{quantity}: {column}" for quantity, column in names.items()))
    code, out, err = run("calibrate", *map(str, files), *FREE, "--columns", str(mapping))
    assert (code, err) == (0, "") and "tubes.rod.material.E" in out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--free", "tubes.rod.colour"), "nothing of the robot is called"),
        (("--free", "tubes.rod.E", "--bounds", "tubes.rod.E=40 GPa"), "expected PATH="),
        (("--free", "tubes.rod.E", "--bounds", "tubes.rod.E=40 N, 50 N"), "is a force"),
        (("--free", "tubes.rod.E", "--prior", "marker.z=1 mm, 2 mm"), "is not free"),
        (("--free", "tubes.rod.E", "--set", "marker.z"), "expected PATH=VALUE"),
        (("--free", "tubes.rod.E", "--set", "marker.q=1 mm"), "nothing of the robot"),
        (("--free", "tubes.rod.E", "--folds", "few"), "number of blocks"),
        (("--free", "tubes.rod.E", "--loss", "tukey"), "huber"),
        (("--free", "tubes.rod.E", "--save", "robot.txt"), "ending"),
        (("--free", "tubes.rod.E", "--columns", "none.yaml"), "no such file"),
    ],
)
def test_mistakes(run, files, words, told):
    code, out, err = run("calibrate", *map(str, files), *words)
    assert code == 2 and out == "" and told in err and "Traceback" not in err


def test_no_data(run, files):
    code, _, err = run("calibrate", str(files[0]), "none.csv", "--free", "tubes.rod.E")
    assert code == 2 and "no such file" in err


def test_backlash_and_compliance_from_files(run, tmp_path):
    """From a loop of one motor, made with other numbers; without --history the error says so."""
    truth = motor_robot(play=0.6e-3, compliance=3e-4)
    pulls = np.array([1.0, 3.0, 6.0, 5.8, 4.0, 1.5])
    tips = tactr.drive(truth, [{"displacement": {"pull": 1e-3 * pull}} for pull in pulls], stations=2).tips
    tips += np.random.default_rng(2).normal(0.0, 1e-4, tips.shape)
    rows = [
        ",".join(map(repr, map(float, (pull, *(1e3 * tip))))) for pull, tip in zip(pulls, tips, strict=True)
    ]
    data, start, saved = tmp_path / "loop.csv", tmp_path / "start.yaml", tmp_path / "found.yaml"
    data.write_text("\n".join(["displacement.pull [mm],tip.x [mm],tip.y [mm],tip.z [mm]", *rows]) + "\n")
    tactr.save(motor_robot(play=0.2e-3, compliance=2e-4), start)
    free = ("--free", "tendons.pull.play", "tendons.pull.compliance")
    code, out, err = run("calibrate", str(start), str(data), *free, "--history", "--save", str(saved))
    assert (code, err) == (0, "") and "6 rows, one path from rest" in out
    pull = tactr.load(saved).tendons[0]  # pyright: ignore[reportAttributeAccessIssue]
    assert pull.play == pytest.approx(0.6e-3, rel=0.1) and pull.compliance == pytest.approx(3e-4, rel=0.1)
    code, out, err = run("calibrate", str(start), str(data), *free)
    assert code == 2 and out == "" and "tendons.pull.play" in err and "--history" in err


def motor_robot(**fields) -> Robot:
    rod = Tube("rod", length=0.2, section=Rod(2e-3), material=Material(E=55e9, nu=0.3))
    return Robot([rod], [Tendon("pull", "rod", Straight(5e-3, 0.0), **fields)])
