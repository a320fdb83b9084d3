"""Every rule of the description: the field that is named, and what the text says."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tactr.errors import RobotError, TactrError
from tactr.materials import nitinol
from tactr.robot import (
    Annulus,
    DistributedLoad,
    Function,
    Gravity,
    Helix,
    Material,
    Piecewise,
    PointLoad,
    PolarPolynomial,
    Polynomial,
    Robot,
    Rod,
    RoutingPiece,
    Spline,
    Stiffness,
    Straight,
    Tendon,
    TensionProfile,
    Tube,
)

NAN, INF = math.nan, math.inf
ROD = Rod(0.001)
GIVEN: dict[str, Any] = {"EA": 1e4, "GA": 1e3, "EI_x": 1e-3, "EI_y": 1e-3, "GJ": 1e-3}


def tube(name: Any = "a", **changes: Any) -> Tube:
    return Tube(name, **{"length": 0.1, "section": ROD, "material": nitinol, **changes})


def tendon(**changes: Any) -> Tendon:
    return Tendon(**{"name": "t", "tube": "a", "routing": Straight(0.01, 0), **changes})


def robot(*tubes: Tube, **parts: Any) -> Robot:
    return Robot(tubes or (tube(),), **parts)


def wide(**changes: Any) -> Tube:
    return tube("wide", section=Annulus(0.003, 0.002), **changes)


class Odd:
    outer_diameter = inner_diameter = None

    def stiffness(self, material: Material | None = None) -> Any:
        return "soft"


def jump(sigma: float) -> tuple[float, float]:
    return (0.001, 0.0) if sigma < 0.04 else (0.002, 0.0)


def broken(sigma: float) -> tuple[float, float]:
    raise KeyError("no such place")


Case = tuple[Callable[[], object], str, tuple[str, ...]]

MATERIAL: list[Case] = [
    (lambda: Material(E=-1e9, nu=0.3), "E", ("-1e+09 Pa", "above 0", "in Pa")),
    (lambda: Material(E=0, nu=0.3), "E", ("0 Pa", "above 0")),
    (lambda: Material(E=NAN, nu=0.3), "E", ("nan", "finite")),
    (lambda: Material(E=10**400, nu=0.3), "E", ("inf", "finite")),
    (lambda: Material(E=True, nu=0.3), "E", ("True", "not a number")),
    (lambda: Material(E="45 GPa", nu=0.3), "E", ("'45 GPa'", "text", "robot files")),  # type: ignore[arg-type]
    (lambda: Material(E=1j, nu=0.3), "E", ("1j", "not a number")),  # type: ignore[arg-type]
    (lambda: Material(E=np.array([1e9, 2e9]), nu=0.3), "E", ("not a number",)),  # type: ignore[arg-type]
    (lambda: Material(E=1e9), "G", ("neither", "nu")),
    (lambda: Material(E=1e9, G=1e8, nu=0.3), "G", ("both", "only one")),
    (lambda: Material(E=1e9, G=0), "G", ("0 Pa", "above 0")),
    (lambda: Material(E=1e9, nu=0.51), "nu", ("0.51", "at most 0.5")),
    (lambda: Material(E=1e9, nu=-1), "nu", ("-1", "above -1")),
    (lambda: Material(E=1e9, nu=0.3, density=-1), "density", ("-1 kg/m^3",)),
    (lambda: Material(E=1e9, nu=0.3, name=3), "name", ("not a text",)),  # type: ignore[arg-type]
    (lambda: Material(E=1e9, nu=0.3, source=3), "source", ("not a text",)),  # type: ignore[arg-type]
]

SECTION: list[Case] = [
    (lambda: Annulus(0.001, 0.001), "inner_diameter", ("0.001 m", "no wall", "below 0.001 m")),
    (lambda: Annulus(0.001, 0.002), "inner_diameter", ("0.002 m", "no wall")),
    (lambda: Annulus(0.001, -0.001), "inner_diameter", ("-0.001 m", "at least 0")),
    (lambda: Annulus(0, 0), "outer_diameter", ("0 m", "above 0")),
    (lambda: Annulus(INF, 0), "outer_diameter", ("inf", "finite")),
    (lambda: Rod(0), "diameter", ("0 m", "above 0")),
    (lambda: Rod(NAN), "diameter", ("nan",)),
    *[
        (lambda key=key, bad=bad: Stiffness(**{**GIVEN, key: bad}), key, ("above 0",))
        for key in GIVEN
        for bad in (0.0, -1.0)
    ],
    (lambda: Stiffness(**{**GIVEN, "GJ": NAN}), "GJ", ("nan",)),
    (lambda: Stiffness(**GIVEN, outer_diameter=0), "outer_diameter", ("above 0",)),
    (lambda: Stiffness(**GIVEN, outer_diameter=1e-3, inner_diameter=2e-3), "inner_diameter", ("no wall",)),
    (lambda: Stiffness(**GIVEN, linear_density=0), "linear_density", ("kg/m",)),
    (lambda: tube(section=Rod(1e-90)), "section", ("stiffness", "diameter in m")),
]

TUBE: list[Case] = [
    (lambda: tube(length=-0.1), "length", ("-0.1 m", "above 0")),
    (lambda: tube(length=0), "length", ("0 m", "above 0")),
    (lambda: tube(length="140 mm"), "length", ("'140 mm'", "text")),
    (lambda: tube(length=None), "length", ("None", "not a number")),
    (lambda: tube(""), "name", ("empty",)),
    (lambda: tube(" a"), "name", ("blanks",)),
    (lambda: tube("a\nb"), "name", ("unprintable",)),
    (lambda: tube(7), "name", ("not a text",)),
    (lambda: tube(translation=0.01), "translation", ("0.01 m", "at most 0", "guide's exit")),
    (lambda: tube(translation=-INF), "translation", ("-inf", "finite")),
    (lambda: tube(rotation=NAN), "rotation", ("nan", "rad")),
    (lambda: tube(material=None), "material", ("none is given", "Stiffness")),
    (lambda: tube(material="nitinol"), "material", ("'nitinol'", "tactr.materials.nitinol")),
    (lambda: tube(section=0.001), "section", ("0.001", "Annulus")),
    (lambda: tube(section=Odd()), "section", ("gives 'soft'", "a Stiffness")),
    (lambda: tube(section=Rod), "section", ("not a section",)),
    (lambda: tube(precurvature=5.0), "precurvature", ("not a list", "1/m")),
    (lambda: tube(precurvature=()), "precurvature", ("empty",)),
    (lambda: tube(precurvature=(1, 2)), "precurvature", ("2 entries", "3 numbers in 1/m")),
    (lambda: tube(precurvature=(1, NAN, 0)), "precurvature[1]", ("nan",)),
    (lambda: tube(precurvature="abc"), "precurvature", ("not a list",)),
    (lambda: tube(precurvature=("a", "b", "c")), "precurvature[0]", ("'a'",)),
    (lambda: tube(precurvature=[(0.02, (1, 0, 0))]), "precurvature[0]", ("0.02 m", "starts at 0")),
    (lambda: tube(precurvature=[(0, (0, 0, 0), 1)]), "precurvature[0]", ("not a pair",)),
    (lambda: tube(precurvature=[(0, (0, 0, 0)), 5]), "precurvature[1]", ("not a list",)),
    (lambda: tube(precurvature=[(0, (0, 0, 0)), (0, (1, 0, 0))]), "precurvature[1]", ("increase",)),
    (lambda: tube(precurvature=[(0, (0, 0, 0)), (0.1, (1, 0, 0))]), "precurvature[1]", ("below the length",)),
    (lambda: tube(precurvature=[(0, (0, 0, 0)), (0.05, (1, INF, 0))]), "precurvature[1][1][1]", ("inf",)),
]

ROUTING: list[Case] = [
    (lambda: Straight(NAN, 0), "x", ("nan", "in m")),
    (lambda: Straight(0, True), "y", ("True",)),
    (lambda: Straight.polar(-0.01, 0), "radius", ("-0.01 m", "at least 0")),
    (lambda: Straight.polar(0.01, INF), "angle", ("inf", "rad")),
    (lambda: Helix(-0.01, 8), "radius", ("-0.01 m", "add pi to the phase")),
    (lambda: Helix(0.01, NAN), "rate", ("nan", "rad/m")),
    (lambda: Helix(0.01, 8, "x"), "phase", ("'x'",)),  # type: ignore[arg-type]
    (lambda: Helix.from_pitch(0.01, 0), "pitch", ("0 m", "Straight")),
    (lambda: Helix.from_pitch(0.01, 1e-320), "pitch", ("pitch in m",)),
    (lambda: Polynomial((), (1,)), "x", ("0 entries", "1 to 16 numbers")),
    (lambda: Polynomial((1,), (0,) * 17), "y", ("17 entries",)),
    (lambda: Polynomial(1.0, (0,)), "x", ("not a list",)),  # type: ignore[arg-type]
    (lambda: PolarPolynomial((1, NAN), (0,)), "radius[1]", ("nan",)),
    (lambda: PolarPolynomial((1,), {0: 1}), "angle", ("not a list",)),  # type: ignore[arg-type]
    (lambda: Spline((0,), ((0, 0),)), "sigma", ("1 entries", "at least 2")),
    (lambda: Spline((0, 0.1, 0.1), ((0, 0),) * 3), "sigma[2]", ("does not come after 0.1 m",)),
    (lambda: Spline((0, 0.1), ((0, 0),)), "points", ("1 points for 2 places",)),
    (lambda: Spline((0, 0.1), ((0, 0), (0, NAN))), "points[1][1]", ("nan",)),
    (lambda: Spline((0, 0.1), ((0, 0), (0, 0, 0))), "points[1]", ("3 entries", "2 numbers")),
    (lambda: Spline((0, 0.1), 5), "points", ("not a list",)),  # type: ignore[arg-type]
    (lambda: Spline((0, 1e-300, 1), ((0, 0), (1, 1), (0, 0))), "sigma", ("too close",)),
    (lambda: Piecewise(()), "parts", ("none",)),
    (lambda: Piecewise(((0.01, Straight(0, 0)),)), "parts[0]", ("0.01 m", "starts at 0")),
    (lambda: Piecewise((Straight(0, 0),)), "parts[0]", ("not a list", "pairs")),  # type: ignore[arg-type]
    (lambda: Piecewise(((0, 5),)), "parts[0]", ("not such a pair",)),  # type: ignore[arg-type]
    (
        lambda: Piecewise(((0, Straight(0, 0)), (0, Straight(0, 0)))),
        "parts[1]",
        ("does not come after",),
    ),
    (
        lambda: Piecewise(((0, Straight(0.001, 0)), (0.05, Straight(0.002, 0)))),
        "parts[1]",
        ("jumps by 0.001 m", "sigma = 0.05 m", "(0.001, 0) m to (0.002, 0) m"),
    ),
    (
        lambda: Piecewise(((0, Spline((0, 0.1), ((0, 0), (0, 0)))), (0.2, Straight(0, 0)))),
        "parts[0]",
        ("Spline", "from 0 m to 0.1 m", "0.2 m"),
    ),
    (lambda: Straight(0, 0).evaluate([0, NAN]), "sigma", ("nan",)),
    (lambda: Straight(0, 0).evaluate("here"), "sigma", ("not a number",)),  # type: ignore[arg-type]
    (lambda: Straight(0, 0).pieces(0), "length", ("above 0",)),
    (lambda: Spline((0, 0.1), ((0, 0), (0, 0))).r(0.2), "sigma", ("0.2 m is outside", "from 0 m to 0.1 m")),
    (lambda: Spline((0, 0.1), ((0, 0), (0, 0))).pieces(0.2), "sigma", ("0.2 m is outside",)),
    (lambda: Spline((0.02, 0.1), ((0, 0), (0, 0))).pieces(0.1), "sigma", ("0 m is outside",)),
    (lambda: RoutingPiece(0.1, 0.1, False, (0,), (0,)), "end", ("above 0.1 m",)),
    (lambda: RoutingPiece(0, 1, False, (0,) * 17, (0,)), "a", ("17 entries",)),
]

FUNCTION: list[Case] = [
    (lambda: Function(5, 0.1), "function", ("cannot be called",)),  # type: ignore[arg-type]
    (lambda: Function(lambda s: (0, 0), 0), "length", ("above 0",)),
    (lambda: Function(lambda s: (NAN, 0), 0.1), "function", ("(nan, 0)", "sigma = 0 m")),
    (lambda: Function(lambda s: (0, NAN if s > 0.05 else 0), 0.1), "function", ("(0, nan)", "sigma =")),
    (lambda: Function(lambda s: (INF, 0), 0.1), "function", ("(inf, 0)",)),
    (lambda: Function(lambda s: 5, 0.1), "function", ("returned 5", "two finite numbers")),  # type: ignore[arg-type, return-value]
    (lambda: Function(lambda s: (0, 0, 0), 0.1), "function", ("returned (0, 0, 0)",)),
    (lambda: Function(lambda s: "12", 0.1), "function", ("returned '12'",)),  # type: ignore[arg-type, return-value]
    (lambda: Function(lambda s: None, 0.1), "function", ("returned None",)),  # type: ignore[arg-type, return-value]
    (lambda: Function(broken, 0.1), "function", ("KeyError", "no such place", "sigma = 0 m")),
    (lambda: Function(jump, 0.1), "function", ("too rough", "0.04 m", "breaks")),
    (lambda: Function(jump, 0.1, breaks=(0.04,)), "function", ("too rough", "0.04 m", "no jumps")),
    (lambda: Function(lambda s: (abs(s - 0.03), 0), 0.1), "function", ("too rough", "0.03 m", "breaks")),
    (lambda: Function(lambda s: (1e-3 * math.sin(1e7 * s), 0), 0.1), "function", ("too rough",)),
    (lambda: Function(lambda s: (0, 0), 0.1, breaks=(0.1,)), "breaks[0]", ("0.1 m", "below 0.1 m")),
    (lambda: Function(lambda s: (0, 0), 0.1, breaks=(0.0,)), "breaks[0]", ("above 0",)),
    (lambda: Function(lambda s: (0, 0), 0.1, breaks=(0.06, 0.05)), "breaks[1]", ("increase",)),
]

TENDON: list[Case] = [
    (lambda: tendon(tension=-1), "tension", ("-1 N", "at least 0", "cannot push")),
    (lambda: tendon(tension=NAN), "tension", ("nan",)),
    (lambda: tendon(tension=True), "tension", ("True",)),
    (lambda: tendon(tension="3 N"), "tension", ("text",)),
    (lambda: tendon(name=""), "name", ("empty",)),
    (lambda: tendon(tube=tube()), "tube", ("not a text",)),
    (lambda: tendon(host="outmost"), "host", ("'outmost'", "did you mean 'outermost'?")),
    (lambda: tendon(host=None), "host", ("'own', 'outermost'",)),
    (lambda: tendon(routing=Straight), "routing", ("the class Straight",)),
    (lambda: tendon(routing=lambda s: (0, 0)), "routing", ("Function(function, length)",)),
    (lambda: tendon(routing=(0.01, 0)), "routing", ("(0.01, 0)", "Straight, Helix")),
    (lambda: tendon(end=0), "end", ("0 m", "above 0")),
    (lambda: tendon(end=INF), "end", ("inf",)),
    (lambda: TensionProfile((), ()), "sigma", ("0 entries",)),
    (lambda: TensionProfile((0, 0.1), (1,)), "values", ("1 tensions for 2 places",)),
    (lambda: TensionProfile((0, 0.1), (1, -2)), "values[1]", ("-2 N",)),
    (lambda: TensionProfile((0.1, 0.1), (1, 2)), "sigma[1]", ("increase",)),
    (lambda: TensionProfile((0, NAN), (1, 2)), "sigma[1]", ("nan",)),
]

LOAD: list[Case] = [
    (lambda: PointLoad("a", force=(0, NAN, 0)), "force[1]", ("nan", "in N")),
    (lambda: PointLoad("a", force=(0, 1)), "force", ("2 entries", "3 numbers in N")),  # type: ignore[arg-type]
    (lambda: PointLoad("a", moment=3), "moment", ("not a list",)),  # type: ignore[arg-type]
    (lambda: PointLoad("a", at=-0.01), "at", ("-0.01 m", "at least 0")),
    (lambda: PointLoad("a", axes="World"), "axes", ("did you mean 'world'?",)),  # type: ignore[arg-type]
    (lambda: PointLoad(None), "tube", ("not a text",)),  # type: ignore[arg-type]
    (lambda: DistributedLoad("a", force=(INF, 0, 0)), "force[0]", ("inf", "N/m")),
    (lambda: DistributedLoad("a", start=-1), "start", ("-1 m",)),
    (lambda: DistributedLoad("a", start=0.05, end=0.05), "end", ("above 0.05 m",)),
    (lambda: DistributedLoad("a", axes="tube"), "axes", ("'world', 'body'",)),  # type: ignore[arg-type]
    (lambda: Gravity((0, 0, "g")), "acceleration[2]", ("'g'", "m/s^2")),  # type: ignore[arg-type]
]

ROBOT: list[Case] = [
    (lambda: Robot(()), "tubes", ("0 tubes", "1 to 8 tubes")),
    (lambda: Robot([tube(str(k), section=Stiffness(**GIVEN)) for k in range(9)]), "tubes", ("9 tubes",)),
    (lambda: Robot(tube()), "tubes", ("a single Tube",)),  # type: ignore[arg-type]
    (lambda: Robot({"a": tube()}), "tubes", ("mapping",)),  # type: ignore[arg-type]
    (lambda: Robot([tube(), "b"]), "tubes[1]", ("'b'", "Tube objects")),  # type: ignore[list-item]
    (lambda: robot(tendons=[Straight(0, 0)]), "tendons[0]", ("Tendon objects",)),
    (lambda: robot(loads=Gravity()), "loads", ("a single Gravity",)),
    (lambda: robot(loads=["gravity"]), "loads[0]", ("'gravity'",)),
    (lambda: robot(assumed="tube diameters"), "assumed", ("a single str",)),
    (lambda: robot(name=None), "name", ("not a text",)),
    (lambda: robot(description=5), "description", ("not a text",)),
    (lambda: robot(wide(), wide()), "tubes[1].name", ("'wide' is already the name of tubes[0]",)),
    (lambda: robot(tendons=[tendon(), tendon()]), "tendons[1].name", ("'t' is already",)),
    (
        lambda: robot(wide(), tube(section=Annulus(0.0021, 0.001))),
        "tubes[1].outer_diameter",
        ("0.0021 m", "bore 0.002 m", "tubes[0] 'wide'", "at most 0.002 m"),
    ),
    (lambda: robot(tube(), tube("b", section=Rod(1e-4))), "tubes[1].outer_diameter", ("solid", "rod last")),
    (
        lambda: robot(wide(), tube("b", section=Stiffness(**GIVEN)), tube("c", section=Rod(0.0025))),
        "tubes[2].outer_diameter",
        ("tubes[0] 'wide'",),
    ),
    (lambda: robot(tube(translation=-0.1)), "tubes[0].translation", ("nothing of 'a' outside the guide",)),
    (
        lambda: robot(wide(), tube(translation=-0.2)),
        "tubes[1].translation",
        ("-0.2 m", "length 0.1 m", "above -0.1 m and at most 0"),
    ),
    (lambda: robot(tendons=[tendon(tube="b")]), "tendons[0].tube", ("no tube 'b'", "'a'")),
    (
        lambda: robot(wide(), tendons=[tendon(tube="wid")]),
        "tendons[0].tube",
        ("no tube 'wid'", "did you mean 'wide'?"),
    ),
    (
        lambda: robot(tendons=[tendon(end=0.11)]),
        "tendons[0].end",
        ("0.11 m is beyond", "at most its length 0.1 m"),
    ),
    (
        lambda: robot(tube(translation=-0.05), tendons=[tendon(end=0.05)]),
        "tendons[0].end",
        ("inside the guide", "above 0.05 m and at most 0.1 m"),
    ),
    (
        lambda: robot(tendons=[tendon(routing=Spline((0, 0.09), ((0, 0), (0, 0))))]),
        "tendons[0].routing",
        ("from 0 m to 0.09 m", "to 0.1 m"),
    ),
    (
        lambda: robot(tendons=[tendon(routing=Function(lambda s: (0.01, 0), 0.05))]),
        "tendons[0].routing",
        ("at least 0.1 m",),
    ),
    (lambda: robot(loads=[PointLoad("b")]), "loads[0].tube", ("no tube 'b'",)),
    (lambda: robot(loads=[PointLoad("a", at=0.2)]), "loads[0].at", ("0.2 m is beyond",)),
    (lambda: robot(loads=[Gravity((0, 0, 0)), DistributedLoad("b")]), "loads[1].tube", ("no tube 'b'",)),
    (lambda: robot(loads=[DistributedLoad("a", end=0.2)]), "loads[0].end", ("0.2 m is beyond",)),
    (lambda: robot(loads=[DistributedLoad("a", start=0.1)]), "loads[0].start", ("below its length 0.1 m",)),
    (
        lambda: robot(tube(material=replace(nitinol, density=None)), loads=[Gravity()]),
        "tubes[0].material.density",
        ("gravity acts", "kg/m^3"),
    ),
    (
        lambda: robot(tube(section=Stiffness(**GIVEN)), loads=[Gravity()]),
        "tubes[0].material.density",
        ("linear_density",),
    ),
]

CASES = MATERIAL + SECTION + TUBE + ROUTING + FUNCTION + TENDON + LOAD + ROBOT


@pytest.mark.parametrize(("build", "field", "parts"), CASES, ids=[f"{k}-{c[1]}" for k, c in enumerate(CASES)])
def test_refused(build: Callable[[], object], field: str, parts: tuple[str, ...]) -> None:
    with pytest.raises(RobotError) as caught:
        build()
    error = caught.value
    assert isinstance(error, ValueError)
    assert isinstance(error, TactrError)
    assert error.field == field
    assert error.expected
    text = str(error)
    assert field in text
    for part in parts:
        assert part in text
    assert "object at 0x" not in text
