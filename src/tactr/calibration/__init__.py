"""Calibration: a robot's numbers from measured points."""

from tactr.calibration.calibrate import calibrate
from tactr.calibration.frame import Frame
from tactr.calibration.hold_out import HoldOut
from tactr.calibration.measurements import Measurements, Remark
from tactr.calibration.parameters import Parameter
from tactr.calibration.result import Calibration, Estimate

__all__ = ["Calibration", "Estimate", "Frame", "HoldOut", "Measurements", "Parameter", "Remark", "calibrate"]
