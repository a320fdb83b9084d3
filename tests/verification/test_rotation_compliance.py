"""A spring that turns a tube is a stretch of tube behind it, as stiff in torsion as the spring: exactly."""

from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import Annulus, Gravity, Helix, PointLoad, Robot, Straight, Tendon, Tube, materials

SPRINGS = {"outer": 0.8, "inner": 3.0}  # rad/(N m)
TRANSLATION = {"outer": -0.02, "inner": -0.05}
LENGTH = {"outer": 0.15, "inner": 0.25}
CURVED_FROM = {"outer": 0.05, "inner": 0.1}  # sigma
CURVATURE = {"outer": (6.0, 0.0, 0.0), "inner": (14.0, 2.0, 0.0)}
SECTION = {"outer": Annulus(2.2e-3, 1.7e-3), "inner": Annulus(1.6e-3, 1.2e-3)}


def torsional_stiffness(name):
    return SECTION[name].stiffness(materials.nitinol).GJ


def curved(name, compliance, translation, *, as_spring, **fields):
    """A tube that a spring turns; or with a longer transmission instead."""
    more = 0.0 if as_spring else compliance * torsional_stiffness(name)
    return Tube(
        name,
        length=LENGTH[name] + more,
        section=SECTION[name],
        material=materials.nitinol,
        precurvature=[(0.0, (0.0, 0.0, 0.0)), (CURVED_FROM[name] + more, CURVATURE[name])],
        translation=translation - more,
        rotation_compliance=compliance if as_spring else 0.0,
        **fields,
    )


def tubes(*, as_springs: bool, turned: float):
    """Two curved tubes that twist each other."""
    rotation = {"outer": 0.3, "inner": turned}
    return [
        curved(name, SPRINGS[name], TRANSLATION[name], as_spring=as_springs, rotation=rotation[name])
        for name in SPRINGS
    ]


@pytest.mark.parametrize("turned", [0.3, 1.8, 3.0])
@pytest.mark.parametrize("loads", [[], [Gravity((0.0, 400.0, 0.0))]], ids=["", "gravity"])
def test_as_a_longer_transmission(turned, loads):
    spring, tube = (tactr.solve(Robot(tubes(as_springs=b, turned=turned), [], loads)) for b in (True, False))
    assert spring.converged
    assert spring.tip_position == pytest.approx(tube.tip_position, abs=2e-8)
    assert spring.tip_orientation == pytest.approx(tube.tip_orientation, abs=1e-6)
    assert spring.actuator_forces.torque == pytest.approx(tube.actuator_forces.torque, abs=1e-8)
    assert spring.tip_jacobian().rotation == pytest.approx(tube.tip_jacobian().rotation, abs=1e-6)
    assert spring.stability.stable == tube.stability.stable
    assert spring.stability.margin == pytest.approx(tube.stability.margin, abs=1e-4)
    stiff = [replace(tube, rotation_compliance=0.0) for tube in spring.robot.tubes]
    rigid = tactr.solve(spring.robot.replace(tubes=stiff))
    assert np.linalg.norm(rigid.tip_position - spring.tip_position) > 1e-4  # what it is about


def test_it_snaps_where_the_longer_transmission_does():
    path = {"rotation": np.stack([np.full(30, 0.3), np.linspace(0.3, 5.0, 30)], axis=1)}
    ways = [tactr.follow(Robot(tubes(as_springs=b, turned=0.3)), path) for b in (True, False)]
    assert len(ways[0].snaps) == len(ways[1].snaps) > 0
    for a, b in zip(ways[0].snaps, ways[1].snaps, strict=True):
        assert a.parameter == pytest.approx(b.parameter, abs=1e-3)


def test_the_end_turns_by_the_torque_times_the_compliance():
    helix = Tendon("helix", "inner", Helix(0.5e-3, 30.0), tension=4.0)
    straight = Tendon("straight", "outer", Straight(0, 1e-3), tension=3.0)
    at_the_exit = [replace(tube, translation=0.0) for tube in tubes(as_springs=True, turned=1.5)]
    shape = tactr.solve(Robot(at_the_exit, [helix, straight]))
    for k, tube in enumerate(at_the_exit):
        x, y, _ = shape.tubes[k].frames[0][:, 0]  # d1 at s = 0
        turned_back = tube.rotation_compliance * shape.actuator_forces.torque[k]
        assert abs(turned_back) > 1e-3
        assert np.arctan2(y, x) == pytest.approx(tube.rotation - turned_back, abs=1e-8)


def test_motors_work_is_stored_in_tubes_and_springs():
    robot = Robot(tubes(as_springs=True, turned=0.3))
    turns = np.linspace(0.3, 2.0, 60)
    shapes = [tactr.solve(robot, rotation=[0.3, turn]) for turn in turns]
    work = tactr.work(shapes)
    assert work.total == pytest.approx(work.stored, rel=1e-4)
    springs = work.stored - (shapes[-1].energy - shapes[0].energy)
    assert springs > 0.05 * work.stored


@pytest.mark.parametrize("behind", [0.0, 0.03])
def test_a_moment_at_the_proximal_end_turns_the_spring(behind):
    more = 2.0 * torsional_stiffness("outer")
    shapes = []
    for extra, compliance in ((0.0, 2.0), (more, 0.0)):
        tube = Tube(
            "outer",
            length=0.1 + behind + extra,
            section=SECTION["outer"],
            material=materials.nitinol,
            precurvature=[(0.0, (0.0, 0.0, 0.0)), (0.05 + behind + extra, (8.0, 0.0, 0.0))],
            translation=-behind - extra,
            rotation_compliance=compliance,
        )
        load = PointLoad("outer", moment=(0.0, 0.0, 0.2), axes="body", at=extra)
        shapes.append(tactr.solve(Robot([tube], [], [load])))
    assert shapes[0].actuator_forces.torque == pytest.approx([-0.2], abs=1e-12)
    assert shapes[0].tip_position == pytest.approx(shapes[1].tip_position, abs=2e-8)


@pytest.mark.parametrize("springs", [{"outer": 1.5, "inner": 3.0}, {"outer": 0.0, "inner": 3.0}])
def test_friction_at_the_exit_turns_springs_there(springs):
    tips, heats = [], []
    for as_springs in (True, False):
        made = [
            curved(name, compliance, 0.0, as_spring=as_springs, friction=0.2)
            for name, compliance in springs.items()
        ]
        robot = Robot(made, [], [PointLoad("inner", force=(0.3, 0.2, 0.0))])
        turns = 1.2 * np.sin(np.linspace(0.0, 2.0 * np.pi, 21))
        driven = tactr.drive(robot, {"rotation": np.stack([0.3 * turns, turns], axis=1)})
        assert driven.converged
        tips.append(driven.tips)
        heats.append(driven.tube_heat.sum(axis=0))
    assert tips[0] == pytest.approx(tips[1], abs=1e-7)
    assert heats[0] == pytest.approx(heats[1], rel=1e-5, abs=1e-12)
