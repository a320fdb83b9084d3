"""Tendon-actuated concentric tube robots: description, statics, files, plots.

Names are imported when first used, so that ``import tactr`` and ``tactr --help`` stay light.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tactr import examples, materials, reference, reproduce
    from tactr.batch import Batch, solve_batch
    from tactr.calibration import Calibration, Frame, Measurements, Parameter, calibrate
    from tactr.errors import FileError, MissingExtra, NotConverged, RobotError, TactrError
    from tactr.friction import Driven, DriveState, TubeContact, TubeFrictionState, drive
    from tactr.io import load, save
    from tactr.robot import (
        Along,
        Annulus,
        AsymmetricNotches,
        DistributedLoad,
        Function,
        Gravity,
        Helix,
        Material,
        Piecewise,
        PointLoad,
        PolarPolynomial,
        Polynomial,
        RestShape,
        Robot,
        Rod,
        Spline,
        Stiffness,
        Straight,
        SymmetricNotches,
        Tendon,
        TendonLimits,
        TensionProfile,
        Tube,
        TubeFriction,
        TubeLimits,
        VaryingStiffness,
    )
    from tactr.statics import (
        ActuatorForces,
        Contact,
        Followed,
        GuideReaction,
        Jacobian,
        PointContacts,
        Prepared,
        Shape,
        Snap,
        Stability,
        Status,
        TendonShape,
        TubeShape,
        Work,
        branches,
        follow,
        rest_lengths,
        solve,
        work,
    )
    from tactr.studies import InsertionOrder, Range, Samples, Study, Sweep, Values, load_study, sweep
    from tactr.viewer import View, show

_HOME = {
    "tactr.batch": ("Batch", "solve_batch"),
    "tactr.calibration": ("Calibration", "Frame", "Measurements", "Parameter", "calibrate"),
    "tactr.errors": ("FileError", "MissingExtra", "NotConverged", "RobotError", "TactrError"),
    "tactr.friction": ("DriveState", "Driven", "TubeContact", "TubeFrictionState", "drive"),
    "tactr.io": ("load", "save"),
    "tactr.robot": (
        "Along",
        "Annulus",
        "AsymmetricNotches",
        "DistributedLoad",
        "Function",
        "Gravity",
        "Helix",
        "Material",
        "Piecewise",
        "PointLoad",
        "PolarPolynomial",
        "Polynomial",
        "RestShape",
        "Robot",
        "Rod",
        "Spline",
        "Stiffness",
        "Straight",
        "SymmetricNotches",
        "Tendon",
        "TendonLimits",
        "TensionProfile",
        "Tube",
        "TubeFriction",
        "TubeLimits",
        "VaryingStiffness",
    ),
    "tactr.statics": (
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
    ),
    "tactr.studies": (
        "InsertionOrder",
        "Range",
        "Samples",
        "Study",
        "Sweep",
        "Values",
        "load_study",
        "sweep",
    ),
    "tactr.viewer": ("View", "show"),
}
_MODULE_OF = {name: module for module, names in _HOME.items() for name in names}
_SUBMODULES = ("examples", "materials", "reference", "reproduce")

__version__ = "0.1.0"
__all__ = [
    "ActuatorForces",
    "Along",
    "Annulus",
    "AsymmetricNotches",
    "Batch",
    "Calibration",
    "Contact",
    "DistributedLoad",
    "DriveState",
    "Driven",
    "FileError",
    "Followed",
    "Frame",
    "Function",
    "Gravity",
    "GuideReaction",
    "Helix",
    "InsertionOrder",
    "Jacobian",
    "Material",
    "Measurements",
    "MissingExtra",
    "NotConverged",
    "Parameter",
    "Piecewise",
    "PointContacts",
    "PointLoad",
    "PolarPolynomial",
    "Polynomial",
    "Prepared",
    "Range",
    "RestShape",
    "Robot",
    "RobotError",
    "Rod",
    "Samples",
    "Shape",
    "Snap",
    "Spline",
    "Stability",
    "Status",
    "Stiffness",
    "Straight",
    "Study",
    "Sweep",
    "SymmetricNotches",
    "TactrError",
    "Tendon",
    "TendonLimits",
    "TendonShape",
    "TensionProfile",
    "Tube",
    "TubeContact",
    "TubeFriction",
    "TubeFrictionState",
    "TubeLimits",
    "TubeShape",
    "Values",
    "VaryingStiffness",
    "View",
    "Work",
    "branches",
    "calibrate",
    "drive",
    "examples",
    "follow",
    "load",
    "load_study",
    "materials",
    "reference",
    "reproduce",
    "rest_lengths",
    "save",
    "show",
    "solve",
    "solve_batch",
    "sweep",
    "work",
]


def __getattr__(name: str) -> Any:
    if name in _SUBMODULES:
        return import_module(f"tactr.{name}")
    if name in _MODULE_OF:
        return getattr(import_module(_MODULE_OF[name]), name)
    raise AttributeError(f"module 'tactr' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
