"""The whole robot: tubes, tendons and loads that fit together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, fields, replace
from typing import Any

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._consistency import check_robot
from tactr.robot.load import LOADS, Load
from tactr.robot.tendon import Tendon, TensionProfile, both_given, plain_displacement, plain_tension
from tactr.robot.tube import Tube, plain_rotation, plain_translation

MOST_TUBES = 8

Numbers = Mapping[str, float] | Sequence[float] | np.ndarray
Displacements = Mapping[str, float | None] | Sequence[float | None] | np.ndarray
Tensions = Mapping[str, float | TensionProfile] | Sequence[float | TensionProfile] | np.ndarray


@dataclass(frozen=True, repr=False)
class Robot:
    """A tendon-actuated concentric tube robot: plain data, checked when it is built, never changed.

    tubes: 1 to 8, outermost first. tendons, loads: any number. name, description: texts. assumed: what was
    assumed because the source does not give it, one text each. World frame: z along the guide, which the
    robot leaves at s = 0. Raises RobotError whose field reads like "tubes[1].outer_diameter".
    """

    tubes: Sequence[Tube]
    tendons: Sequence[Tendon] = ()
    loads: Sequence[Load] = ()
    _: KW_ONLY
    name: str = ""
    description: str = ""
    assumed: Sequence[str] = ()

    def __post_init__(self) -> None:
        name = check.name("name", self.name, empty=True)
        with check.owned(f"Robot {name!r}" if name else ""):
            check.store(
                self,
                tubes=check.instances("tubes", self.tubes, Tube, "Tube objects"),
                tendons=check.instances("tendons", self.tendons, Tendon, "Tendon objects"),
                loads=check.instances(
                    "loads", self.loads, LOADS, "PointLoad, DistributedLoad or Gravity objects"
                ),
                assumed=check.instances("assumed", self.assumed, str, "texts"),
            )
            if not isinstance(self.description, str):
                raise RobotError(
                    "description",
                    f"{check.show(self.description)} is not a text",
                    "a text",
                    value=self.description,
                )
            if not 1 <= len(self.tubes) <= MOST_TUBES:
                raise RobotError(
                    "tubes",
                    f"{len(self.tubes)} tubes were given",
                    f"1 to {MOST_TUBES} tubes",
                    value=len(self.tubes),
                )
            check_robot(self.tubes, self.tendons, self.loads)

    def __repr__(self) -> str:
        tubes = ", ".join(f"{tube.name} {tube.length * 1e3:.4g} mm" for tube in self.tubes)
        tendons = ", ".join(f"{tendon.name} {_show_tension(tendon)}" for tendon in self.tendons)
        parts = [f"{_count(self.tubes, 'tube')}: {tubes}"]
        if self.tendons:
            parts.append(f"{_count(self.tendons, 'tendon')}: {tendons}")
        if self.loads:
            parts.append(_count(self.loads, "load"))
        return f"<Robot{f' {self.name!r}' if self.name else ''}; {'; '.join(parts)}>"

    def tube(self, name: str) -> Tube:
        """The tube called ``name``; RobotError lists the names there are."""
        return self.tubes[_index("tube", "tube", name, self.tubes)]

    def tendon(self, name: str) -> Tendon:
        """The tendon called ``name``; RobotError lists the names there are."""
        return self.tendons[_index("tendon", "tendon", name, self.tendons)]

    def replace(self, **changes: Any) -> Robot:
        """A robot with these fields changed, checked again; RobotError lists the fields there are."""
        for field in changes:
            if field not in _FIELDS:
                raise RobotError(field, "a robot has no such field", check.near(field, _FIELDS))
        return replace(self, **changes)

    def with_actuation(
        self,
        *,
        tension: Tensions | None = None,
        rotation: Numbers | None = None,
        translation: Numbers | None = None,
        displacement: Displacements | None = None,
    ) -> Robot:
        """A robot with other tensions (N) or displacements (m) of its tendons, or other rotations (rad) or
        translations (m) of its tubes.

        Each is a mapping from names to values, which leaves the others as they are, or a sequence of one
        value for every tendon or tube in order. A tendon given a tension is no longer pulled by a
        displacement, nor one given a displacement by a tension; None or NaN as its displacement leaves it to
        its tension. RobotError names the wrong one.
        """
        tubes = list(self.tubes)
        tendons = list(self.tendons)
        if tension is not None:
            _actuate(tendons, "tendon", "tension", tension, plain_tension, displacement=None)
        if displacement is not None:
            fresh = [] if tension is None else [k for k, _ in _pairs(tendons, "tendon", "tension", tension)]
            _displace(tendons, displacement, fresh)
        if rotation is not None:
            _actuate(tubes, "tube", "rotation", rotation, plain_rotation)
        if translation is not None:
            _actuate(tubes, "tube", "translation", translation, plain_translation)
            check_robot(tubes, tendons, self.loads)
        clone = object.__new__(type(self))
        same = {name: getattr(self, name) for name in _FIELDS}
        clone.__dict__.update(same, tubes=tuple(tubes), tendons=tuple(tendons))
        return clone


_FIELDS = tuple(field.name for field in fields(Robot))


def _count(parts: Sequence[object], kind: str) -> str:
    return f"{len(parts)} {kind}{'' if len(parts) == 1 else 's'}"


def _show_tension(tendon: Tendon) -> str:
    if tendon.displacement is not None:
        return f"pulled {tendon.displacement * 1e3:.4g} mm"
    return "(profile)" if isinstance(tendon.tension, TensionProfile) else f"{tendon.tension:.4g} N"


def _index(field: str, kind: str, name: object, parts: Sequence[Tube] | Sequence[Tendon]) -> int:
    names = [part.name for part in parts]
    if not isinstance(name, str) or name not in names:
        raise RobotError(field, f"there is no {kind} {check.show(name)}", check.near(name, names), value=name)
    return names.index(name)


def _copy(part: Any, **changes: object) -> Any:
    """A copy of a tube or tendon with fields changed to checked values.

    Building it anew would check everything again, at many times the price, and actuation changes in loops.
    """
    clone = object.__new__(type(part))
    clone.__dict__.update(part.__dict__)
    clone.__dict__.update(changes)
    return clone


def _actuate(
    parts: list[Any], kind: str, field: str, values: Any, plain: Callable[[object], Any], **also: object
) -> None:
    for k, value in _pairs(parts, kind, field, values):
        try:
            parts[k] = _copy(parts[k], **{field: plain(value)}, **also)
        except RobotError as error:
            raise _placed(error, parts[k], kind, k) from None


def _placed(error: RobotError, part: Any, kind: str, k: int) -> RobotError:
    placed = error.under(f"{kind}s[{k}]")
    placed.owner = f"{kind.capitalize()} {part.name!r}"
    return placed


def _displace(tendons: list[Any], values: Any, fresh: Sequence[int]) -> None:
    """fresh: the tendons given a tension together with the displacements."""
    for k, value in _pairs(tendons, "tendon", "displacement", values):
        tendon = tendons[k]
        try:
            displacement = plain_displacement(value)
            pulled = tendon.tension != 0.0
            if displacement is not None and pulled and (k in fresh or _has_profile(tendon)):
                raise both_given("displacement", value)
        except RobotError as error:
            raise _placed(error, tendon, "tendon", k) from None
        tension = tendon.tension if displacement is None else 0.0
        tendons[k] = _copy(tendon, displacement=displacement, tension=tension)


def _has_profile(tendon: Tendon) -> bool:
    return isinstance(tendon.tension, TensionProfile)


def _pairs(parts: list[Any], kind: str, field: str, values: Any) -> list[tuple[int, Any]]:
    if isinstance(values, Mapping):
        return [(_index(field, kind, name, parts), value) for name, value in values.items()]
    names = [part.name for part in parts]
    order = f" in the order {', '.join(map(repr, names))}" if names else ""
    expected = f"a mapping from names to values, or {len(names)} values{order}"
    entries = check.row(field, values, expected)
    if len(entries) != len(names):
        raise RobotError(field, f"{len(entries)} values for {len(names)} {kind}s", expected, value=values)
    return list(enumerate(entries))
