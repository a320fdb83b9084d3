"""What ``tactr.drive`` returns."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tactr.friction.state import DriveState
from tactr.statics.shape import Shape

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False, eq=False)
class Driven:
    """Shapes along a path of actuation, k points, with what the robot remembers after each.

    shapes, states: k, made when they are looked at; failed: k texts, empty where the shape converged;
    steps: k, into how many the way to each point was cut; heat (k, tendons): J that friction took from
    one point to the next, from its force and the slip along each tendon; creep (k, tendons): m, how far
    at most, on the way to each point, a tendon had been dragged from where it last slid itself, at any
    place, counted from the first point of the drive (see docs/friction.md); tube_heat (k, tubes): J that
    friction of every tube in the next outer body took, from its torque and the slip; held (k,): in how many
    directions of falling energy tubes that do not slide on each other hold the robot.
    Iterates over its shapes.
    """

    shapes: Sequence[Shape]
    states: Sequence[DriveState]
    failed: tuple[str, ...]
    steps: tuple[int, ...]
    heat: np.ndarray
    creep: np.ndarray
    tube_heat: np.ndarray
    held: np.ndarray

    def stable(self, k: int) -> bool:
        """Whether shape k is stable as long as no place where tubes hold each other gives way. Its own
        ``stability`` is that at the friction torques as they are, which any push may overcome."""
        return len(self.shapes[k].stability.conjugate_points) <= int(self.held[k])

    @property
    def state(self) -> DriveState:
        """After the last point: what ``drive`` goes on from."""
        return self.states[-1]

    @property
    def converged(self) -> bool:
        """Whether all points are."""
        return not any(self.failed)

    @property
    def message(self) -> str:
        """What went wrong first, or that nothing did."""
        bad = [f"point {k}: {text}" for k, text in enumerate(self.failed) if text]
        return bad[0] if bad else f"converged at all {len(self.shapes)} points"

    @property
    def tips(self) -> np.ndarray:
        """Position of the distal end, (k, 3), m, world axes; NaN where there is no shape."""
        return np.array(
            [shape.tip_position if shape.converged else np.full(3, np.nan) for shape in self.shapes]
        )

    @property
    def tensions(self) -> np.ndarray:
        """At the motors, (k, tendons), N; NaN where there is no shape."""
        count = len(self.shapes[0].robot.tendons)
        rows = [shape.tension if shape.converged else np.full(count, np.nan) for shape in self.shapes]
        return np.array(rows).reshape(len(rows), count)

    @property
    def lengths(self) -> np.ndarray:
        """Of the tendons in the robot, (k, tendons), m."""
        return np.array([shape._solution.tendon_length for shape in self.shapes]).reshape(
            len(self.shapes), -1
        )

    def before(self, k: int) -> Driven:
        """The first k points, at least one."""
        return Driven(*(getattr(self, field.name)[:k] for field in fields(self)))

    def frictionless_tips(self) -> np.ndarray:
        """Position of the distal end for the same actuation without friction and backlash, (k, 3), m."""
        return self._frictionless.copy()

    @cached_property
    def _frictionless(self) -> np.ndarray:
        from tactr.friction.plain import without_friction

        none = np.full(3, np.nan)
        shapes = without_friction(self.shapes[0].robot, self.states)
        return np.array([s.tip_position if s is not None and s.converged else none for s in shapes])

    def to_xarray(self) -> xarray.Dataset:
        """Tips, shapes, tensions and states with units (extra: netcdf)."""
        from tactr.io.results_driven import driven_to_xarray

        return driven_to_xarray(self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write ``to_xarray`` to a netCDF-4 file (extra: netcdf). Raises FileError."""
        from tactr.io.results_driven import save_driven

        save_driven(self, path)

    def plot(self, path: str | os.PathLike[str] | None = None) -> Figure:
        """The loop and what friction changes, as a Figure; saved to path where given (extra: plot)."""
        from tactr.plotting.driven_plot import plot_driven

        return plot_driven(self, path)

    def __len__(self) -> int:
        return len(self.shapes)

    def __iter__(self) -> Iterator[Shape]:
        return iter(self.shapes)

    def __getitem__(self, k: int) -> Shape:
        return self.shapes[k]

    def __repr__(self) -> str:
        good = sum(not text for text in self.failed)
        return f"<Driven: {good} of {len(self.shapes)} points converged, {sum(self.steps)} steps>"
