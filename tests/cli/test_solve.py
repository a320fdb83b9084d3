"""`tactr solve`: its report, its JSON, its files, and what it says when something is wrong."""

import json
import math

import numpy as np
import pytest
import xarray as xr

import tactr
from tactr import examples


def test_without_a_file_it_solves_two_tubes(run):
    code, out, err = run("solve")
    assert (code, err) == (0, "")
    assert out.startswith("two_tube_90: 2 tubes, 2 tendons, no loads")
    for words in (
        "position (mm)",
        "direction",
        "tension (N)",
        "converged in",
        "residual",
        "discretisation error",
        "stable, margin",
        "assumed",
    ):
        assert words in out
    tip = tactr.solve(examples.load("two_tube_90")).tip_position
    row = next(line for line in out.splitlines() if line.startswith("position"))
    assert [float(word) for word in row.split()[2:]] == pytest.approx(1e3 * tip, abs=5e-4)


def test_a_file(run, tmp_path):
    path = tmp_path / "robot.yaml"
    path.write_text(examples.path("helical").read_text())
    code, out, _ = run("solve", str(path))
    assert code == 0
    assert out.startswith("helical: 2 tubes, 1 tendon")


def test_it_says_what_only_a_history_tells(run, tmp_path):
    path = tmp_path / "robot.yaml"
    text = examples.path("helical").read_text()
    assert "without the" not in run("solve", "helical")[1]
    path.write_text(text.replace("    length:", "    translation_compliance: 0.01 mm/N\n    length:", 1))
    assert "without the give of 'outer', which tactr.drive follows" in run("solve", str(path))[1]


def solved(run, *words):
    code, out, err = run("solve", *words, "--json")
    assert (code, err) == (0, "")
    return json.loads(out)


def test_json(run):
    report = solved(run, "three_tube_c")
    shape = tactr.solve(examples.load("three_tube_c"))
    assert set(report) == {
        "robot",
        "converged",
        "status",
        "message",
        "residual",
        "iterations",
        "discretisation_error_m",
        "displacement_error_m",
        "solve_time_s",
        "stability",
        "tip",
        "tubes",
        "tendons",
        "slack",
        "transition_points",
        "centreline",
    }
    assert report["converged"] is True
    assert report["tip"]["position_m"] == shape.tip_position.tolist()
    assert report["tip"]["quaternion_wxyz"] == shape.tip_quaternion.tolist()
    assert report["centreline"]["position_m"] == shape.centreline.tolist()
    assert [tube["name"] for tube in report["tubes"]] == ["outer", "middle", "inner"]
    assert report["tubes"][2]["tip_position_m"] == pytest.approx(shape.tip_position, abs=1e-12)
    assert [point["s_m"] for point in report["transition_points"]] == pytest.approx([0.140, 0.187])
    assert report["transition_points"][0]["position_m"] == report["tubes"][0]["tip_position_m"]
    assert [tendon["tension_N"] for tendon in report["tendons"]] == [3.0, 2.0, 0.5]
    assert report["tendons"][0]["length_m"] == shape.tendons[0].length


def test_actuation(run):
    wanted = tactr.solve(
        examples.load("two_tube_90"),
        tension={"outer": 1.5, "inner": 0.5},
        rotation={"inner": np.pi / 2},
        translation={"inner": -0.02},
    )
    report = solved(
        run,
        "two_tube_90",
        "--tension",
        "outer=1.5",
        "inner=500 mN",
        "--rotation",
        "inner=90 deg",
        "--translation",
        "inner=-20 mm",
    )
    assert report["tip"]["position_m"] == pytest.approx(wanted.tip_position, abs=1e-12)


def test_actuation_in_order(run):
    named = solved(run, "two_tube_90", "--tension", "outer=1", "inner=2 N")
    assert solved(run, "--tension", "1", "2")["tip"] == named["tip"]
    assert solved(run, "--tension", "1", "--tension", "2")["tip"] == named["tip"]


def test_tolerance(run):
    assert solved(run, "helical", "--tolerance", "1 nm")["discretisation_error_m"] < 1e-9


def test_files(run, tmp_path):
    code, out, _ = run("solve", "--save", str(tmp_path / "a.nc"), "--plot", str(tmp_path / "a.png"))
    assert code == 0
    assert f"wrote {tmp_path / 'a.nc'}" in out
    assert f"wrote {tmp_path / 'a.png'}" in out
    assert xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf").attrs["status"] == "converged"
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nothing"], "neither a file nor a built-in example"),
        (["two_tubes_90"], "did you mean two_tube_90?"),
        (["missing.yaml"], "missing.yaml: no such file"),
        (
            ["--tension", "inne=2"],
            "no tendon 'inne'; expected one of 'outer', 'inner' (did you mean 'inner'?)",
        ),
        (["--tension", "inner=-2"], "-2 N"),
        (["--tension", "inner=2 mm"], '--tension: "2 mm" is a length; expected a force'),
        (["--tension", "inner=x"], "does not start with a number"),
        (["--tension", "1"], "1 values for 2 tendons"),
        (["--tension", "1", "inner=2"], "'1' has no name; expected name=value"),
        (["--tension", "inner=1", "inner=2"], "'inner' is given twice"),
        (["--tension", "inner=1", "two_tube_90"], "a FILE goes before the options"),
        (["--rotation", "inner=90"], '--rotation: "90" has no unit; expected an angle such as "30 deg"'),
        (["--translation", "inner=20 mm"], "tubes[1].translation"),
        (["--translation", "inner=-1 m"], "leaves nothing of 'inner' outside the guide"),
        (["--tolerance", "1"], '--tolerance: "1" has no unit'),
        (["--tolerance", "-1 um"], "tolerance"),
        (["--save", "a.csv"], "--save: a.csv has the ending '.csv'; expected one of .nc"),
        (["--plot", "a.txt"], "--plot: a.txt has the ending '.txt'"),
        (["--plot", "missing/a.png"], "--plot: there is no folder missing"),
        (["--colour"], "--colour"),
        (["--tension"], "--tension"),
    ],
)
def test_mistakes(run, words, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = run("solve", *words)
    assert (code, out) == (2, "")
    assert message in err
    assert err.startswith("tactr:")
    assert "Traceback" not in err


def test_no_equilibrium(run):
    code, out, err = run("solve", "till_straight", "--tension", "tendon=1e9")
    assert (code, out) == (2, "")
    assert "no equilibrium was found" in err
    assert "check its unit and size" in err


def test_no_equilibrium_as_json(run):
    code, out, err = run("solve", "till_straight", "--tension", "tendon=1e9", "--json")
    assert code == 2
    report = json.loads(out)
    assert report["converged"] is False
    assert "tip" not in report
    assert report["message"] in err


def test_no_equilibrium_writes_nothing(run, tmp_path):
    run("solve", "till_straight", "--tension", "tendon=1e9", "--save", str(tmp_path / "a.nc"))
    assert list(tmp_path.iterdir()) == []


def test_a_buckled_rod_near_its_limit_is_pointed_out(run, tmp_path):
    tube = tactr.Tube("rod", length=0.2, section=tactr.Rod(1e-3), material=tactr.Material(E=54e9, nu=0.3))
    euler = math.pi**2 * tube.stiffness.EI_x / (4 * 0.2**2)
    path = tmp_path / "rod.yaml"
    tactr.save(tactr.Robot([tube], loads=[tactr.PointLoad("rod", force=(0.0, 0.0, -0.9 * euler))]), path)
    code, out, _ = run("solve", str(path))
    assert code == 0 and "warning: stable, margin 0.00648: near the limit" in out
    stability = solved(run, str(path))["stability"]
    assert stability["stable"] is True and stability["conjugate_points_m"] == []
    assert stability["margin"] == pytest.approx(math.cos(math.pi / 2 * math.sqrt(0.9)) ** 2, rel=1e-3)
    assert "near the limit" in stability["warning"]
    assert solved(run, "three_tube_c")["stability"]["warning"] is None


def test_displacements(run):
    words = ("two_tube_90", "--displacement", "outer=2 mm", "inner=-1 mm")
    shape = tactr.solve(examples.load("two_tube_90"), displacement={"outer": 2e-3, "inner": -1e-3})
    report = solved(run, *words)
    assert report["slack"] == ["inner"]
    outer, inner = report["tendons"]
    assert (outer["given"], outer["displacement_m"], outer["slack"]) == ("displacement", 2e-3, False)
    assert outer["tension_N"] == pytest.approx(shape.tension[0])
    assert (inner["tension_N"], inner["slack"]) == (0.0, True)
    code, out, _ = run("solve", *words)
    assert code == 0
    rows = {line.split()[0]: line.split() for line in out.splitlines() if line}
    assert rows["inner"][2] == "slack" or "slack: inner" in out
    assert "displacements met" in out
    assert "displacement (mm)" in out


def test_displacements_that_cannot_be(run):
    code, out, err = run("solve", "two_tube_90", "--displacement", "outer=200 mm")
    assert (code, out) == (2, "")
    assert "displacement" in err
    code, out, err = run("solve", "two_tube_90", "--displacement", "outer=2 mm", "--tension", "outer=3")
    assert (code, out) == (2, "")
    assert "not both" in err
    code, out, err = run("solve", "two_tube_90", "--displacement", "outer=2")
    assert (code, out) == (2, "")
    assert "unit" in err


def test_forces_and_moments_at_tips(run):
    words = (
        "two_tube_90",
        "--force",
        "inner=0.1 N, 0, -0.05 N",
        "outer=0,0.02,0",
        "--moment",
        "inner=0, 5 N mm, 0",
    )
    robot = examples.load("two_tube_90")
    loads = [
        tactr.PointLoad("inner", force=(0.1, 0.0, -0.05), moment=(0.0, 5e-3, 0.0)),
        tactr.PointLoad("outer", force=(0.0, 0.02, 0.0)),
    ]
    expected = tactr.solve(robot, loads=loads).tip_position
    assert solved(run, *words)["tip"]["position_m"] == pytest.approx(list(expected), abs=1e-9)


@pytest.mark.parametrize(("word", "told"), [
    ("inner=0.1 N", "x, y, z"),
    ("0.1, 0, 0", "x, y, z"),
    ("inner=0.1 mm, 0, 0", "force"),
    ("middle=0.1, 0, 0", "middle"),
])  # fmt: skip
def test_a_force_that_cannot_be(run, word, told):
    code, out, err = run("solve", "two_tube_90", "--force", word)
    assert (code, out) == (2, "") and told in err
