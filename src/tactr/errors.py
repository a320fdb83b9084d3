"""Errors of the library: each names the place, what was found, and what would be right."""

from __future__ import annotations

import os


class TactrError(Exception):
    """Base of every error that the library raises on purpose."""


class RobotError(TactrError, ValueError):
    """A robot description that cannot be right.

    ``field`` is the path of the offending field inside the object that was being built (``"length"``, or
    ``"tubes[1].outer_diameter"`` for a whole robot), ``value`` what was found, as given, ``expected`` what
    would be right, and ``owner`` the object by its own name (``"Tube 'outer'"``) when the path alone would
    not tell.
    """

    def __init__(
        self, field: str, problem: str, expected: str = "", *, value: object = None, owner: str = ""
    ) -> None:
        super().__init__(field, problem, expected)
        self.field = field
        self.problem = problem
        self.expected = expected
        self.value = value
        self.owner = owner

    def __str__(self) -> str:
        where = ": ".join(part for part in (self.owner, self.field) if part)
        text = f"{where}: {self.problem}" if where else self.problem
        return f"{text}; expected {self.expected}" if self.expected else text

    def under(self, prefix: str) -> RobotError:
        """The same error with ``prefix`` before the field: ``"length"`` under ``"tubes[1]"`` is
        ``"tubes[1].length"``. The owner is dropped, because the path now says it."""
        joint = "." if self.field and not self.field.startswith("[") else ""
        field = f"{prefix}{joint}{self.field}"
        return RobotError(field, self.problem, self.expected, value=self.value)


class FileError(TactrError):
    """A robot file that cannot be used: ``path``, ``line`` and ``column`` (from 1), ``field``, ``value``
    found, ``expected``. Parts that are not known are None or empty.
    """

    def __init__(
        self,
        problem: str,
        *,
        path: str | os.PathLike[str] | None = None,
        line: int | None = None,
        column: int | None = None,
        field: str = "",
        value: object = None,
        expected: str = "",
    ) -> None:
        super().__init__(problem)
        self.problem = problem
        self.path = path
        self.line = line
        self.column = column
        self.field = field
        self.value = value
        self.expected = expected

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.path, self.line, self.column) if part is not None)
        text = ": ".join(part for part in (place, self.field, self.problem) if part)
        return f"{text}; expected {self.expected}" if self.expected else text


class NotConverged(TactrError, RuntimeError):
    """The shape was asked for, but the solve did not converge. ``shape`` is the result, if there is one."""

    def __init__(self, message: str, *, shape: object = None) -> None:
        super().__init__(message)
        self.shape = shape


class MissingExtra(TactrError, ImportError):
    """An optional package is not installed: ``extra`` is the pip extra that brings ``module``."""

    def __init__(self, module: str, extra: str, purpose: str = "this") -> None:
        super().__init__(module, extra, purpose)
        self.module = module
        self.extra = extra
        self.purpose = purpose

    def __str__(self) -> str:
        return (
            f"{self.purpose} needs {self.module}, which is not installed: pip install 'tactr[{self.extra}]'"
        )
