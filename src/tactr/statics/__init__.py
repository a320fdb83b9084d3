"""Statics: from a robot and its actuation to its shape, over the C++ kernel."""

from tactr.statics.contact import Contact, GuideReaction, PointContacts
from tactr.statics.derivatives import Jacobian
from tactr.statics.follow import Followed, Snap, follow
from tactr.statics.mechanics import ActuatorForces
from tactr.statics.rest import rest_lengths
from tactr.statics.shape import Shape, TendonShape, TubeShape
from tactr.statics.solve import Prepared, branches, solve
from tactr.statics.stability import Stability
from tactr.statics.status import Status
from tactr.statics.work import Work, work

__all__ = [
    "ActuatorForces",
    "Contact",
    "Followed",
    "GuideReaction",
    "Jacobian",
    "PointContacts",
    "Prepared",
    "Shape",
    "Snap",
    "Stability",
    "Status",
    "TendonShape",
    "TubeShape",
    "Work",
    "branches",
    "follow",
    "rest_lengths",
    "solve",
    "work",
]
