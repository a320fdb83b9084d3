"""`tactr.reference.solve`: arguments, what comes back, failures; and the labels it cites."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from tactr import reference
from tactr.errors import NotConverged, RobotError
from tactr.robot import PointLoad, Robot, Rod, Straight, Tendon, Tube
from tactr.robot.material import Material

ROOT = Path(__file__).resolve().parents[2]
PAPER = ROOT.parent / "shared" / "paper" / "model.tex"


def bent(translation: float = 0.0) -> Robot:
    """Return one tube with one tendon."""
    tube = Tube(
        "tube", length=0.2, section=Rod(1e-3), material=Material(E=60e9, nu=0.3), translation=translation
    )
    return Robot(
        [tube],
        [Tendon("t", "tube", Straight(5e-3, 0.0), tension=1.0)],
        [PointLoad("tube", force=(0.1, 0, 0))],
    )


def test_translated_tube_is_refused() -> None:
    with pytest.raises(RobotError, match=r"tubes\[0\].translation"):
        reference.solve(bent(translation=-0.05))


@pytest.mark.parametrize("stations", [[0.1, 0.3], [-0.1], [[0.1]], []])
def test_stations_off_the_robot_are_refused(stations: list[float]) -> None:
    with pytest.raises(ValueError, match="arc lengths from 0 to"):
        reference.solve(bent(), stations=stations)


def test_stations_come_back_in_the_order_asked_for() -> None:
    some = reference.solve(bent(), stations=[0.15, 0.05, 0.15])
    every = reference.solve(bent(), stations=[0.0, 0.05, 0.15, 0.2])
    assert some.s == pytest.approx([0.15, 0.05, 0.15])
    assert some.centreline == pytest.approx(every.centreline[[2, 1, 2]], abs=1e-12)
    assert some.tubes[0].u == pytest.approx(every.tubes[0].u[[2, 1, 2]], abs=1e-9)
    assert some.tip == pytest.approx(every.centreline[3], abs=1e-12)
    assert some.u_base[0] == pytest.approx(every.tubes[0].u[0], abs=1e-12)


def test_base_strains_start_another_solve() -> None:
    first = reference.solve(bent())
    again = reference.solve(bent(), guess=(first.u_base, first.v_base))
    assert again.iterations == 0
    assert again.tip == pytest.approx(first.tip, abs=1e-12)


def test_bad_guess_falls_back_to_continuation() -> None:
    first = reference.solve(bent())
    u = np.full((1, 3), 900.0)
    again = reference.solve(bent(), guess=(u, first.v_base))
    assert again.tip == pytest.approx(first.tip, abs=1e-9)


def test_unreachable_tolerance_is_an_error_that_says_so() -> None:
    with pytest.raises(NotConverged, match=r"shooting did not converge \(residual .*guess="):
        reference.solve(bent(), tolerance=0.0)


def test_cited_labels_exist_in_the_paper() -> None:
    if not PAPER.exists():
        pytest.skip(f"no {PAPER}: the paper is not beside this repository")
    labels = set(re.findall(r"\\label\{(eq:\w+)\}", PAPER.read_text(encoding="utf-8")))
    source = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "src/tactr/reference").glob("*.py"))
    cited = set(re.findall(r"eq:\w+", source))
    assert cited - labels == set()
    matrices = {label for label in labels if re.fullmatch(r"eq:([GHJK]\w{1,5}|RHS\w+)", label)}
    assert matrices - cited == set()
