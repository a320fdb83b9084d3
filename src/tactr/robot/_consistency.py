"""Checks between the parts of a robot: fit, names, and what lies outside the guide."""

from __future__ import annotations

from collections.abc import Sequence

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._bores import check_fit
from tactr.robot.friction import check_along
from tactr.robot.load import DistributedLoad, Gravity, Load, PointLoad
from tactr.robot.tendon import Tendon
from tactr.robot.tube import Tube

LEAST_REACH = 1e-6
"""Length outside the guide that a tube must have, m: less than a micrometre is nothing."""


def check_robot(tubes: Sequence[Tube], tendons: Sequence[Tendon], loads: Sequence[Load]) -> None:
    """Raise RobotError unless the parts make a robot together."""
    _check_names("tubes", [tube.name for tube in tubes])
    _check_names("tendons", [tendon.name for tendon in tendons])
    for k, tube in enumerate(tubes):
        _check_tip(k, tube)
    check_fit(tubes)
    for k, tendon in enumerate(tendons):
        _check_tendon(f"tendons[{k}]", tendon, tubes)
    for k, load in enumerate(loads):
        _check_load(f"loads[{k}]", load, tubes)


def _check_names(kind: str, names: Sequence[str]) -> None:
    for k, name in enumerate(names):
        if name in names[:k]:
            raise RobotError(
                f"{kind}[{k}].name",
                f"{name!r} is already the name of {kind}[{names.index(name)}]",
                "a name of its own",
                value=name,
            )


def _check_tip(k: int, tube: Tube) -> None:
    if not tube.tip >= LEAST_REACH:
        raise RobotError(
            f"tubes[{k}].translation",
            f"{check.show(tube.translation, 'm')} with length {check.show(tube.length, 'm')} "
            f"leaves nothing of {tube.name!r} outside the guide",
            f"a translation above {check.show(-tube.length, 'm')} and at most 0",
            value=tube.translation,
        )


def _find(field: str, name: str, tubes: Sequence[Tube]) -> Tube:
    for tube in tubes:
        if tube.name == name:
            return tube
    raise RobotError(
        f"{field}.tube",
        f"there is no tube {name!r}",
        check.near(name, [tube.name for tube in tubes]),
        value=name,
    )


def _check_tendon(field: str, tendon: Tendon, tubes: Sequence[Tube]) -> None:
    tube = _find(field, tendon.tube, tubes)
    end = tube.length if tendon.end is None else tendon.end
    _check_reach(f"{field}.end", end, tube)
    if not tube.translation + end > 0:
        raise RobotError(
            f"{field}.end",
            f"{check.show(end, 'm')} is inside the guide, because {tube.name!r} starts at "
            f"{check.show(tube.translation, 'm')}",
            f"an end above {check.show(-tube.translation, 'm')} and at most {check.show(tube.length, 'm')}",
            value=end,
        )
    try:
        check_along(tendon, end)
    except RobotError as error:
        raise error.under(field) from None
    if not tendon.routing.covers(0.0, end):
        first, last = tendon.routing.domain
        raise RobotError(
            f"{field}.routing",
            f"it is defined from {check.show(first, 'm')} to {check.show(last, 'm')}, "
            f"but the tendon runs along {tube.name!r} to {check.show(end, 'm')}",
            f"a routing from 0 to at least {check.show(end, 'm')}",
            value=tendon.routing,
        )


def _check_reach(field: str, sigma: float | None, tube: Tube) -> None:
    if sigma is not None and sigma > tube.length:
        raise RobotError(
            field,
            f"{check.show(sigma, 'm')} is beyond the end of {tube.name!r}",
            f"at most its length {check.show(tube.length, 'm')}",
            value=sigma,
        )


def _check_load(field: str, load: Load, tubes: Sequence[Tube]) -> None:
    if isinstance(load, Gravity):
        for k, tube in enumerate(tubes):
            if tube.linear_density is None:
                raise RobotError(
                    f"tubes[{k}].material.density",
                    f"it is not known for {tube.name!r}, and gravity acts",
                    "a density in kg/m^3 (or linear_density in kg/m of a Stiffness)",
                )
    elif isinstance(load, PointLoad):
        _check_reach(f"{field}.at", load.at, _find(field, load.tube, tubes))
    elif isinstance(load, DistributedLoad) and load.tube is not None:
        tube = _find(field, load.tube, tubes)
        _check_reach(f"{field}.end", load.end, tube)
        if load.start >= tube.length:
            raise RobotError(
                f"{field}.start",
                f"{check.show(load.start, 'm')} is not before the end of {tube.name!r}",
                f"below its length {check.show(tube.length, 'm')}",
                value=load.start,
            )
