"""Notched tubes: the section that a row of cuts and uncut rings is equivalent to.

A cut to depth g, measured from the tube's outside across the diameter, leaves of the annulus what lies beyond
a chord. Area, centroid and second moments of the circular segments that the chord cuts from the outer and the
inner circle (opening angle phi, radius r, A = r^2 (phi - sin phi) / 2, centroid at 4 r sin^3(phi/2) / (3 (phi
- sin phi))) give those of the wall that is left: York, Swaney, Gilbert and Webster, A wrist for needle-sized
surgical robots (ICRA 2015); Swaney, York, Gilbert, Burgner-Kahrs and Webster, Design, fabrication, and
testing of a needle-sized wrist for surgical instruments (J. Med. Devices 11, 2017); Eastwood, Azimian,
Carrillo, Looi, Naguib and Drake, Kinetostatic design of asymmetric notch joints for surgical robots (IROS
2016). Cuts from both sides, of the kind of Kutzer et al., Design of a new cable-driven manipulator with a
large open lumen (ICRA 2011), and Murphy et al., Design and kinematic characterization of a surgical
manipulator (Robotica 32, 2014): both segments removed from the annulus.

Along a period the sections are in series, so their compliances add. With the neutral axis at y from the
centreline, curvature and stretch of the centreline are (M - y N) / EI and N / EA - y (M - y N) / EI; averaged
over cut and uncut lengths: 1/EI' = <1/EI>, y' = EI' <y/EI>, 1/EA' = <1/EA + y^2/EI> - y'^2/EI'. A cut wall is
open and twists as thin strips, J = sum of width t^3 / 3 (Timoshenko and Goodier, Theory of Elasticity,
section 108); that the rings hold it from warping, and that it twists about its shear centre, is left out: a
short cut is stiffer in torsion. Shear factor 1, as for Annulus.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.material import Material
from tactr.robot.section import Annulus, Stiffness

SIDES = {"+x": (1.0, 0.0), "-x": (-1.0, 0.0), "+y": (0.0, 1.0), "-y": (0.0, -1.0)}


class WallShape(NamedTuple):
    """What a cut leaves, in m^2, m and m^4.

    centroid: from the centreline towards the cut (negative). across, along: second moments about axes through
    the centroid, across the cut's direction and along it. torsion: the torsion constant.
    """

    area: float
    centroid: float
    across: float
    along: float
    torsion: float


@dataclass(frozen=True, kw_only=True)
class AsymmetricNotches:
    """A tube with cuts from one side: depth, cut and uncut lengths in m, side "+x", "-x", "+y" or "-y".

    Of every period ``cut`` + ``uncut`` of the length, ``cut`` has the wall cut away from ``side`` to
    ``depth``, measured from the outside: more than the wall, less than the diameter without the wall. With
    ``staggered``, every other cut is from the opposite side (bidirectional), and the neutral axis stays on
    the centreline. Raises RobotError. Formulas and sources: the description of tactr.robot.notches.
    """

    outer_diameter: float
    inner_diameter: float
    depth: float
    cut: float
    uncut: float
    side: str = "+y"
    staggered: bool = False

    def __post_init__(self) -> None:
        with check.owned("AsymmetricNotches"):
            _check_tube(self)
            wall = 0.5 * (self.outer_diameter - self.inner_diameter)
            _check_cuts(self, most=self.outer_diameter - wall)
            if not isinstance(self.staggered, bool):
                raise RobotError(
                    "staggered", f"{check.show(self.staggered)} is no truth value", "true or false"
                )

    @property
    def wall(self) -> WallShape:
        """The wall left at a cut."""
        return one_sided(self.outer_diameter, self.inner_diameter, self.depth)

    def stiffness(self, material: Material | None = None) -> Stiffness:
        """The equivalent section: stiffness in N and N m^2, neutral axis in m. Raises RobotError."""
        return _equivalent(self, self.wall, material, staggered=self.staggered)


@dataclass(frozen=True, kw_only=True)
class SymmetricNotches:
    """A tube with pairs of opposite cuts, from ``side`` and the side across: it bends both ways.

    Fields as of AsymmetricNotches; ``depth`` of each cut is more than the wall and less than the radius.
    Raises RobotError.
    """

    outer_diameter: float
    inner_diameter: float
    depth: float
    cut: float
    uncut: float
    side: str = "+y"

    def __post_init__(self) -> None:
        with check.owned("SymmetricNotches"):
            _check_tube(self)
            _check_cuts(self, most=0.5 * self.outer_diameter)

    @property
    def wall(self) -> WallShape:
        """The wall left at a pair of cuts."""
        return two_sided(self.outer_diameter, self.inner_diameter, self.depth)

    def stiffness(self, material: Material | None = None) -> Stiffness:
        """The equivalent section: stiffness in N and N m^2. Raises RobotError."""
        return _equivalent(self, self.wall, material, staggered=False)


def one_sided(outer_diameter: float, inner_diameter: float, depth: float) -> WallShape:
    """The wall left by one cut to ``depth``; all in m. York et al. 2015."""
    chord = depth - 0.5 * outer_diameter  # of the wall that is left, away from the cut, from the centreline
    outer, inner = _segment(0.5 * outer_diameter, chord), _segment(0.5 * inner_diameter, chord)
    area = outer.area - inner.area
    moment = outer.moment - inner.moment
    thickness, mean = 0.5 * (outer_diameter - inner_diameter), 0.25 * (outer_diameter + inner_diameter)
    arc = 2 * mean * math.acos(chord / mean)
    return WallShape(
        area=area,
        centroid=-moment / area,
        across=outer.across - inner.across - moment**2 / area,
        along=outer.along - inner.along,
        torsion=arc * thickness**3 / 3,
    )


def two_sided(outer_diameter: float, inner_diameter: float, depth: float) -> WallShape:
    """The two strips left by opposite cuts to ``depth``; all in m."""
    half = 0.5 * outer_diameter - depth
    circles = []
    for radius in (0.5 * outer_diameter, 0.5 * inner_diameter):
        gone = _segment(radius, half)
        quarter = math.pi * radius**4 / 4
        circles.append(
            (math.pi * radius**2 - 2 * gone.area, quarter - 2 * gone.across, quarter - 2 * gone.along)
        )
    area, across, along = (o - i for o, i in zip(*circles, strict=True))
    thickness, mean = 0.5 * (outer_diameter - inner_diameter), 0.25 * (outer_diameter + inner_diameter)
    width = 2 * mean * math.asin(half / mean)
    return WallShape(area, 0.0, across, along, 2 * width * thickness**3 / 3)


class _Segment(NamedTuple):
    """Area, first moment, second moments across and along the direction, about the circle's centre."""

    area: float
    moment: float
    across: float
    along: float


def _segment(radius: float, chord: float) -> _Segment:
    """The part of a circle beyond a chord at distance ``chord`` (negative: more than half of it)."""
    phi = 2 * math.acos(max(-1.0, min(1.0, chord / radius))) if radius else 0.0
    sine = math.sin(phi)
    lift = 2 * sine * math.sin(phi / 2) ** 2
    return _Segment(
        area=radius**2 * (phi - sine) / 2,
        moment=2 * radius**3 * math.sin(phi / 2) ** 3 / 3,
        across=radius**4 * (phi - sine + lift) / 8,
        along=radius**4 * (3 * (phi - sine) - lift) / 24,
    )


def _equivalent(
    notches: AsymmetricNotches | SymmetricNotches,
    wall: WallShape,
    material: Material | None,
    *,
    staggered: bool,
) -> Stiffness:
    whole = Annulus(notches.outer_diameter, notches.inner_diameter).stiffness(material)
    assert material is not None
    share = notches.cut / (notches.cut + notches.uncut)
    E, G = material.E, material.shear_modulus

    def series(of_wall: float, of_whole: float) -> float:
        return 1 / (share / of_wall + (1 - share) / of_whole)

    EI = series(E * wall.across, whole.EI_x)
    along = series(E * wall.along, whole.EI_x)
    bent = share * wall.centroid / (E * wall.across)  # curvature per axial force, on average
    shift = 0.0 if staggered else bent * EI
    stretched = share * (1 / (E * wall.area) + wall.centroid**2 / (E * wall.across))
    EA = 1 / (stretched + (1 - share) / whole.EA - shift**2 / EI)
    dx, dy = SIDES[notches.side]
    x_side = dx != 0
    density = None if material.density is None else material.density * _mean_area(notches, wall, share)
    return Stiffness(
        EA=EA,
        GA=series(G * wall.area, whole.GA),
        EI_x=along if x_side else EI,
        EI_y=EI if x_side else along,
        GJ=series(G * wall.torsion, whole.GJ),
        neutral_axis=(shift * dx + 0.0, shift * dy + 0.0),
        outer_diameter=notches.outer_diameter,
        inner_diameter=notches.inner_diameter,
        linear_density=density,
    )


def _mean_area(notches: AsymmetricNotches | SymmetricNotches, wall: WallShape, share: float) -> float:
    whole = math.pi * (notches.outer_diameter**2 - notches.inner_diameter**2) / 4
    return share * wall.area + (1 - share) * whole


def _check_tube(notches: AsymmetricNotches | SymmetricNotches) -> None:
    try:
        tube = Annulus(notches.outer_diameter, notches.inner_diameter)
    except RobotError as error:
        raise RobotError(error.field, error.problem, error.expected, value=error.value) from None
    check.real("inner_diameter", tube.inner_diameter, "m", above=0)
    check.store(notches, outer_diameter=tube.outer_diameter, inner_diameter=tube.inner_diameter)


def _check_cuts(notches: AsymmetricNotches | SymmetricNotches, *, most: float) -> None:
    wall = 0.5 * (notches.outer_diameter - notches.inner_diameter)
    depth = check.real("depth", notches.depth, "m", above=wall, below=most)
    cut = check.real("cut", notches.cut, "m", above=0)
    uncut = check.real("uncut", notches.uncut, "m", least=0)
    check.store(
        notches, depth=depth, cut=cut, uncut=uncut, side=check.choice("side", notches.side, list(SIDES))
    )
