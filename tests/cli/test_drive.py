"""The command `drive`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import tactr
from tactr import Annulus, Robot, Straight, Tendon, Tube, materials
from tactr.friction import DriveState

PULLS = [1.0, 5.0, 9.0, 5.0, 1.0]


def robot(**fields) -> Robot:
    tube = Tube("tube", length=0.2, section=Annulus(1.2e-3, 0.9e-3), material=materials.nitinol)
    return Robot([tube], [Tendon("pull", "tube", Straight(0, 3e-3), **{"friction": 0.15, **fields})])


@pytest.fixture
def file(tmp_path: Path) -> str:
    tactr.save(robot(), tmp_path / "robot.yaml")
    return str(tmp_path / "robot.yaml")


@pytest.fixture
def path(tmp_path: Path):
    def write(text: str) -> str:
        (tmp_path / "path.csv").write_text(text)
        return str(tmp_path / "path.csv")

    return write


def table(pulls) -> str:
    return (
        "\n".join(["# a loop", "tension.pull [N]; rotation.tube [deg]", *(f"{t}; 90" for t in pulls)]) + "\n"
    )


def test_a_loop_and_its_files(run, file, path, tmp_path):
    xarray = pytest.importorskip("xarray")
    saved, drawn = tmp_path / "out.nc", tmp_path / "loop.png"
    code, out, err = run("drive", file, path(table(PULLS)), "--save", str(saved), "--plot", str(drawn))
    assert (code, err) == (0, "")
    assert "5 points" in out and f"wrote {saved}" in out and drawn.stat().st_size > 10_000
    expected = tactr.drive(robot(), [{"tension": [t], "rotation": [np.pi / 2]} for t in PULLS])
    with xarray.open_dataset(saved, engine="h5netcdf") as data:
        np.testing.assert_allclose(data["tip_position"], expected.tips, atol=1e-9)
        np.testing.assert_allclose(data["centreline"][:, -1], expected.tips, atol=1e-9)
        assert data["given_tension"].values[:, 0].tolist() == PULLS and data["given_tension"].units == "N"
        along = data["tendon_tension"].sel(tendon="pull").values
        np.testing.assert_allclose(along[:, 0], PULLS, rtol=1e-6)
        assert (along[2, 1:] < along[2, :-1]).all()  # pulled: less and less towards the tip
        assert along[3, -1] > along[3, 0]  # let go: stuck behind
        state = DriveState.from_dict(json.loads(str(data["state"].values[-1])))
        np.testing.assert_allclose(
            state.tension("pull", [0.1]), expected.state.tension("pull", [0.1]), rtol=1e-6
        )


def test_a_state_goes_on(run, file, path, tmp_path):
    state, saved = str(tmp_path / "state.json"), tmp_path / "out.nc"
    assert run("drive", file, path(table(PULLS[:3])), "--save-state", state)[0] == 0
    assert run("drive", file, path(table(PULLS[3:])), "--state", state, "--save", str(saved))[0] == 0
    whole = tactr.drive(robot(), [{"tension": [t], "rotation": [np.pi / 2]} for t in PULLS])
    data = pytest.importorskip("xarray").open_dataset(saved, engine="h5netcdf")
    np.testing.assert_allclose(data["tip_position"], whole.tips[3:], atol=2e-6)
    data.close()


BAD = {
    "tension.pul [N]\n1\n": "path.csv:1: tension.pul: the robot has no tendon 'pul'; expected pull",
    "tension.pull\n1\n": 'path.csv:1: tension.pull: the column has no unit; expected "tension.pull [N]"',
    "tension.pull [mm]\n1\n": "path.csv:1: tension.pull: unit [mm]",
    "tension.pull [N]\n1\n-2\n": "path.csv:3: tension.pull: -2 N is too small; expected",
    "tension.pull [N]\n1\nx\n": "path.csv:3: tension.pull: 'x' is not a number; expected a number",
    "tension.pull [N], rotation.tube [deg]\n1, 2\n1,\n": "path.csv:3: rotation.tube: the cell is empty",
    "rotation.tube [deg]\ninf\n": "path.csv:2: rotation.tube: 'inf' is not finite",
    "translation.tube [mm]\n5\n": "path.csv:2: translation.tube: ",
    "force.pull [N]\n1\n": "path.csv:1: the column 'force.pull [N]' is not known; expected",
    "tension.pull [N], tension.pull [N]\n1, 1\n": "path.csv:1: tension.pull: there are two columns for it",
    "tension.pull [N], displacement.pull [mm]\n1, 1\n": "path.csv:1: displacement.pull: its tension has a",
    "tension.pull [N]\n": "path.csv: holds no rows",
}


@pytest.mark.parametrize("text", BAD)
def test_bad_paths_are_named(run, file, path, text):
    code, out, err = run("drive", file, path(text))
    assert (code, out) == (2, "")
    assert BAD[text] in err and len(err.splitlines()) == 1


def test_a_point_that_is_not_reached(run, file, path, tmp_path):
    """The points before it are written."""
    saved = tmp_path / "out.nc"
    code, out, err = run("drive", file, path("tension.pull [N]\n1\n2\n1e5\n1\n"), "--save", str(saved))
    assert code == 2
    assert "2 points" in out and "point 3 (line 4) of 4: " in err and "the 2 before it are kept" in err
    data = pytest.importorskip("xarray").open_dataset(saved, engine="h5netcdf")
    assert data["given_tension"].values[:, 0].tolist() == [1.0, 2.0]
    data.close()


@pytest.mark.parametrize("cuts", [1, 100])
def test_a_tendon_that_is_dragged_is_told(run, tmp_path, path, cuts):
    """However finely the path is cut."""
    opposite = [
        Tendon(name, "tube", Straight(0, y), friction=0.15) for name, y in (("up", 3e-3), ("down", -3e-3))
    ]
    tactr.save(robot().replace(tendons=tuple(opposite)), tmp_path / "two.yaml")
    rows = "".join(f"{up}, 1\n" for up in np.linspace(1.0, 4.0, cuts + 1))
    code, out, _ = run("drive", str(tmp_path / "two.yaml"), path("tension.up [N], tension.down [N]\n" + rows))
    (warning,) = [line for line in out.splitlines() if line.startswith("warning")]
    assert code == 0 and warning.startswith(
        "warning: tendon down is dragged through its channel by up to 1.6 mm"
    )


def test_files_that_cannot_be(run, file, path, tmp_path):
    good = path(table(PULLS[:1]))
    (tmp_path / "state.json").write_text('{"a": 1}')
    for words, found in (
        (("--save", "out.csv"), "--save: out.csv has the ending '.csv'; expected one of .nc"),
        (("--save-state", "a/b.json"), "--save-state: there is no folder a"),
        (("--state", file), "expected a file that --save-state wrote"),
        (("--state", str(tmp_path / "state.json")), "cannot be read: 'tendons'"),
        (("--state", "nowhere.json"), "nowhere.json: cannot be read: No such file"),
    ):
        code, _, err = run("drive", file, good, *words)
        assert code == 2 and found in err


def test_the_frictionless_model_beside_it():
    """Without friction and play both are the same; the play of a motor is the difference of two solves."""
    path = [{"displacement": [d]} for d in (1e-3, 3e-3, 2e-3)]
    same = tactr.drive(robot(friction=0.0), path)
    np.testing.assert_allclose(same.tips, same.frictionless_tips(), atol=2e-6)
    played = tactr.drive(robot(friction=0.0, play=0.4e-3), path)
    passed = (0.8e-3, 2.8e-3, 2.2e-3)
    solved = [tactr.solve(robot(friction=0.0), displacement=[d]).tip_position for d in passed]
    np.testing.assert_allclose(played.tips, solved, atol=2e-6)
    np.testing.assert_allclose(played.frictionless_tips(), same.tips, atol=2e-6)
