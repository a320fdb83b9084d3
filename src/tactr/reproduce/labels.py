"""Names beside the tips of curves, where they cover nothing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

AWAY = 11.0  # points from the tip
FINER = 5  # points of lines that are looked at, for each that is drawn
APART = 18.0  # pixels between a name and another tip
DIRECTIONS = np.radians(np.arange(0, 360, 45))


def name_tips(axes: Any, named: Sequence[tuple[str, np.ndarray]], lines: np.ndarray) -> None:
    """Write every name beside its point (2,), in data units, where it covers least: points of lines
    (k, 2), other names, other tips. The axes have their place and limits before."""
    axes.apply_aspect()
    between = np.linspace(0.0, len(lines) - 1.0, FINER * len(lines))
    finer = np.column_stack([np.interp(between, np.arange(len(lines)), lines[:, k]) for k in (0, 1)])
    covered = axes.transData.transform(finer)
    renderer = axes.figure.canvas.get_renderer()
    inside = axes.get_window_extent(renderer)
    tips = axes.transData.transform([point for _, point in named]) if named else np.empty((0, 2))
    taken: list[Any] = []
    for k, (name, point) in enumerate(named):
        others = np.delete(tips, k, axis=0)
        tried = [_written(axes, name, point, angle) for angle in DIRECTIONS]
        boxes = [text.get_window_extent(renderer) for text in tried]
        costs = [_cost(box, covered, others, taken, inside) for box in boxes]
        best = int(np.argmin(costs))
        for text in tried[:best] + tried[best + 1 :]:
            text.remove()
        taken.append(boxes[best])


def _written(axes: Any, name: str, point: np.ndarray, angle: float) -> Any:
    x, y = np.cos(angle), np.sin(angle)
    return axes.annotate(
        name, point, xytext=(AWAY * x, AWAY * y), textcoords="offset points", fontsize=10, zorder=99,
        ha="left" if x > 0.3 else "right" if x < -0.3 else "center",
        va="bottom" if y > 0.3 else "top" if y < -0.3 else "center", annotation_clip=False,
    )  # fmt: skip


def _cost(box: Any, covered: np.ndarray, others: np.ndarray, taken: Sequence[Any], inside: Any) -> float:
    """How bad a place is: lines under it, other tips beside it, names under it, outside the axes."""
    hidden, mistaken = _count(box, covered, 4.0), _count(box, others, APART)
    beyond = box.x0 < inside.x0 or box.x1 > inside.x1 or box.y0 < inside.y0 or box.y1 > inside.y1
    return hidden + 20.0 * mistaken + 100.0 * sum(map(box.overlaps, taken)) + (1.5 if beyond else 0.0)


def _count(box: Any, points: np.ndarray, around: float) -> float:
    """Points in a box made larger by `around` pixels."""
    low, high = np.array([box.x0, box.y0]) - around, np.array([box.x1, box.y1]) + around
    return float(((points > low) & (points < high)).all(axis=1).sum())
