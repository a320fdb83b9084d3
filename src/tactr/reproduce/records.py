"""What comes out of a reproduced experiment: plain data, in SI units where not said otherwise."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from tactr.reproduce.printed import PrintedError

if TYPE_CHECKING:
    from tactr.robot import Robot
    from tactr.statics import Shape

Verdict = Literal["holds", "fitted", "does not hold", "cannot be checked"]
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)
View = Literal["space", "isometric", "top", "front", "side"]


def verdict(holds: bool) -> Verdict:
    """The verdict on a statement that could be checked."""
    return "holds" if holds else "does not hold"


@dataclass(frozen=True)
class Case:
    """One pose of an experiment: its label, the model's shape and the printed error."""

    label: str
    shape: Shape
    printed: PrintedError | None = None

    @property
    def robot(self) -> Robot:
        """The robot at this pose."""
        return self.shape.robot


@dataclass(frozen=True)
class Check:
    """A statement of the paper, and what the model or the printed numbers say of it.

    "fitted": it holds because a number that is not printed was chosen for it.
    """

    statement: str
    found: str
    verdict: Verdict


@dataclass(frozen=True)
class Fit:
    """One number that is not printed, chosen so that the model meets a printed one.

    what: in words. path: in the robot's description. start, value: before and after, SI. target, met: the
    printed number and the model's, m. span: values for the target less and plus `within`. used: whether the
    report's shapes use it, or it is only shown for comparison.
    """

    what: str
    path: str
    start: float
    value: float
    target: float
    met: float
    within: float
    span: tuple[float, float]
    used: bool


@dataclass(frozen=True)
class Move:
    """How far the tip moves in one pose, m: to first order by the exact derivative, and solved for the number
    less and plus its change; None where that is no robot, as where tubes do not fit in each other."""

    label: str
    first_order: float | None
    less: float | None
    more: float | None


@dataclass(frozen=True)
class Effect:
    """One assumption: its fields, why it was made, its value and change in words, and what the tip does."""

    what: str
    fields: tuple[str, ...]
    reason: str
    value: str
    change: str
    moves: tuple[Move, ...]

    @property
    def largest(self) -> float:
        """The farthest that the tip moves, m."""
        each = [(m.first_order, m.less, m.more) for m in self.moves]
        return max((length for lengths in each for length in lengths if length is not None), default=0.0)


@dataclass(frozen=True)
class Drawn:
    """A shape in a figure. faded: an earlier stage. colour_from: index of its first tube's colour. dashed:
    another reading. tendons: drawn too."""

    shape: Shape
    label: str = ""
    faded: bool = False
    colour_from: int = 0
    dashed: bool = False
    tendons: bool = False


@dataclass(frozen=True)
class Panel:
    """One view of some shapes."""

    title: str
    view: View
    drawn: tuple[Drawn, ...]


@dataclass(frozen=True, eq=False)
class Line:
    """A line of a graph. dashed, thin: how it is drawn."""

    label: str
    x: np.ndarray
    y: np.ndarray
    colour: str
    dashed: bool = False
    thin: bool = False


@dataclass(frozen=True)
class Graph:
    """Lines over an axis."""

    title: str
    x_label: str
    y_label: str
    lines: tuple[Line, ...]


@dataclass(frozen=True)
class Experiment:
    """One experiment of the paper, solved.

    key, title, setting (what the paper says of it); cases: poses in the paper's order; figure: rows of
    panels; caption; checks; fits; effects of assumptions; findings: remarks that a reader should not miss.
    """

    key: str
    title: str
    setting: str
    cases: tuple[Case, ...]
    figure: tuple[tuple[Panel | Graph, ...], ...]
    caption: str
    checks: tuple[Check, ...]
    effects: tuple[Effect, ...]
    fits: tuple[Fit, ...] = ()
    findings: tuple[str, ...] = ()
    replaced: dict[str, str] = field(default_factory=dict)  # fields whose value is fitted, and how
    printed: str = ""  # tip errors that are not printed pose by pose

    def __repr__(self) -> str:
        return f"<Experiment {self.key}: {len(self.cases)} poses, {len(self.checks)} checks>"

    def count(self, verdict: Verdict) -> int:
        """How many checks ended so."""
        return sum(check.verdict == verdict for check in self.checks)
