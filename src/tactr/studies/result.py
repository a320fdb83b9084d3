"""The results of a sweep: its dataset, numbers made of it, summary, pictures."""

from __future__ import annotations

import json
import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tactr.errors import MissingExtra
from tactr.studies.store import DONE, read_attributes

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from tactr.robot import Robot
    from tactr.studies.summary import Summary


class Sweep:
    """The store of a sweep, opened to be read. (extra: sweep)

    path: where it is. dataset: an xarray Dataset over the files, which reads what is asked for; one row for
    each configuration, along "sample"; SI units. Raises FileError for what is no store of a sweep,
    MissingExtra.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self._attributes = read_attributes(self.path)
        self._study = json.loads(self._attributes["study"])

    @cached_property
    def dataset(self) -> xarray.Dataset:
        try:
            import xarray
        except ImportError:
            raise MissingExtra("xarray", "sweep", "a dataset of many configurations") from None
        return xarray.open_zarr(self.path, chunks=None)

    @property
    def count(self) -> int:
        """Number of configurations, solved or not."""
        return self.dataset.sizes["sample"]

    @property
    def complete(self) -> bool:
        """Whether all configurations were solved."""
        return bool((self.dataset[DONE].values == 1).all())

    @cached_property
    def robot(self) -> Robot:
        """The robot of the study."""
        from tactr.io import loads

        return loads(self._attributes["robot"])

    @cached_property
    def samples_each(self) -> int:
        """Samples at every combination of the study's Values."""
        samples = self._study["samples"]
        return 1 if samples is None else samples["count"]

    @cached_property
    def reach(self) -> dict[str, float]:
        """Largest less least value of all that varies, SI units, by path; not of what has one value."""
        ends = {
            axis["path"]: axis.get("values") or (axis["low"], axis["high"]) for axis in self._study["vary"]
        }
        return {path: max(values) - min(values) for path, values in ends.items() if max(values) > min(values)}

    @property
    def status_names(self) -> tuple[str, ...]:
        """What the numbers of ``dataset.status`` mean."""
        return tuple(self._attributes["status_names"])

    def quantity(self, name: str, rows: slice | np.ndarray = slice(None)) -> np.ndarray:
        """A number for each configuration, NaN where there is none: see ``tactr.studies.derived``."""
        from tactr.studies.derived import derived

        return derived(self, name, rows)

    def summary(self, *, voxel: float | None = None) -> Summary:
        """What the configurations say together. voxel: m, edge of those that count as reached; None: by the
        number of samples."""
        from tactr.studies.summary import summary_of

        return summary_of(self, voxel=voxel)

    def plot(self, path: str | os.PathLike[str] | None = None, *, colour: str = "z") -> Figure:
        """Projections, slices and histograms of the tips, coloured by any quantity; saved to path where
        given. (extra: plot)"""
        from tactr.plotting.sweep_plot import plot_sweep

        return plot_sweep(self, path, colour=colour)

    def __repr__(self) -> str:
        done = int((self.dataset["status"].values != -1).sum())
        robot = self.robot.name or "a robot"
        return f"<Sweep {str(self.path)!r}: {done} of {self.count} configurations of {robot}>"
