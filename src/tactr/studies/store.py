"""The store of a sweep: a Zarr group (format 3) with one array for each quantity, written chunk by chunk.

A chunk of the study is one file in every array, put there whole by a rename. Only when all are on the disk is
the chunk marked in ``chunk_done``, by a rename too: whatever a kill leaves half done is not marked, and is
done again. Nothing in the files depends on when, where or in which order chunks were done, so that a sweep
that was killed and resumed leaves the same bytes as one that was not.
"""

from __future__ import annotations

import os
import shutil
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.errors import FileError, MissingExtra
from tactr.studies.quantities import (
    NOT_DONE,
    QUANTITIES,
    SAMPLE,
    Quantity,
    array_name,
    input_quantity,
    labels,
)
from tactr.studies.versions import versions

if TYPE_CHECKING:
    from tactr.studies.solving import Arrays
    from tactr.studies.study import Study

DONE = "chunk_done"
FORMAT = 1
WHAT = "results of tactr sweep"
LABELS_OF = {"study": "study", "robot": "robot", "versions": "set of versions", "format": "format"}


class Store:
    """A store that is open for writing, by one process at a time; a context manager."""

    def __init__(self, path: Path, study: Study, group: Any) -> None:
        self.path, self._study = path, study
        self._lock = _locked(path)
        self._arrays = dict(group.arrays())
        self._done = self._arrays[DONE][:]
        for left in path.glob("*/**/*.partial"):  # of writes that were killed
            left.unlink()

    @property
    def missing(self) -> list[int]:
        """Chunks that are not done."""
        return np.flatnonzero(self._done == 0).tolist()

    def write(self, chunk: int, arrays: Arrays) -> None:
        """Put a chunk's arrays on the disk, then mark it."""
        start, stop = self._study.span(chunk)
        for name, values in arrays.items():
            self._arrays[name][start:stop] = values
        for name in arrays:
            _sync(self.path / name / "c" / str(chunk))
        self._done[chunk] = 1
        self._arrays[DONE][:] = self._done
        _sync(self.path / DONE / "c" / "0")

    def close(self) -> None:
        """Let others write."""
        os.close(self._lock)

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def import_zarr() -> Any:
    """The module. Raises MissingExtra."""
    try:
        import zarr
    except ImportError:
        raise MissingExtra("zarr", "sweep", "a store of many configurations") from None
    return zarr


def open_store(path: Path, study: Study, template: Any) -> Store:
    """The store at a path, made if there is none. template(): arrays of one configuration.

    Raises FileError for another study's store, or what is none, or one that is being written; MissingExtra.
    """
    zarr = import_zarr()
    if not path.exists():
        _create(zarr, path, study, template())
    group = _group(zarr, path)
    _check_same(path, dict(group.attrs), study)
    return Store(path, study, group)


def read_attributes(path: Path) -> dict[str, Any]:
    """Those of a store. Raises FileError for what is none."""
    return dict(_group(import_zarr(), path, "a folder that tactr sweep wrote").attrs)


def _group(zarr: Any, path: Path, expected: str = "another name for the results") -> Any:
    try:
        group = zarr.open_group(path, mode="r+", use_consolidated=False)
    except (OSError, ValueError):  # zarr's own errors are ValueErrors
        group = None
    if group is None or group.attrs.get("contents") != WHAT:
        raise FileError("is there, and is no store of a sweep", path=path, expected=expected)
    return group


def _check_same(path: Path, attributes: dict[str, Any], study: Study) -> None:
    pairs = {
        "study": study.text,
        "robot": study.robot_text,
        "versions": versions(),
        "format": FORMAT,
    }
    other = [LABELS_OF[name] for name, own in pairs.items() if attributes.get(name) != own]
    if other:
        raise FileError(
            f"holds the results of another {' and another '.join(other)} ({attributes.get('versions')})",
            path=path,
            expected="another name for the results, or the same study to go on with",
        )


def _create(zarr: Any, path: Path, study: Study, template: Arrays) -> None:
    """Built beside its place and moved there whole."""
    draft = path.with_name(f".{path.name}.new")
    shutil.rmtree(draft, ignore_errors=True)  # of a process that was killed here
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _fill(zarr.create_group(draft, zarr_format=3, attributes=_attributes(study)), study, template)
        with warnings.catch_warnings():  # format 3 does not speak of it yet; xarray opens faster with it
            warnings.simplefilter("ignore", UserWarning)
            zarr.consolidate_metadata(draft)
        draft.rename(path)
    except OSError as error:
        raise FileError(f"cannot be written: {error.strerror or error}", path=path) from None
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _fill(group: Any, study: Study, template: Arrays) -> None:
    known = {array_name(axis.path): input_quantity(study, axis.path) for axis in study.vary} | QUANTITIES
    used: set[str] = set()
    for name, values in template.items():
        _add(group, name, known[name], values, study)
        used |= set(known[name].dims)
    for dimension, names in labels(study).items():
        if dimension in used:
            array = group.create_array(
                dimension, shape=(len(names),), dtype=str, chunks=(len(names),), dimension_names=[dimension]
            )
            array[:] = np.array(names, dtype=object)
    group.create_array(
        DONE, shape=(study.chunks,), dtype="i1", chunks=(study.chunks,), fill_value=0,
        dimension_names=["chunk"],
        attributes={"long_name": "1: the configurations of this chunk are done"},
    )  # fmt: skip


def _add(group: Any, name: str, quantity: Quantity, values: np.ndarray, study: Study) -> None:
    rest = values.shape[1:]
    group.create_array(
        name,
        shape=(study.count, *rest),
        chunks=(study.chunk_size, *rest),
        dtype=values.dtype,
        fill_value=NOT_DONE if values.dtype == np.int8 else np.nan,
        dimension_names=[SAMPLE, *quantity.dims],
        attributes={"units": quantity.units, "long_name": quantity.text},
    )


def _attributes(study: Study) -> dict[str, Any]:
    from tactr.batch.result import NAMES

    return {
        "contents": WHAT,
        "format": FORMAT,
        "title": study.name or f"sweep of {study.robot.name or 'a robot'}",
        "study": study.text,
        "study_file": study.source,
        "robot": study.robot_text,
        "versions": versions(),
        "status_names": list(NAMES),
    }


def _locked(path: Path) -> int:
    """A descriptor that holds the store; a killed process lets go of it."""
    held = os.open(path, os.O_RDONLY)
    try:
        import fcntl

        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ImportError:  # a system without such locks
        pass
    except OSError:
        os.close(held)
        raise FileError("is being written by another sweep", path=path, expected="to wait for it") from None
    return held


def _sync(place: Path) -> None:
    """The one file at a place or below it, to the disk; there is none where all values are filling ones."""
    while place.is_dir():
        place = place / "0"
    if place.exists():
        with place.open("rb") as file:
            os.fsync(file.fileno())
