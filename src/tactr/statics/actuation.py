"""Actuation of a robot as arrays."""

from __future__ import annotations

import numpy as np

from tactr.robot import Robot, Tendon, TensionProfile, Tube
from tactr.robot._consistency import LEAST_REACH
from tactr.statics.assemble import base_tension


def tensions(robot: Robot) -> np.ndarray:
    """Tension of every tendon handed to the kernel, (tendons,), N."""
    return np.array([base_tension(tendon) for tendon in robot.tendons], dtype=float)


def displacements(robot: Robot) -> np.ndarray | None:
    """By tendon, NaN for those pulled by a tension; None where all are."""
    given = [np.nan if tendon.displacement is None else tendon.displacement for tendon in robot.tendons]
    return without_nothing(np.array(given, dtype=float))


def without_nothing(displacement: np.ndarray | None) -> np.ndarray | None:
    """The displacements, or None where there is none."""
    return None if displacement is None or np.isnan(displacement).all() else displacement


def rotations(robot: Robot) -> np.ndarray:
    """Rotation of every tube, (tubes,), rad."""
    return np.array([tube.rotation for tube in robot.tubes], dtype=float)


def translations(robot: Robot) -> np.ndarray:
    """Translation of every tube, (tubes,), m."""
    return np.array([tube.translation for tube in robot.tubes], dtype=float)


def innermost_place(robot: Robot, tube: Tube) -> float:
    """Arc length of a tube, m, that has to stay outside the guide: its tip, or where a tendon ends."""
    ends = [tendon.end for tendon in robot.tendons if tendon.tube == tube.name and tendon.end is not None]
    return min([tube.length, *ends]) - LEAST_REACH


def differs_in_profile(own: Tendon, other: Tendon) -> bool:
    """Whether one of two tendons has a tension profile that the other has not."""
    profiled = isinstance(own.tension, TensionProfile) or isinstance(other.tension, TensionProfile)
    return profiled and own.tension != other.tension
