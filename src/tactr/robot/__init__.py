"""Description of a robot: immutable plain data, checked when it is built; no solver in sight."""

from tactr.robot.along import Along
from tactr.robot.fitted import Function, Spline
from tactr.robot.limits import TendonLimits, TubeLimits
from tactr.robot.load import DistributedLoad, Gravity, Load, PointLoad
from tactr.robot.material import Material
from tactr.robot.notches import AsymmetricNotches, SymmetricNotches
from tactr.robot.piece import RoutingPiece
from tactr.robot.piecewise import Piecewise
from tactr.robot.rest import RestShape
from tactr.robot.robot import Robot
from tactr.robot.routing import Helix, PolarPolynomial, Polynomial, Routing, Straight
from tactr.robot.section import Annulus, Rod, Section, Stiffness
from tactr.robot.tendon import Tendon, TensionProfile
from tactr.robot.tube import Tube
from tactr.robot.tube_friction import TubeFriction
from tactr.robot.varying import VaryingStiffness

__all__ = [
    "Along",
    "Annulus",
    "AsymmetricNotches",
    "DistributedLoad",
    "Function",
    "Gravity",
    "Helix",
    "Load",
    "Material",
    "Piecewise",
    "PointLoad",
    "PolarPolynomial",
    "Polynomial",
    "RestShape",
    "Robot",
    "Rod",
    "Routing",
    "RoutingPiece",
    "Section",
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
]
