"""Plain data to YAML: mappings and lists of mappings in blocks, other lists on one line.

Texts that could be read as anything else are quoted, with escapes for all that is not printable. (Emitters of
libraries were found to lose some control characters.)
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from typing import Any

WIDTH = 100
_KEY = re.compile(r"[A-Za-z_][A-Za-z0-9_.\[\]]*")
_QUANTITY = re.compile(r"-?[0-9][0-9.e-]* [A-Za-z1][A-Za-z0-9 /^]*")
_WORDS = re.compile(r"[A-Za-z][A-Za-z0-9_.+/^()-]*( [A-Za-z0-9_.+/^()-]+)*")
_PROSE = re.compile(r"\S+( \S+)*")
_PLAIN = re.compile(r"[A-Za-z][^\s:#]*( [^\s:#]+)*")
_CONSTANTS = {"null", "true", "false"}


def write_yaml(data: dict[str, Any]) -> str:
    """The YAML text of a robot file's data: mappings, lists, texts, numbers."""
    return "".join(f"{line}\n" for line in _mapping(data))


def _mapping(data: dict[str, Any]) -> Iterator[str]:
    for key, value in data.items():
        name = key if _KEY.fullmatch(key) and not _is_constant(key) else _quoted(key)
        head, lines = _block(value)
        yield f"{name}: {head}".rstrip()
        yield from ("  " + line for line in lines)


def _block(value: Any) -> tuple[str, list[str]]:
    """What stands after a key on its line, and the lines under it."""
    if isinstance(value, dict) and value:
        return "", list(_mapping(value))
    if isinstance(value, list) and _needs_lines(value):
        return "", [line for entry in value for line in _entry(entry)]
    if isinstance(value, str) and "\n" in value and all(map(_is_prose, value.split("\n"))):
        return "|-", value.split("\n")
    if isinstance(value, str) and len(value) > WIDTH and _is_prose(value):
        return ">-", textwrap.wrap(value, WIDTH, break_long_words=False, break_on_hyphens=False)
    if isinstance(value, str) and _PLAIN.fullmatch(value) and value.isprintable() and not _is_constant(value):
        return value, []
    return _inline(value), []


def _is_prose(line: str) -> bool:
    """Whether a line is words with single blanks between them, which YAML keeps as they are."""
    return line.isprintable() and _PROSE.fullmatch(line) is not None


def _is_constant(text: str) -> bool:
    return text.lower() in _CONSTANTS


def _needs_lines(value: list[Any]) -> bool:
    return any(
        isinstance(entry, dict) or (isinstance(entry, str) and len(entry) > WIDTH // 2) for entry in value
    )


def _entry(entry: Any) -> Iterator[str]:
    lines = _mapping(entry) if isinstance(entry, dict) and entry else iter([_inline(entry)])
    yield "- " + next(lines)
    yield from ("  " + line for line in lines)


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_quoted(key)}: {_inline(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if not isinstance(value, str):
        return repr(value)
    plain = _QUANTITY.fullmatch(value) or (_WORDS.fullmatch(value) and not _is_constant(value))
    return value if plain else _quoted(value)


def _quoted(text: str) -> str:
    return '"' + "".join(map(_escaped, text)) + '"'


def _escaped(character: str) -> str:
    if character in '"\\':
        return "\\" + character
    if character.isprintable() and ord(character) < 0x10000:
        return character
    return f"\\U{ord(character):08x}"
