"""Friction of tendons on their channels and between tubes, backlash of actuators: hysteresis along a path of
actuation."""

from tactr.friction.drive import drive
from tactr.friction.driven import Driven
from tactr.friction.state import DriveState
from tactr.friction.tube_state import TubeContact, TubeFrictionState

__all__ = ["DriveState", "Driven", "TubeContact", "TubeFrictionState", "drive"]
