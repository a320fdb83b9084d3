"""What friction between tubes remembers: torques and angles where neighbours rub."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True, eq=False, repr=False)
class TubeContact:
    """Where one tube rubs in the next outer one, or the outermost in the guide, k places.

    inner: name; outer: name, None for the guide. s (k,) m; torque (k,) N m about d3, on the inner tube from
    the outer one; twist (k,) rad, the angle of the inner tube from the outer one at which the place holds;
    limit (k,) N m, the largest torque that friction bears there; slides (k,): 1 or -1 where the inner tube
    turned on the outer one in the last step, 0 where it held.
    """

    inner: str
    outer: str | None
    s: np.ndarray
    torque: np.ndarray
    twist: np.ndarray
    limit: np.ndarray
    slides: np.ndarray

    def __repr__(self) -> str:
        within = "the guide" if self.outer is None else repr(self.outer)
        return f"<TubeContact of {self.inner!r} in {within}: {len(self.s)} places>"


ARRAYS = ("s", "torque", "twist", "limit", "slides")


@dataclass(frozen=True, eq=False, repr=False)
class TubeFrictionState:
    """All places where tubes rub, and the translation (tubes,) in m at which they do."""

    contacts: tuple[TubeContact, ...]
    translation: np.ndarray

    def contact(self, inner: str) -> TubeContact:
        """The first contact of a tube with what is around it."""
        return next(contact for contact in self.contacts if contact.inner == inner)

    def to_dict(self) -> dict[str, Any]:
        """Plain lists and numbers, for JSON."""
        contacts = [
            {"inner": c.inner, "outer": c.outer} | {key: getattr(c, key).tolist() for key in ARRAYS}
            for c in self.contacts
        ]
        return {"contacts": contacts, "translation": self.translation.tolist()}

    @staticmethod
    def from_dict(data: dict[str, Any]) -> TubeFrictionState:
        """What ``to_dict`` wrote."""
        contacts = tuple(
            TubeContact(c["inner"], c["outer"], *(np.array(c[key], dtype=float) for key in ARRAYS))
            for c in data["contacts"]
        )
        return TubeFrictionState(contacts, np.array(data["translation"], dtype=float))

    def __repr__(self) -> str:
        places = sum(len(contact.s) for contact in self.contacts)
        return f"<TubeFrictionState: {len(self.contacts)} contacts, {places} places>"
