"""Running the command line, in this process or in one of its own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import tactr
from tactr.cli import main

SOURCE = Path(tactr.__file__).parents[1]


@pytest.fixture
def run(capsys):
    """Runs `tactr WORDS...` here; returns (exit code, stdout, stderr)."""

    def run_(*words: str) -> tuple[int, str, str]:
        code = main(words)
        out, err = capsys.readouterr()
        return code, out, err

    return run_


@pytest.fixture(scope="session")
def start(tmp_path_factory):
    """Runs `python -m tactr.cli WORDS...` (or with other options of Python) in a process of its own."""
    # As an installed package has it: compiled once, whatever this process was told about bytecode.
    inherited = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    bytecode = str(tmp_path_factory.mktemp("bytecode"))

    def start_(*words: str, python: tuple[str, ...] = (), **options) -> subprocess.CompletedProcess[str]:
        path = os.pathsep.join([str(SOURCE), *filter(None, [os.environ.get("PYTHONPATH")])])
        return subprocess.run(
            [sys.executable, *python, "-m", "tactr.cli", *words],
            capture_output=True,
            text=True,
            timeout=120,
            env={**inherited, "PYTHONPYCACHEPREFIX": bytecode, "PYTHONPATH": path},
            **options,
        )

    return start_
