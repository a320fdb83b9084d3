"""The command line as a process: exit codes, no tracebacks, and a quick start."""

import subprocess
import sys
import time

import pytest

HEAVY = ("scipy", "matplotlib", "xarray", "pandas", "h5py", "pydantic", "rich", "hypothesis")


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\0",
        b"\xff\xfe",
        b"tubes: [",
        b"!!python/object/apply:os.system [id]",
        b"[" * 60_000,
        b"x: 140 mm\n",
        b"a" * 3_000_000,
    ],
)
def test_bad_files_give_exit_code_2_and_no_traceback(start, tmp_path, content):
    path = tmp_path / "robot.yaml"
    path.write_bytes(content)
    done = start("solve", str(path))
    assert done.returncode == 2
    assert done.stdout == ""
    assert str(path) in done.stderr
    assert "Traceback" not in done.stderr


def test_success_and_failure_codes(start):
    assert start("solve", "two_tube_0").returncode == 0
    failed = start("solve", "till_straight", "--tension", "1e9")
    assert failed.returncode == 2
    assert "Traceback" not in failed.stderr


def test_a_reader_that_stops_early(start):
    done = subprocess.run(
        f"{sys.executable} -m tactr.cli solve --json | head -1",
        shell=True,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.stderr == ""


def imported(start, *words):
    lines = start(*words, python=("-X", "importtime")).stderr.splitlines()
    return {line.rpartition("|")[2].strip() for line in lines if line.startswith("import time:")}


def test_help_imports_next_to_nothing(start):
    modules = imported(start, "--help")
    assert "tactr.cli.help_text" in modules
    assert not any(
        name.split(".")[0] in (*HEAVY, "numpy", "cyclopts", "ruamel", "dataclasses") for name in modules
    )


@pytest.mark.parametrize("words", [["solve"], ["check", "two_tube_90"], ["schema"]])
def test_commands_import_nothing_heavy(start, words):
    heavy = {name for name in imported(start, *words) if name.split(".")[0] in HEAVY}
    assert heavy == set()


def best_time(start, *words):
    times = []
    for _ in range(7):
        begin = time.perf_counter()
        assert start(*words).returncode == 0
        times.append(time.perf_counter() - begin)
    return min(times)


def test_help_is_there_at_once(start):
    assert best_time(start, "--help") < 0.3


def test_a_solve_from_a_cold_shell(start):
    assert best_time(start, "solve") < 0.6
