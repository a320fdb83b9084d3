"""Load, save and load again is the identity, floats to the last bit."""

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import tactr
from tactr import examples, materials
from tactr.io import dumps, loads
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
    Spline,
    Stiffness,
    Straight,
    Tendon,
    TensionProfile,
    Tube,
)

FORMATS = ("yaml", "toml")
numbers = st.floats(-1e3, 1e3, allow_subnormal=False).filter(lambda x: x == 0 or abs(x) > 1e-30)
positive = st.floats(1e-6, 1e6)
vectors = st.tuples(numbers, numbers, numbers)
names = st.text(min_size=1, max_size=12).filter(lambda text: text == text.strip() and text.isprintable())
characters = "ab:#-'\"{}[]%@`|>&*!?,. \t\n\x85\xa0\u2028\U0001f916"
words = st.lists(st.text(st.sampled_from(characters), max_size=9), max_size=30)
texts = st.text(max_size=60) | words.map(" ".join) | words.map("\n".join)
coefficients = st.lists(numbers, min_size=1, max_size=5).map(tuple)

materials_ = st.one_of(
    st.sampled_from(list(materials.PRESETS.values())),
    st.builds(Material, E=positive, G=positive, density=st.none() | positive, name=names, source=texts),
    st.builds(Material, E=positive, nu=st.floats(-0.9, 0.5)),
)
sections = st.one_of(
    st.builds(lambda d, share: Annulus(d, d * share), positive, st.floats(0, 0.99)),
    st.builds(Rod, positive),
    st.builds(
        Stiffness,
        EA=positive,
        GA=positive,
        EI_x=positive,
        EI_y=positive,
        GJ=positive,
        linear_density=st.none() | positive,
        outer_diameter=st.none() | positive,
    ),
)
pieces = vectors | st.lists(vectors, min_size=1, max_size=3).map(
    lambda us: tuple((0.01 * k, u) for k, u in enumerate(us))
)
smooth = st.one_of(
    st.builds(Straight, numbers, numbers),
    st.builds(Straight.polar, positive, numbers),
    st.builds(Helix, positive, numbers, numbers),
    st.builds(Helix.from_pitch, positive, positive, numbers),
    st.builds(Polynomial, coefficients, coefficients),
    st.builds(PolarPolynomial, coefficients, coefficients),
    st.lists(st.tuples(numbers, numbers), min_size=2, max_size=5).map(
        lambda points: Spline([10.0 * k for k in range(len(points))], points)
    ),
)
routings = smooth | smooth.map(lambda routing: Piecewise(((0.0, routing), (0.5, routing))))
tensions = st.floats(0, 1e3) | st.builds(TensionProfile, st.just((0.0, 1 / 3)), st.tuples(positive, positive))


pulls = st.one_of(tensions.map(lambda t: {"tension": t}), numbers.map(lambda d: {"displacement": d}))


@st.composite
def robots(draw):
    tube = Tube(
        draw(names),
        length=draw(st.floats(0.1, 9.0)),
        section=draw(sections),
        material=draw(materials_),
        precurvature=draw(pieces),
        translation=-draw(st.floats(0, 0.05)),
        rotation=draw(numbers),
        rotation_compliance=draw(st.just(0.0) | positive),
        translation_compliance=draw(st.just(0.0) | positive),
        rotation_play=draw(st.just(0.0) | positive),
        translation_play=draw(st.just(0.0) | positive),
    )
    tendon_names = draw(st.lists(names, max_size=3, unique=True))
    tendons = [
        Tendon(
            name,
            tube.name,
            draw(routings),
            host=draw(st.sampled_from(["own", "outermost"])),
            **draw(pulls),
            compliance=draw(st.just(0.0) | positive),
            pretension=draw(st.just(0.0) | positive),
            rest_length=draw(st.none() | positive),
            end=draw(st.none() | st.floats(0.06, 0.1)),
            friction=draw(st.just(0.0) | positive | st.just(((0.0, 0.1), (0.03, 0.25)))),
            contacts=draw(st.none() | st.just((0.0, 0.02, 0.05))),
            play=draw(st.just(0.0) | positive),
        )
        for name in tendon_names
    ]
    axes = draw(st.sampled_from(["world", "body"]))
    loads_ = [
        PointLoad(
            tube.name, force=draw(vectors), moment=draw(vectors), at=draw(st.none() | st.just(0.0)), axes=axes
        ),
        DistributedLoad(
            draw(st.none() | st.just(tube.name)),
            force=draw(vectors),
            moment=draw(vectors),
            start=0.01,
            end=0.05,
            axes=axes,
        ),
    ]
    if tube.linear_density is not None:
        loads_.append(Gravity(draw(vectors)))
    assumed = draw(st.lists(st.just("tubes[0].length: a guess") | texts, max_size=3))
    return Robot(
        [tube], tendons, loads_, name=draw(st.just("") | names), description=draw(texts), assumed=assumed
    )


@pytest.mark.parametrize("format", FORMATS)
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(robot=robots())
def test_random_robots(robot, format):
    assert loads(dumps(robot, format=format), format=format) == robot


@pytest.mark.parametrize("name", examples.names())
@pytest.mark.parametrize("ending", [".yaml", ".yml", ".toml"])
def test_examples(name, ending, tmp_path):
    robot = examples.load(name)
    path = tmp_path / f"robot{ending}"
    tactr.save(robot, path)
    assert tactr.load(path) == robot
    first = path.read_text()
    tactr.save(tactr.load(path), path)
    assert path.read_text() == first


def test_assumed_stays_a_mapping_where_it_can():
    text = dumps(examples.load("two_tube_90"))
    assert "assumed:\n  tubes[0].outer_diameter: not printed" in text


def test_the_file_is_for_people():
    text = dumps(examples.load("two_tube_90"))
    assert "length: 140 mm" in text
    assert "E: 45 GPa" in text


def test_a_preset_is_written_by_its_name():
    tube = Tube("a", length=0.1, section=Rod(1e-3), material=materials.nitinol)
    assert "material: nitinol\n" in dumps(Robot([tube]))


def test_a_function_cannot_be_written():
    tube = Tube("a", length=0.1, section=Rod(1e-3), material=materials.nitinol)
    routing = Function(lambda sigma: (1e-3 * math.cos(sigma), 1e-3 * math.sin(sigma)), 0.1)
    with pytest.raises(tactr.RobotError, match=r"tendons\[0\]\.routing: a Function is Python code") as caught:
        dumps(Robot([tube], [Tendon("t", "a", routing)]))
    assert caught.value.field == "tendons[0].routing"


def test_saving_where_one_cannot(tmp_path):
    robot = examples.load("two_tube_90")
    with pytest.raises(tactr.FileError, match="cannot be written"):
        tactr.save(robot, tmp_path / "missing" / "robot.yaml")
    with pytest.raises(tactr.FileError, match=r"has the ending '.txt'; expected one of .yaml, .yml, .toml"):
        tactr.save(robot, tmp_path / "robot.txt")


def test_a_tendon_pulled_by_its_motor():
    text = """
tubes: [{name: a, length: 100 mm, section: {kind: rod, diameter: 1 mm}, material: nitinol}]
tendons:
  - name: t
    tube: a
    routing: {kind: straight, x: 5 mm, y: 0 mm}
    displacement: 2 mm
    compliance: 0.1 mm/N
    pretension: 0.5 N
    rest_length: 100 mm
"""
    text = text.replace("section: {kind: rod, diameter: 1 mm}", "outer_diameter: 1 mm, inner_diameter: 0 mm")
    (tendon,) = loads(text).tendons
    assert (tendon.displacement, tendon.compliance) == pytest.approx((2e-3, 1e-4))
    assert (tendon.pretension, tendon.rest_length) == pytest.approx((0.5, 0.1))
    with pytest.raises(tactr.FileError, match="a tension or a displacement, not both"):
        loads(text.replace("displacement: 2 mm", "displacement: 2 mm\n    tension: 1 N"))
    with pytest.raises(tactr.FileError, match="compliance"):
        loads(text.replace("0.1 mm/N", "0.1 N/mm"))
