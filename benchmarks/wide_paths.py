"""Random paths of robots of the wider set: rotations, insertions, tensions or displacements change together.

The first corner is the robot as it is. At every other one each tube's rotation is moved by up to 60 degrees
from where it was before, its distal end by up to 30 % of the way to its whole length or to 15 % of it, and
the tendons' tensions are those of the robot times 0 to 1. Robots pulled by displacements have their tendons
tied where the tubes stand in the beginning (``tactr.rest_lengths``), and displacements -1 to 1 times their
own.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from wide_robots import displaced, wide_robot

import tactr
from tactr.robot import Robot
from tactr.statics import Followed, Prepared

POINTS_EACH = 50
TURN = math.radians(60.0)
REACH = 0.3
LEAST_REACH = 0.15


def follow_random_path(seed: int, points: int) -> Followed | None:
    """One solution along the path of this seed; None for a robot without tendons, or none from cold."""
    robot = displaced(wide_robot(seed), seed)
    if not robot.tendons or not Prepared(robot, stations=2).solve().converged:
        return None
    if any(tendon.displacement is not None for tendon in robot.tendons):
        lengths = tactr.rest_lengths(robot)
        robot = robot.replace(tendons=[replace(t, rest_length=lengths[t.name]) for t in robot.tendons])
    return tactr.follow(robot, random_path(robot, seed, points), stations=2)


def random_path(robot: Robot, seed: int, points: int) -> dict[str, np.ndarray]:
    """Rows of rotations, translations, tensions and displacements."""
    rng = np.random.default_rng([seed, 2])
    rotation = [np.array([tube.rotation for tube in robot.tubes])]
    translation = [np.array([tube.translation for tube in robot.tubes])]
    most, least = _places(robot)
    scale = [1.0]
    for _ in range(points // POINTS_EACH + 1):
        rotation.append(rotation[-1] + rng.uniform(-TURN, TURN, len(most)))
        goal = np.where(rng.random(len(most)) < 0.5, most, least)
        translation.append(translation[-1] + rng.uniform(0.0, REACH, len(most)) * (goal - translation[-1]))
        scale.append(rng.uniform(0.0, 1.0))
    part = np.arange(points) / POINTS_EACH
    k, share = part.astype(int), (part % 1.0)[:, None]
    path = {
        name: (1.0 - share) * np.array(rows)[k] + share * np.array(rows)[k + 1]
        for name, rows in (("rotation", rotation), ("translation", translation))
    }
    pulls = np.array([np.nan if t.displacement is None else t.displacement for t in robot.tendons])
    tension = np.array([t.tension for t in robot.tendons], dtype=float)
    factor = np.interp(part, np.arange(len(scale)), scale)[:, None]
    if not np.isnan(pulls).all():
        return path | {"displacement": (2.0 * factor - 1.0) * pulls}
    return path | {"tension": factor * tension}


def _places(robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Translations between which a tube stays: at most 0, at least so that a part of it, and every end of a
    tendon on it, is outside."""
    most, least = [], []
    for tube in robot.tubes:
        ends = [t.end for t in robot.tendons if t.tube == tube.name and t.end is not None]
        shortest = min([tube.length, *ends])
        least.append(-shortest + LEAST_REACH * min(tube.tip, shortest))
        most.append(0.0)
    translation = np.array([tube.translation for tube in robot.tubes])
    return np.array(most), np.minimum(np.array(least), translation)
