"""The building blocks of the robot file layout.

Each block reads one piece of plain data, reporting what is wrong with it, and describes itself as JSON
Schema; the layout is declared once, in layout.py. (A validation library was tried first: importing it and
building the models took 0.3 s of the 0.6 s in which a solve from a cold shell should be over.)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, Protocol

from tactr.io.document import DataPath, printable
from tactr.io.unit_table import BARE_KINDS, KINDS, UNITS, Kind, coefficient_kind
from tactr.io.units import UnitError, parse_quantity, show

Report = Callable[[DataPath, str, str], None]
"""Takes a problem: where it is, what was found, and what would be right."""

NUMBER_PATTERN = r"[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?"


class Block(Protocol):
    """A kind of value in a robot file."""

    def read(self, value: Any, path: DataPath, report: Report) -> Any:
        """The value as Python data in SI units; of no use where a problem went to `report`."""
        ...

    def schema(self) -> dict[str, Any]:
        """JSON Schema of the value."""
        ...


@dataclass(frozen=True, eq=False, repr=False)
class Text:
    """A text; options: the only texts allowed."""

    options: tuple[str, ...] = ()

    def read(self, value: Any, path: DataPath, report: Report) -> str:
        if self.options and value not in self.options:
            near = suggestion(value, self.options) if isinstance(value, str) else ""
            report(path, f"{show(value)} is not known{near}", "one of " + ", ".join(self.options))
        elif not isinstance(value, str):
            report(path, f"found {show(value)}", "a text")
        return value

    def schema(self) -> dict[str, Any]:
        return {"enum": list(self.options)} if self.options else {"type": "string"}


@dataclass(frozen=True, eq=False, repr=False)
class Quantity:
    """A number with a unit of one kind, or a bare zero; read as a float in SI units."""

    kind: Kind

    def read(self, value: Any, path: DataPath, report: Report) -> float:
        try:
            return parse_quantity(value, self.kind)
        except UnitError as error:
            report(path, error.found, error.expected)
            return 0.0

    def schema(self) -> dict[str, Any]:
        if self.kind.name in BARE_KINDS:
            return {"type": "number", "examples": [float(self.kind.example)]}
        simple = [unit for unit, (_, dimension) in UNITS.items() if dimension in self.kind.dimensions]
        written = self.kind.example.partition(" ")[2]
        unit = "|".join(sorted(simple, key=len, reverse=True)) if written in simple else r"[^ 0-9].*|1/.*"
        pattern = f"^ *{NUMBER_PATTERN} *({unit}) *$"
        text = {
            "type": "string",
            "pattern": pattern,
            "examples": [self.kind.example],
            "default": self.kind.example,
        }
        return {
            "anyOf": [text, {"const": 0}],
            "description": f"{self.kind.name}, such as {self.kind.example}",
        }


def quantity(name: str) -> Quantity:
    """The block of a quantity, by the name of its kind."""
    return Quantity(KINDS[name])


@dataclass(frozen=True, eq=False, repr=False)
class Items:
    """A list of values of one block; size: the exact number of them, if there is one."""

    item: Block
    size: int | None = None
    example: str = ""

    def read(self, value: Any, path: DataPath, report: Report) -> tuple[Any, ...]:
        right = "a list" if self.size is None else f"a list of {self.size}"
        right += f", such as {self.example}" if self.example else ""
        if not isinstance(value, list):
            report(path, f"found {show(value)}", right)
            return ()
        if self.size is not None and len(value) != self.size:
            report(path, f"found a list of {len(value)}", right)
        return tuple(self.item.read(entry, (*path, k), report) for k, entry in enumerate(value))

    def schema(self) -> dict[str, Any]:
        size = {} if self.size is None else {"minItems": self.size, "maxItems": self.size}
        return {"type": "array", "items": self.item.schema(), **size}


def vector(name: str) -> Items:
    """The block of three quantities (x, y, z)."""
    return Items(quantity(name), 3, f"[{KINDS[name].example}, 0, 0]")


@dataclass(frozen=True, eq=False, repr=False)
class Coefficients:
    """Coefficients of a polynomial in the arc length, ascending powers; base: the kind of its value."""

    base: str

    def read(self, value: Any, path: DataPath, report: Report) -> tuple[float, ...]:
        if not isinstance(value, list):
            report(path, f"found {show(value)}", "a list of coefficients, ascending powers of the arc length")
            return ()
        blocks = [Quantity(coefficient_kind(self.base, power)) for power in range(len(value))]
        return tuple(
            block.read(entry, (*path, k), report)
            for k, (block, entry) in enumerate(zip(blocks, value, strict=True))
        )

    def schema(self) -> dict[str, Any]:
        first = [Quantity(coefficient_kind(self.base, power)).schema() for power in range(3)]
        return {"type": "array", "prefixItems": first, "minItems": 1, "maxItems": 16}


def suggestion(word: str, known: tuple[str, ...] | list[str]) -> str:
    """' (did you mean length?)', or nothing where no known word is near."""
    by_case = {name.lower(): name for name in known}
    near = get_close_matches(printable(word).lower(), by_case, n=1, cutoff=0.6)
    return f" (did you mean {by_case[near[0]]}?)" if near else ""
