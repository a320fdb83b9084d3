"""Robots in a few words."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tactr.robot import Annulus, Helix, Robot, Rod, Stiffness, Straight, Tendon, Tube


def unique(texts: Iterable[str]) -> str:
    """Different texts in order, with slashes between them."""
    return " / ".join(dict.fromkeys(texts))


def actuation(robot: Robot) -> str:
    """What is pulled, turned and withdrawn."""
    parts = [f"{tendon.name} {tension(tendon)} N" for tendon in robot.tendons]
    parts += [f"{t.name} turned {math.degrees(t.rotation):.4g}°" for t in robot.tubes if t.rotation]
    parts += [f"{t.name} withdrawn {-1e3 * t.translation:.4g} mm" for t in robot.tubes if t.translation]
    return ", ".join(parts) or "nothing"


def tension(tendon: Tendon) -> str:
    """A tension in N; the paper's robots have no profiles."""
    return f"{tendon.tension:g}"


def path(tendon: Tendon) -> str:
    """A routing, by offset and angle from d1."""
    routing = tendon.routing
    if isinstance(routing, Straight):
        angle = math.degrees(math.atan2(routing.y, routing.x)) % 360
        return f"{1e3 * math.hypot(routing.x, routing.y):.4g} mm at {angle:.4g}°"
    if isinstance(routing, Helix):
        x, y = routing.r(0.0)
        start = math.degrees(math.atan2(y, x)) % 360
        return f"{1e3 * math.hypot(x, y):.4g} mm, a helix from {start:.4g}°"
    return type(routing).__name__


def section(tube: Tube) -> str:
    """Diameters, or stiffnesses."""
    found = tube.section
    if isinstance(found, Annulus):
        return f"{1e3 * found.outer_diameter:.4g} / {1e3 * found.inner_diameter:.4g} mm"
    if isinstance(found, Rod):
        return f"{1e3 * found.diameter:.4g} mm, solid"
    if isinstance(found, Stiffness):
        x, y, torsion = (f"{1e6 * value:.5g}" for value in (found.EI_x, found.EI_y, found.GJ))
        return f"EI {x}, {y}, GJ {torsion} N mm²"
    return type(found).__name__


def material(tube: Tube) -> str:
    """Its name and moduli; a dash where the section is a stiffness."""
    found = tube.material
    if found is None or isinstance(found, tuple):
        return "-"
    moduli = (f"{name} {1e-9 * modulus:.4g}" for name, modulus in (("E", found.E), ("G", found.G)) if modulus)
    return f"{found.name} {', '.join(moduli)} GPa".strip()


def rest(tube: Tube) -> str:
    """Straight, or the rest curvature and twist."""
    pieces = tube.precurvature
    if not isinstance(pieces, tuple):
        return "rest shape"
    x, y, z = pieces[0][1]
    bent = math.hypot(x, y)
    if not bent and not z:
        return "straight"
    words = [f"radius {1e3 / bent:.4g} mm"] if bent else []
    return ", ".join(words + ([f"twist {z:.4g} 1/m"] if z else []))
