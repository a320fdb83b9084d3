"""The error of a robot file: every problem found, not only the first."""

from __future__ import annotations

import os
from collections.abc import Iterable

from tactr.errors import FileError
from tactr.io.document import Problem, field_name


class RobotFileError(FileError):
    """A robot file that cannot be used. `problems` lists a FileError for each thing wrong, in the order of
    the file; the other
    attributes are those of the first."""

    def __init__(self, problems: Iterable[FileError]) -> None:
        self.problems = tuple(sorted(problems, key=lambda problem: problem.line or 0))
        first = self.problems[0]
        super().__init__(
            first.problem,
            path=first.path,
            line=first.line,
            column=first.column,
            field=first.field,
            value=first.value,
            expected=first.expected,
        )

    def __str__(self) -> str:
        return "\n".join(str(problem) for problem in self.problems)


def file_error(problems: Iterable[Problem], path: str | os.PathLike[str] | None) -> RobotFileError:
    """The error to raise for these problems of the file at `path`."""
    return RobotFileError(
        FileError(
            problem.found,
            path=path,
            line=problem.line,
            field=field_name(problem.path),
            expected=problem.expected,
        )
        for problem in problems
    )
