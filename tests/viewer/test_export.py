"""Files that come out: read back, they hold the robot."""

import io

import numpy as np
import pytest
import trimesh

import tactr
from tactr import examples
from tactr.viewer.export import csv_text, glb, stl
from tactr.viewer.motion import LEAST_STEP, Recorder, motion_html
from tactr.viewer.session import Session
from tactr.viewer.settings import Settings
from tactr.viewer.state import State


@pytest.fixture(scope="module")
def shape() -> tactr.Shape:
    return tactr.solve(examples.load("three_tube_a"))


def test_stl_holds_the_volume_of_the_tubes_in_mm(shape):
    mesh = trimesh.load_mesh(io.BytesIO(stl(shape)), file_type="stl")
    assert mesh.is_watertight
    wanted = 0.0
    for tube in shape.robot.tubes:
        assert tube.outer_diameter is not None and tube.inner_diameter is not None
        wanted += np.pi / 4 * (tube.outer_diameter**2 - tube.inner_diameter**2) * tube.tip * 1e9
    # twenty corners have 1.6 % less area than a circle; stretch and chords change less than a thousandth
    assert mesh.volume == pytest.approx(wanted * np.sin(np.pi / 10) * 10 / np.pi, rel=1e-3)
    assert np.linalg.norm(mesh.vertices - 1e3 * shape.tip_position, axis=1).min() < 0.2


def test_glb_holds_tubes_and_tendons_upright_in_metres(shape):
    scene = trimesh.load_scene(io.BytesIO(glb(shape)), file_type="glb")
    names = {f"{kind} {name}" for kind in ("tube", "tendon") for name in ("outer", "middle", "inner")}
    assert set(scene.geometry) == names
    for name, end in {"tube inner": shape.tip_position, "tendon inner": shape.tendons[2].path[-1]}.items():
        turn, geometry = scene.graph.get(name)
        mesh = scene.geometry[geometry].copy()
        mesh.apply_transform(turn)
        x, y, z = end
        assert np.linalg.norm(mesh.vertices - [x, z, -y], axis=1).min() < 0.3e-3
    colour = scene.geometry["tube outer"].visual.material.baseColorFactor
    assert tuple(colour[:3]) == (0x00, 0x72, 0xB2)


def test_csv_leaves_out_what_is_not_there():
    text = csv_text(["time [s]", "tip, x [mm]"], [[0.0, 1.5], np.array([0.25, np.nan])])
    assert text == 'time [s],"tip, x [mm]"\n0,1.5\n0.25,\n'


def test_a_recorder_keeps_the_newest_of_what_comes_too_fast(monkeypatch):
    now = [100.0]
    monkeypatch.setattr("tactr.viewer.motion.perf_counter", lambda: now[0])
    session, state, recorder = Session(), State(examples.load("two_tube_90")), Recorder()
    outcomes = [session.solve(state.with_value(("tension", "outer"), t)) for t in (3.0, 3.1, 3.2, 3.3)]
    recorder.add(outcomes[0])  # not yet
    recorder.start()
    for time, outcome in zip((0.5, 0.5 + 0.1 * LEAST_STEP, 1.0, 90.0), outcomes, strict=True):
        now[0] = 100.0 + time
        recorder.add(outcome)
    frames = recorder.stop()
    assert [time for time, _ in frames] == pytest.approx([0.0, 0.5 + 0.1 * LEAST_STEP, 1.0, 60.0])
    assert [outcome for _, outcome in frames] == [outcomes[0], outcomes[1], outcomes[2], outcomes[2]]
    assert not recorder.running and recorder.stop() == []


def test_a_motion_is_one_page_that_asks_for_nothing():
    session, state = Session(), State(examples.load("two_tube_90"))
    frames = [(0.1 * k, session.solve(state.with_value(("tension", "outer"), 3.0 + k))) for k in range(3)]
    frames.append((0.3, session.solve(state.with_value(("force", "x"), 1e6))))  # greyed
    html = motion_html(frames, Settings(frames=True), 5.0)
    assert html.lstrip().lower().startswith("<!doctype html")
    assert "__VISER_EMBED_DATA__" in html
    assert not any(f'{attribute}="http' in html for attribute in ("src", "href"))
