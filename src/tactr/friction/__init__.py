"""Friction of tendons on their channels and backlash of actuators: hysteresis along a path of actuation."""

from tactr.friction.drive import drive
from tactr.friction.driven import Driven
from tactr.friction.state import DriveState

__all__ = ["DriveState", "Driven", "drive"]
