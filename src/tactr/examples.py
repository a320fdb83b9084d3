"""The example robots that come with the library."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from tactr.errors import FileError

if TYPE_CHECKING:
    from tactr.robot import Robot


@cache
def _folder() -> Path:
    """Where the files are: inside an installed package, or in examples/robots of a source tree (an editable
    install)."""
    here = Path(__file__).resolve().parent
    installed = here / "example_files" / "robots"
    return installed if installed.is_dir() else here.parents[1] / "examples" / "robots"


@cache
def names() -> tuple[str, ...]:
    """The names of the examples, sorted."""
    return tuple(sorted(path.stem for path in _folder().glob("*.yaml")))


def path(name: str) -> Path:
    """The robot file of an example; FileError lists the names there are."""
    if name not in names():
        from difflib import get_close_matches

        near = get_close_matches(name.lower(), names(), n=1)
        hint = f" (did you mean {near[0]}?)" if near else ""
        raise FileError(f"there is no example {name!r}{hint}", expected=f"one of {', '.join(names())}")
    return _folder() / f"{name}.yaml"


def load(name: str) -> Robot:
    """The robot of an example; FileError lists the names there are."""
    from tactr.io import load as load_file

    return load_file(path(name))


def summary(name: str) -> str:
    """One line on an example: the comment on the first line of its file."""
    with path(name).open(encoding="utf-8") as file:
        return file.readline().lstrip("# ").rstrip()
