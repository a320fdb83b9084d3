"""The example programs and what the README shows: they run, and end in these numbers."""

import re
import runpy
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

import tactr
from tactr.io import loads

ROOT = Path(__file__).parents[2]


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)


def test_two_tubes():
    assert runpy.run_path(str(ROOT / "examples" / "two_tubes.py"))["tip"] == pytest.approx(
        [0.0707613007, 0.0769605377, 0.1286467063], abs=1e-7
    )


def test_load_and_save():
    result = runpy.run_path(str(ROOT / "examples" / "load_and_save.py"))
    assert result["largest_curvature"] == pytest.approx(4.04627, abs=1e-4)


def test_hysteresis(capsys):
    """Width of the loop at 5 N and its heat, from the closed form of tests/friction/test_bending.py."""
    result = runpy.run_path(str(ROOT / "examples" / "hysteresis.py"))
    stiffness = result["robot"].tubes[0].stiffness
    sigma = np.linspace(0.0, 0.2, 2001)
    slope = 0.15 * 3e-3 / stiffness.EI_x * sigma
    held = np.minimum(1 / (1 / 5 - slope), 1 / (1 / 9 + slope))
    again = np.maximum(1 / (1 / 5 + slope), 1 / (1 / 1 - slope))

    def reach(tension):
        angle = cumulative_simpson(tension * 3e-3 / stiffness.EI_x, x=sigma, initial=0.0)
        return cumulative_simpson((1 - tension / stiffness.EA) * np.sin(angle), x=sigma)[-1]

    assert result["width"] == pytest.approx(reach(held) - reach(again), abs=1e-6)
    assert result["held"] == pytest.approx(held[[0, 1000, 2000]], rel=1e-6)


def test_tube_friction():
    """Lag of a straight tube in a curved one: at the end its moment M = EI kappa is borne by forces
    M / lever, with that of four radii a torque of mu M / 2, which winds up both tubes."""
    result = runpy.run_path(str(ROOT / "examples" / "tube_friction.py"))
    outer, inner = (tube.stiffness for tube in result["robot"].tubes)
    moment = inner.EI_x * 8.0 * outer.EI_x / (outer.EI_x + inner.EI_x)
    lag = 0.5 * 0.15 * moment * 0.15 * (1.0 / inner.GJ + 1.0 / outer.GJ)
    assert [result["lag"], result["back"]] == pytest.approx([lag, lag], rel=0.05)


def test_sweep_insertions():
    result = runpy.run_path(str(ROOT / "examples" / "sweep_insertions.py"))
    assert result["summary"].converged == result["summary"].stable == 1.0
    assert result["reached"].volume == pytest.approx(2.43e-3, rel=0.05)
    assert result["highest"] == pytest.approx(0.325, abs=0.01)


def test_the_python_of_the_sweeps_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / "sweep.md").read_text()
    code = re.findall(r"```python\n(.*?)```", text, re.DOTALL)[0].replace("10_000", "50")
    names: dict[str, object] = {}
    exec(code, names)
    results = names["results"]
    assert isinstance(results, tactr.Sweep)
    assert results.count == 100


def test_the_study_file_of_the_sweeps_page(tmp_path):
    (text,) = re.findall(r"```yaml\n(.*?)```", (ROOT / "docs" / "sweep.md").read_text(), re.DOTALL)
    (tmp_path / "study.yaml").write_text(text)
    assert tactr.load_study(tmp_path / "study.yaml").count == 80_000


def test_batch():
    result = runpy.run_path(str(ROOT / "examples" / "batch.py"))
    assert result["reach"] == pytest.approx([0.08691377, 0.08302846, 0.05715621], abs=1e-6)
    assert (result["softness"][1:] < result["softness"][:-1]).all()


def test_the_python_of_the_readme(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    code, questions = blocks("python")
    assert len(code.strip().splitlines()) <= 11
    names: dict[str, object] = {}
    exec(code, names)
    shape = names["shape"]
    assert isinstance(shape, tactr.Shape)
    for line in questions.strip().splitlines():
        eval(line, names)
    assert shape.tip_position[0] > 0.02
    assert str(shape.tip_position) in capsys.readouterr().out
    assert (tmp_path / "shape.png").exists()


def test_the_robot_file_of_the_readme():
    (text,) = blocks("yaml")
    assert tactr.solve(loads(text)).converged


def test_the_commands_of_the_readme_exist():
    text = (ROOT / "README.md").read_text()
    targets = set(re.findall(r"^make (\w+)", text, re.MULTILINE))
    makefile = (ROOT / "Makefile").read_text()
    assert targets == {"demo", "test"}
    assert all(re.search(rf"^{target}:", makefile, re.MULTILINE) for target in targets)
    assert {"solve", "calibrate", "check", "examples", "schema"} <= set(
        re.findall(r"^tactr (\w+)", text, re.MULTILINE)
    )
