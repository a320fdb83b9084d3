"""The chunks of a study solved in this process."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from typing import TYPE_CHECKING

from tactr.studies.solving import Arrays, solved

if TYPE_CHECKING:
    from tactr.studies.study import Study


def local_chunks(
    study: Study, chunks: Sequence[int], threads: int | None = None
) -> Generator[tuple[int, Arrays], None, None]:
    """Every chunk's number and arrays, in order."""
    for chunk in chunks:
        yield chunk, solved(study, *study.span(chunk), threads)
