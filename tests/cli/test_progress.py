"""The bar of all commands that take long."""

from __future__ import annotations

import sys

from tactr.cli.progress import progress_bar


def test_no_bar_without_a_terminal(capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: False)
    with progress_bar("solving") as bar:
        assert bar is None
    assert capsys.readouterr() == ("", "")


def test_a_bar_says_what_is_done_and_is_wiped(capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "100")
    with progress_bar("reading", time_left=False) as bar:
        assert bar is not None
        bar(3, 12)
        bar(4, 12, "fold 2")
    out, err = capsys.readouterr()
    assert out == ""
    assert "fold 2" in err and "4/12" in err
    assert "left:" not in err
    assert err.endswith("\x1b[2K")  # the line is empty again
