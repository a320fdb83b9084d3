"""The example programs and what the README shows: they run, and end in these numbers."""

import re
import runpy
from pathlib import Path

import pytest

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
