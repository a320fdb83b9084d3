"""Small studies that solve in a moment."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactr import examples
from tactr.studies import InsertionOrder, Range, Samples, Study, Values


@pytest.fixture(scope="session")
def tendon_study() -> Study:
    """Two tubes and two tendons: 2 designs at 60 samples each, 12 chunks."""
    return Study(
        examples.load("two_tube_90"),
        [
            Values("tubes.inner.material.E", [120e9, 215e9]),
            Range("tendons.outer.tension", 0.0, 4.0),
            Range("tendons.inner.tension", 0.0, 4.0),
            Range("tubes.inner.rotation", -3.0, 3.0),
        ],
        samples=Samples(60, seed=3),
        outputs=["tip", "stability", "jacobian", "compliance", "energy"],
        chunk=10,
        name="tendons",
    )


@pytest.fixture(scope="session")
def insertion_study() -> Study:
    """Three precurved tubes: rotations and insertions that fit together."""
    return Study(
        examples.load("three_tube_ctr"),
        [
            Range("tubes.middle.rotation", -np.pi, np.pi),
            Range("tubes.outer.translation", -0.19, -0.1),
            Range("tubes.middle.translation", -0.32, -0.11),
            Range("tubes.inner.translation", -0.45, -0.12),
        ],
        samples=Samples(200, method="random", seed=1),
        insertion=InsertionOrder(exposed=0.0, carriages=0.01),
        chunk=64,
    )


def files_of(folder: Path) -> dict[str, bytes]:
    """Every file below a folder."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}
