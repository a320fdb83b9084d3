"""Mappings of the robot file layout: records with known keys, variants of them, and choices."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from tactr.io.document import DataPath
from tactr.io.fields import Block, Report, Text, suggestion
from tactr.io.units import show


@dataclass(frozen=True, eq=False, repr=False)
class Texts:
    """A mapping from texts to texts."""

    def read(self, value: Any, path: DataPath, report: Report) -> dict[str, str]:
        return {key: Text().read(entry, (*path, key), report) for key, entry in value.items()}

    def schema(self) -> dict[str, Any]:
        return {"type": "object", "additionalProperties": {"type": "string"}}


@dataclass(frozen=True, eq=False, repr=False)
class Either:
    """`mapping` where the value is a mapping, `other` where it is anything else."""

    mapping: Block
    other: Block

    def read(self, value: Any, path: DataPath, report: Report) -> Any:
        return (self.mapping if isinstance(value, dict) else self.other).read(value, path, report)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [self.other.schema(), self.mapping.schema()]}


@dataclass(frozen=True, eq=False, repr=False)
class Field:
    """One key of a mapping: its block, what it is, whether it has to be there."""

    block: Block
    doc: str
    required: bool = False


def given(*groups: str) -> tuple[frozenset[str], ...]:
    """Groups of keys for Record.one_of, each a text with blanks between the keys."""
    return tuple(frozenset(group.split()) for group in groups)


@dataclass(frozen=True, eq=False, repr=False)
class Record:
    """A mapping with known keys, read as a dict that holds the keys given.

    one_of: the groups of keys of which exactly one has to be given, whole; choice: these in words. kind: the
    value of the key `kind` where the record is one of several.
    """

    doc: str
    fields: Mapping[str, Field]
    one_of: tuple[frozenset[str], ...] = ()
    choice: str = field(default="", kw_only=True)
    kind: str = field(default="", kw_only=True)

    def read(self, value: Any, path: DataPath, report: Report) -> dict[str, Any]:
        if not isinstance(value, dict):
            report(path, f"found {show(value)}", f"a mapping with {_listed(self._keys())}")
            return {}
        read = {}
        for key, entry in value.items():
            if key in self.fields:
                read[key] = self.fields[key].block.read(entry, (*path, key), report)
            elif not (key == "kind" and self.kind):
                report(
                    (*path, key),
                    f"is not a known key{suggestion(key, self._keys())}",
                    f"one of {', '.join(self._keys())}",
                )
        for key, known in self.fields.items():
            if known.required and key not in value:
                report((*path, key), "is missing", known.doc)
        self._check_choice(set(value), path, report)
        return read

    def _keys(self) -> list[str]:
        return [*(["kind"] if self.kind else []), *self.fields]

    def _check_choice(self, given: set[str], path: DataPath, report: Report) -> None:
        if not self.one_of:
            return
        found = given & frozenset().union(*self.one_of)
        if found not in self.one_of:
            right = self.choice or ", or ".join(_listed(self._in_order(group)) for group in self.one_of)
            report(
                path, f"has {_listed(self._in_order(found)) or 'none of the keys needed'}", f"either {right}"
            )

    def _in_order(self, keys: frozenset[str] | set[str]) -> list[str]:
        return [key for key in self.fields if key in keys]

    def schema(self) -> dict[str, Any]:
        properties = {"kind": {"const": self.kind}} if self.kind else {}
        for key, known in self.fields.items():
            properties[key] = {**known.block.schema(), "description": known.doc}
        required = [
            *(["kind"] if self.kind else []),
            *(key for key, known in self.fields.items() if known.required),
        ]
        choice = {"oneOf": [self._group_schema(group) for group in self.one_of]} if self.one_of else {}
        return {
            "type": "object",
            "description": self.doc,
            "properties": properties,
            "required": required,
            "additionalProperties": False,
            **choice,
        }

    def _group_schema(self, group: frozenset[str]) -> dict[str, Any]:
        others = self._in_order(frozenset().union(*self.one_of) - group)
        absent = {"not": {"anyOf": [{"required": [key]} for key in others]}} if others else {}
        return {"required": self._in_order(group), **absent}


@dataclass(frozen=True, eq=False, repr=False)
class Variants:
    """One of several records, told apart by the key `kind`; called late, so that they may hold each other."""

    what: str
    records: Callable[[], tuple[Record, ...]]

    def read(self, value: Any, path: DataPath, report: Report) -> dict[str, Any]:
        known = {record.kind: record for record in self.records()}
        right = f"a kind of {self.what}: one of {', '.join(known)}"
        if not isinstance(value, dict):
            report(path, f"found {show(value)}", f"a mapping with the key kind: {right}")
            return {}
        kind = value.get("kind")
        if "kind" not in value:
            report((*path, "kind"), "is missing", right)
            return {}
        if not isinstance(kind, str) or kind not in known:
            near = suggestion(kind, tuple(known)) if isinstance(kind, str) else ""
            report((*path, "kind"), f"{show(kind)} is not known{near}", right)
            return {}
        return {"kind": kind, **known[kind].read(value, path, report)}

    def schema(self) -> dict[str, Any]:
        return {"$ref": f"#/$defs/{self.what}"}


def _listed(words: list[str]) -> str:
    return " and ".join(words) if len(words) < 3 else ", ".join(words[:-1]) + " and " + words[-1]
