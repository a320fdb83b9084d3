"""The paper's experiments, solved once, and their report, written once."""

import pytest

from tactr.reproduce import run


@pytest.fixture(scope="session")
def reproduction():
    return run()


@pytest.fixture(scope="session")
def report(reproduction, tmp_path_factory):
    """The text of report.html and of report.md."""
    folder = tmp_path_factory.mktemp("report") / "new"
    return tuple(path.read_text(encoding="utf-8") for path in reproduction.save(folder))
