"""Statics: from a robot and its actuation to its shape, over the C++ kernel."""

from tactr.statics.shape import Shape, TendonShape, TipJacobian, TubeShape
from tactr.statics.solve import Prepared, solve
from tactr.statics.stability import Stability
from tactr.statics.status import Status

__all__ = ["Prepared", "Shape", "Stability", "Status", "TendonShape", "TipJacobian", "TubeShape", "solve"]
