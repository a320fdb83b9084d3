"""Statics: from a robot and its actuation to its shape, over the C++ kernel."""

from tactr.statics.follow import Followed, Snap, follow
from tactr.statics.shape import Shape, TendonShape, TipJacobian, TubeShape
from tactr.statics.solve import Prepared, branches, solve
from tactr.statics.stability import Stability
from tactr.statics.status import Status

__all__ = [
    "Followed",
    "Prepared",
    "Shape",
    "Snap",
    "Stability",
    "Status",
    "TendonShape",
    "TipJacobian",
    "TubeShape",
    "branches",
    "follow",
    "solve",
]
