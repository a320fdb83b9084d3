"""All that is drawn of one shape, as arrays in metres and world axes: no page in sight."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tactr.statics import Shape
from tactr.viewer.arrows import load_arrows, load_places
from tactr.viewer.disks import Disks, Places, disk_places, disks
from tactr.viewer.frames import material_frames
from tactr.viewer.threads import Thread, threads
from tactr.viewer.walls import Wall, wall_stations, walls
from tactr.viewer.widths import widest

FRAMES_PER_TUBE = 9
ARROW_SHARE = 0.16
"""Length of the longest arrow over that of the robot."""
FRAME_SHARE, FRAME_REACH = 0.04, 2.0
"""Least length of a material frame's axes over that of the robot; over the radius of the widest tube."""


@dataclass(frozen=True, repr=False, eq=False)
class Picture:
    """Walls of the tubes; threads of the tendons; disks; transitions (k, 3) m; material frames, position
    (n, 3) m, wxyz (n, 4) and frame_length m of their axes; arrows (m, 2, 3) m, colours (m, 3); tip (3,) m."""

    walls: list[Wall]
    threads: list[Thread]
    disks: Disks
    transitions: np.ndarray
    frame_position: np.ndarray
    frame_wxyz: np.ndarray
    frame_length: float
    arrows: np.ndarray
    arrow_colours: np.ndarray
    tip: np.ndarray


def picture(
    shape: Shape,
    *,
    diameter_scale: float = 1.0,
    most_tension: float = 1.0,
    frames: bool = False,
    places: Places | None = None,
) -> Picture:
    """The picture of a converged shape. diameter_scale: of the tubes' diameters; most_tension: N, of the
    darkest tendon; frames: with material frames; places: ``disk_places`` of the robot, if known."""
    robot = shape.robot
    places = disk_places(robot) if places is None else places
    tendon_ends = [
        robot.tube(tendon.tube).translation + tendon.end for tendon in robot.tendons if tendon.end is not None
    ]
    s = np.concatenate(
        [wall_stations(robot), [place for _, place, _ in places], tendon_ends, load_places(robot)]
    )
    fine = shape.sample(np.unique(s))
    frame_position, frame_wxyz = material_frames(fine, FRAMES_PER_TUBE if frames else 0)
    reach, radius = max(tube.tip for tube in robot.tubes), max(map(widest, robot.tubes))
    arrows, colours = load_arrows(fine, ARROW_SHARE * reach)
    tips = sorted({tube.tip for tube in robot.tubes})[:-1]
    return Picture(
        walls=walls(fine, diameter_scale),
        threads=threads(fine.tendons, most_tension),
        disks=disks(fine, places),
        transitions=fine.centreline[np.searchsorted(fine.s, tips)].reshape(-1, 3),
        frame_position=frame_position,
        frame_wxyz=frame_wxyz,
        frame_length=max(FRAME_SHARE * reach, FRAME_REACH * diameter_scale * radius),
        arrows=arrows,
        arrow_colours=colours,
        tip=shape.tip_position,
    )
