"""`tactr reproduce`: its summary and files, and what it says when something is wrong."""

import importlib.util
import sys
import time

import pytest

import tactr
from tactr.cli import main
from tactr.reproduce import run as run_experiments

LONGEST = 20.0  # s


@pytest.fixture
def quick(monkeypatch, reproduction):
    """The experiments are solved already, and figures are empty."""
    monkeypatch.setattr("tactr.reproduce.run", lambda progress=None: reproduction)
    monkeypatch.setattr("tactr.reproduce.report.figure_of", lambda experiment: b"")


def test_the_whole_command(tmp_path, capsys, monkeypatch, reproduction):
    monkeypatch.chdir(tmp_path)
    begin = time.process_time()
    assert main(["reproduce"]) == 0
    assert time.process_time() - begin < LONGEST
    out, err = capsys.readouterr()
    assert err == ""
    assert sorted(path.name for path in (tmp_path / "reproduction").iterdir()) == ["report.html", "report.md"]
    for each in reproduction.experiments:
        assert each.title in out
    assert "11.36 mm is 3.93 % of the length: of 280 mm it is 4.06 %" in out
    assert "wrote reproduction/report.html" in out
    assert max(map(len, out.splitlines()[:12])) <= 140


@pytest.mark.parametrize("name", ["file", "file/below"])
def test_a_file_in_the_way(tmp_path, capsys, name):
    (tmp_path / "file").write_text("mine")
    assert main(["reproduce", "--out", str(tmp_path / name)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"tactr: --out: {tmp_path / name} ")
    assert "Traceback" not in err
    assert (tmp_path / "file").read_text() == "mine"


def test_a_report_that_cannot_be_written(tmp_path, capsys, quick):
    (tmp_path / "report.html").mkdir()
    assert main(["reproduce", "--out", str(tmp_path)]) == 2
    err = capsys.readouterr().err
    assert "report.html: cannot be written" in err


def test_without_matplotlib(tmp_path, capsys, monkeypatch):
    find = importlib.util.find_spec
    monkeypatch.setattr(
        "tactr.cli.reproduce.find_spec", lambda name: None if name == "matplotlib" else find(name)
    )
    assert main(["reproduce", "--out", str(tmp_path / "new")]) == 2
    assert "pip install 'tactr[plot]'" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_saving_without_matplotlib(tmp_path, monkeypatch, reproduction):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(tactr.MissingExtra, match=r"tactr\[plot\]"):
        reproduction.save(tmp_path / "new")
    assert list(tmp_path.iterdir()) == []


def test_a_bar_on_a_terminal(tmp_path, capsys, monkeypatch, quick):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert main(["reproduce", "--out", str(tmp_path)]) == 0
    err = capsys.readouterr().err
    assert "drawing" in err
    assert "left:" in err


def test_the_api():
    assert tactr.reproduce.run is run_experiments
    assert "reproduce" in dir(tactr)
