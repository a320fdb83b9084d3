"""`tactr sweep`: studies solved, stopped, gone on with and looked at; mistakes give exit code 2."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time

import pytest

from tactr import Sweep

STUDY = """\
name: pulls
robot: two_tube_90
vary:
  - {path: tendons.outer.tension, from: 0 N, to: 4 N}
  - {path: tendons.inner.tension, from: 0 N, to: 4 N, points: 3}
samples: {count: 40}
chunk: 30
"""


@pytest.fixture
def study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pulls.yaml").write_text(STUDY)
    return tmp_path


def test_solve_and_look(run, study):
    code, out, err = run("sweep", "pulls.yaml", "--threads", "1", "--plot", "x.png", "--colour", "z")
    assert (code, err) == (0, "")
    assert out.startswith("pulls: 120 configurations\n\nconverged: 100 %, 100 % of those stable\n")
    assert "solved 120 in" in out
    assert out.endswith("wrote pulls.zarr\nwrote x.png\n")
    assert Sweep(study / "pulls.zarr").complete
    code, again, _ = run("sweep", "pulls.yaml")
    assert code == 0
    assert "solved" not in again
    code, looked, _ = run("sweep", "pulls.zarr")
    assert looked == again
    code, text, _ = run("sweep", "pulls.zarr", "--json", "--voxel", "5 mm")
    assert json.loads(text)["reached"]["voxel"] == 0.005
    assert json.loads(text)["statuses"] == {"converged": 120}


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["pulls.yaml", "--threads", "0"], "threads: found 0; expected a whole number"),
        (["pulls.yaml", "--threads", "1", "--workers", "2"], "more than one of threads, workers, cluster"),
        (["pulls.yaml", "--out", "x.nc"], "does not end in .zarr"),
        (["pulls.yaml", "--voxel", "3"], "--voxel: \"3\" has no unit"),
        (["pulls.yaml", "--plot", "x.doc"], "--plot"),
        (["pulls.yaml", "--plot", "x.png", "--colour", "zz"], "has no 'zz'"),
        (["pulls.yaml", "--plot", "x.png", "--colour", "isotropy"], "which needs the output jacobian"),
        (["none.yaml"], "none.yaml: no such file"),
        (["."], "no store of a sweep"),
        ([], "requires"),
    ],
)  # fmt: skip
def test_mistakes(run, study, words, told):
    code, _, err = run("sweep", *words)
    assert code == 2
    assert told in err.replace("\n", " ")


def test_a_file_with_mistakes_names_the_lines(run, study):
    (study / "bad.yaml").write_text(STUDY.replace("4 N}", "4 mm}").replace("chunk", "chnk"))
    code, out, err = run("sweep", "bad.yaml")
    assert (code, out) == (2, "")
    assert "bad.yaml:7: chnk: is not a known key (did you mean chunk?)" in err


def test_the_schema(run):
    code, out, _ = run("schema", "study")
    assert code == 0
    assert json.loads(out)["title"] == "tactr study file"


def test_an_interrupt_leaves_what_was_done(start, study):
    (study / "long.yaml").write_text(STUDY.replace("count: 40", "count: 40000"))
    command = [sys.executable, "-m", "tactr.cli", "sweep", "long.yaml", "--threads", "1"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ,
        # where the tests run in the background of a shell, they hand on that interrupts are ignored
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as child:  # fmt: skip
        try:
            done = study / "long.zarr" / "status" / "c" / "1"
            for _ in range(3000):
                if done.exists() or child.poll() is not None:
                    break
                time.sleep(0.02)
            child.send_signal(signal.SIGINT)
            out, err = child.communicate(timeout=60)
        finally:
            child.kill()
    assert child.returncode == 130
    assert out == ""
    assert "of 120000 configurations are in long.zarr" in err
    assert "goes on from there" in err
    assert "Traceback" not in err
    assert (Sweep(study / "long.zarr").dataset.status.values >= 0).sum() >= 30
