"""Quantities written with their unit, such as "140 mm", "65 GPa" or "0.5 deg/mm".

A value is converted by exact rational arithmetic and rounded once, so that reading "140 mm" gives the double
closest to 0.14 m, and what `format_quantity` writes reads back as the very same double.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache

from tactr.io.document import printable
from tactr.io.unit_table import BARE_KINDS, KINDS, UNITS, Dimension, Kind, kind_name

_NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(.*?)\s*")
_FACTOR = re.compile(r"([A-Za-zµμ°]+|1)(?:\^?(-?\d{1,2}))?")
_SUPERSCRIPTS = str.maketrans({"²": "^2", "³": "^3", "·": " ", "*": " ", "⁴": "^4"})
_LONGEST = 64
_LARGEST_EXPONENT = 400


class UnitError(ValueError):
    """A text that is not the quantity asked for: `found` says what it is, `expected` what would be right."""

    def __init__(self, found: str, expected: str) -> None:
        super().__init__(f"{found}; expected {expected}")
        self.found = found
        self.expected = expected


@dataclass(frozen=True)
class _Unit:
    factor: Fraction
    dimension: Dimension


def kind(name: str) -> Kind:
    """The kind of quantity called `name`, for example "length" or "curvature"."""
    return KINDS[name]


def expected(wanted: Kind) -> str:
    """What a field of this kind should hold, with an example: 'a length such as "140 mm"'."""
    article = "an" if wanted.name[0] in "aeiou" else "a"
    return f'{article} {wanted.name} such as "{wanted.example}"'


def parse_quantity(value: object, wanted: Kind, *, bare: str | None = None) -> float:
    """Read one quantity and return it in SI units.

    value: text with a unit; zero needs none, and neither does any number of a dimensionless kind. bare: the
    unit a number without one is taken to have (None: that is an error). Raises UnitError.
    """
    number, unit_text = _split(value, wanted)
    if not unit_text:
        if number == 0 or wanted.name in BARE_KINDS:
            return float(number)
        if bare is None:
            raise UnitError(f"{show(value)} has no unit", f"{expected(wanted)}{_with_unit(value, wanted)}")
        unit_text = bare
    try:
        unit = _parse_unit(unit_text)
    except UnitError as error:
        raise UnitError(f"{show(value)}: {error.found}", expected(wanted)) from None
    if unit.dimension not in wanted.dimensions:
        raise UnitError(f"{show(value)} is {kind_name(unit.dimension)}", expected(wanted))
    return _to_float(number * unit.factor, value, wanted)


def format_quantity(value: float, wanted: Kind) -> str:
    """Write `value` (SI) with a unit so that `parse_quantity` gives back exactly the same double."""
    first, *others = [text for unit in wanted.units if (text := _in_unit(value, unit, wanted)) is not None]
    shortest = min([first, *others], key=len)
    return first if len(first) <= len(shortest) + 3 else shortest


def format_number(value: float) -> str:
    """The shortest decimal text of a double, without an exponent where that is readable."""
    return _plain(Decimal(repr(value)))


def _split(value: object, wanted: Kind) -> tuple[Fraction, str]:
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise UnitError(f"found {show(value)}", expected(wanted))
    if isinstance(value, float) and not math.isfinite(value):
        raise UnitError(f"{value} is not a finite number", expected(wanted))
    text = value if isinstance(value, str) else repr(value)
    if len(text) > _LONGEST:
        raise UnitError(f"{show(value)} is too long for a quantity", expected(wanted))
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise UnitError(f"{show(value)} does not start with a number", expected(wanted))
    exponent = re.search(r"[eE]([-+]?\d+)$", match[1])
    if exponent is not None and abs(int(exponent[1])) > _LARGEST_EXPONENT:
        raise UnitError(f"{show(value)} is out of range", expected(wanted))
    return Fraction(match[1]), match[2]


@lru_cache(maxsize=256)
def _parse_unit(text: str) -> _Unit:
    """Units joined by blanks or "*", each "/" dividing by the one factor that follows it: "N mm^2", "kg/m^3",
    "1/m"."""
    factor, dimension, sign = Fraction(1), (0, 0, 0, 0), 1
    for token in re.findall(r"/|[^\s/]+", text.translate(_SUPERSCRIPTS)):
        if token == "/":
            sign = -1
            continue
        match = _FACTOR.fullmatch(token)
        if match is None or (match[1] != "1" and match[1] not in UNITS):
            raise UnitError(f"unknown unit {printable(token)!r}{_suggestion(token)}", "")
        power = sign * int(match[2] or 1)
        if match[1] != "1":
            scale, base = UNITS[match[1]]
            factor *= scale**power
            dimension = tuple(d + power * b for d, b in zip(dimension, base, strict=True))
        sign = 1
    return _Unit(factor, dimension)  # pyright: ignore[reportArgumentType]


def _suggestion(token: str) -> str:
    from difflib import get_close_matches

    by_case = [name for name in UNITS if name.lower() == token.lower()]
    near = by_case or get_close_matches(token, UNITS, n=1)
    return f" (did you mean {near[0]!r}?)" if near else ""


def _with_unit(value: object, wanted: Kind) -> str:
    unit = _QUANTITY.fullmatch(wanted.example)
    return f' (perhaps "{str(value).strip()} {unit[2]}")' if unit else ""


def _to_float(exact: Fraction, value: object, wanted: Kind) -> float:
    try:
        result = float(exact)
    except OverflowError:
        raise UnitError(f"{show(value)} is out of range", expected(wanted)) from None
    if result == 0 and exact != 0:
        raise UnitError(f"{show(value)} is out of range", expected(wanted))
    return result


def _in_unit(value: float, unit_text: str, wanted: Kind) -> str | None:
    factor = _parse_unit(unit_text).factor if unit_text else Fraction(1)
    power = _power_of_ten(factor)
    if power is not None:
        numbers = [_plain(Decimal(repr(value)).scaleb(-power))]
    else:
        quotient = float(Fraction(value) / factor)
        numbers = [format_number(float(f"{quotient:.{digits}g}")) for digits in (6, 12, 15, 16, 17)]
    for number in numbers:
        text = f"{number} {unit_text}".rstrip()
        if parse_quantity(text, wanted) == value:
            return text
    return None


def _power_of_ten(factor: Fraction) -> int | None:
    digits = str(factor.numerator * factor.denominator)
    if digits.strip("0") != "1":
        return None
    return (len(digits) - 1) * (1 if factor.denominator == 1 else -1)


def _plain(number: Decimal) -> str:
    if number == 0:
        return "0"
    digits = number.normalize()
    return f"{digits:f}" if -5 <= digits.adjusted() <= 9 else f"{digits:e}".replace("e+", "e")


def show(value: object) -> str:
    """A value from a file, as an error message names it."""
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list):
        return "a list"
    if value is None:
        return "nothing"
    return f'"{printable(value)}"' if isinstance(value, str) else str(value)
