"""How a solve ended, in words."""

from __future__ import annotations

import math
from enum import Enum
from typing import TYPE_CHECKING

from tactr import _core
from tactr.robot.friction import rubs

if TYPE_CHECKING:
    from tactr.robot import Robot
    from tactr.statics.pulls import Pulled


class Status(str, Enum):
    """How a solve ended; only CONVERGED and UNSTABLE carry a shape. NOT_MET: tensions that meet the
    displacements were not found.

    UNSTABLE: from cold, an equilibrium was found, but no stable one. A solve from a guess stays on its
    branch and does not look: see ``Shape.stability``.
    """

    CONVERGED = "converged"
    UNSTABLE = "converged, unstable"
    NO_SECTION_EQUILIBRIUM = "no section equilibrium"
    KINKED = "kinked"
    STALLED = "stalled"
    TOO_COARSE = "too coarse"
    COLLAPSED = "collapsed"
    TOO_SENSITIVE = "too sensitive"
    NOT_MET = "displacement not met"


_BY_CODE = (
    Status.CONVERGED,
    Status.NO_SECTION_EQUILIBRIUM,
    Status.STALLED,
    Status.TOO_COARSE,
    Status.COLLAPSED,
    Status.TOO_SENSITIVE,
)
UNSTABLE = 2  # the kernel's code
KINK = 0.1  # length of a pulled tendon per length of tube, below which the tube is bent round the tendon


def status_of(solution: _core.Solution, pulled: Pulled | None = None) -> Status:
    """The kernel's status code as a Status, and whether displacements were met."""
    status = _BY_CODE[solution.status]
    if pulled is not None and status is Status.CONVERGED:
        if not pulled.met:
            return Status.NOT_MET
        return Status.UNSTABLE if pulled.stable is False else status
    if status is Status.CONVERGED and solution.stability == UNSTABLE:
        return Status.UNSTABLE
    if status is Status.NO_SECTION_EQUILIBRIUM and solution.shortest_tendon < KINK:
        return Status.KINKED
    return status


def explain(status: Status, solution: _core.Solution, tolerance: float) -> str:
    """One text: what happened, and for a failure what to do about it."""
    if status in (Status.CONVERGED, Status.UNSTABLE):
        return (
            f"converged: base missed by {solution.base_residual:.1e} rad, section equilibrium to "
            f"{solution.section_residual:.1e}, discretisation {solution.discretisation_error:.1e} m"
            f"{_remark(status, solution)}"
        )
    if status is Status.TOO_SENSITIVE:
        # under a pulling force F the base answers the free end cosh(sqrt(F L^2 / EI)) times over
        load = math.log(2.0 * solution.amplification) ** 2
        return _TOO_SENSITIVE.format(s=solution, load=load)
    return _FAILURES[status].format(s=solution, tolerance=tolerance) if status in _FAILURES else ""


def told_with_pulls(text: str, status: Status, pulled: Pulled, robot: Robot) -> str:
    """The text of a solve under displacements: which tendons are slack, or which displacement is not met."""
    if status in (Status.CONVERGED, Status.UNSTABLE):
        slack = ", ".join(map(repr, pulled.slack(robot)))
        held = f"displacements met to {float(pulled.missed.max()):.1e} m"
        return f"{text}; {held}, {f'slack: {slack}' if slack else 'no tendon slack'}"
    if not pulled.rested:
        return f"the rest state, from which displacements count, was not found: {text}"
    given_up = f" The search was given up after {pulled.marches} marches." if pulled.given_up else ""
    if status is not Status.NOT_MET:
        return f"at the tensions tried for the displacements, {text}{given_up}"
    worst = int(pulled.missed.argmax())
    names = [robot.tendons[j].name for j in pulled.pulls.index]
    tensions = ", ".join(
        f"{name} {tension:.3g} N" for name, tension in zip(names, pulled.tension, strict=True)
    )
    return (
        f"no tensions were found that meet the displacements: {names[worst]!r} misses its own of "
        f"{pulled.pulls.displacement[worst] * 1e3:.4g} mm by {pulled.missed[worst] * 1e3:.2g} mm at the best "
        f"tensions found ({tensions}). Displacements that work against each other compress the tubes: pull "
        "less, give the tendons their compliance, check the units, or start from a shape nearby with guess=."
        f"{given_up}"
    )


def told_of_history(robot: Robot, driven: bool) -> str:
    """Whose friction or backlash a shape leaves out: only ``tactr.drive`` knows what came before."""
    if driven:
        return ""
    rubbing = [t.name for t in robot.tendons if rubs(t.friction)]
    rubbing += [t.name for t in robot.tubes if t.friction is not None and t.friction.coefficient > 0.0]
    loose = [t.name for t in robot.tendons if t.play]
    loose += [t.name for t in robot.tubes if t.rotation_play or t.translation_play]
    giving = [t.name for t in robot.tubes if t.translation_compliance]
    left = [
        f"{what} of {', '.join(map(repr, names))}"
        for what, names in (("friction", rubbing), ("backlash", loose), ("give", giving))
        if names
    ]
    return f"; without the {' and the '.join(left)}, which tactr.drive follows" if left else ""


def _remark(status: Status, solution: _core.Solution) -> str:
    if status is Status.UNSTABLE:
        return (
            ". This equilibrium is unstable, and no stable one was found: a real robot does not stay there. "
            "Lower the loads, tensions or curvatures, or shorten the straight lengths behind the guide."
        )
    if solution.switched:
        return "; the equilibrium found first was unstable, this is the stable one of least energy found"
    return ""


_TOO_SENSITIVE = (
    "no equilibrium was found: the base answers an angle at the free end {s.amplification:.0e} times over, "
    "as under a pulling force of {load:.0f} EI/L^2 or more, so that in double precision the free end no "
    "longer determines the base. Under such a load nearly all of the robot hangs along it like a string: "
    "lower it (check its unit and size, and the tubes' stiffness), or take the part that hangs as a cable."
)

_FAILURES = {
    Status.NO_SECTION_EQUILIBRIUM: (
        "no equilibrium was found: a cross-section has none under this load. The load or a tension is "
        "far beyond what the tubes can carry; check its unit and size, and the tubes' stiffness."
    ),
    Status.KINKED: (
        "no equilibrium was found: a tendon bends its tubes to a radius as small as its own offset from "
        "the axis, where its path has no length left (disks would touch). Lower that tension, stiffen "
        "the tubes that carry it, bring the tendon nearer to the axis, or check the units of tension, E "
        "and diameters."
    ),
    Status.STALLED: (
        "no equilibrium was found in {s.iterations} iterations, from the straight robot (which missed "
        "the base by {s.base_residual:.1e} rad) and by growing tensions, curvatures and loads from zero. "
        "The load is probably far beyond what the tubes can carry (check its unit and size), or the "
        "robot is at a fold where it snaps: start from a neighbouring shape with guess=, or lower the "
        "loads."
    ),
    Status.TOO_COARSE: (
        "the discretisation error {s.discretisation_error:.1e} m stayed above the tolerance "
        "{tolerance:.1e} m. Ask for a coarser tolerance, or check the routing and the loads for "
        "extremely fast variation along the tubes."
    ),
    Status.COLLAPSED: (
        "the solution found compresses a tube to {s.least_stretch:.3g} of its length, where linear "
        "elasticity means nothing. A tension or an axial load is far too large, or EA too small; check "
        "their units."
    ),
}
