"""Forces and energies of a shape, read from the kernel when asked for."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tactr import _core
from tactr.errors import RobotError
from tactr.robot import DistributedLoad, PointLoad
from tactr.statics.contact import Contact, GuideReaction, contacts_of, guide_reaction_of

if TYPE_CHECKING:
    from tactr.robot import Robot
    from tactr.robot.load import Load


class ActuatorForces(NamedTuple):
    """What the actuators hold.

    tension (tendons,) N, conjugate to the tendons' shortening; torque (tubes,) N m on the proximal ends,
    about +z, conjugate to rotation; force (tubes,) N on the proximal ends, along +z, conjugate to
    translation: positive pushes the tube out. The tendons' motors ride on the proximal ends of their tubes,
    so torque and force hold tube and tendons together.
    """

    tension: np.ndarray
    torque: np.ndarray
    force: np.ndarray


class Mechanics:
    """Forces and energies of a converged shape; all raise NotConverged unless it is."""

    if TYPE_CHECKING:
        _prepared: _core.PreparedRobot
        _solution: _core.Solution
        robot: Robot
        s: np.ndarray

        def _require_convergence(self) -> None: ...

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """What every tube exerts on its next inner neighbour, by pairs, outermost first."""
        return contacts_of(self._contact_records, [tube.name for tube in self.robot.tubes])

    @property
    def guide_reaction(self) -> GuideReaction:
        """What the guide exerts across z on the part of the robot outside."""
        return guide_reaction_of(self._contact_records)

    @property
    def tube_energy(self) -> np.ndarray:
        """Elastic strain energy of every tube, (tubes,), J: bending, twist, shear, stretch; with the part in
        the guide."""
        return self._energetics["strain_energy"]

    @property
    def energy(self) -> float:
        """Elastic strain energy of all tubes, J."""
        return float(self.tube_energy.sum())

    @property
    def load_potential(self) -> float:
        """Potential of the loads, J: minus the sum of force times position, zero for a force at the exit.

        Moments and loads in body axes follow the robot and have none: RobotError.
        """
        for k, load in enumerate(self.robot.loads):
            _check_dead(k, load)
        return float(self._energetics["load_potential"])

    @property
    def actuator_forces(self) -> ActuatorForces:
        """Tension of every tendon, torque and axial force on every tube's proximal end.

        Torque is -M_3 of tube and tendons there. Force is the derivative of strain energy, load potential and
        tension times length by the tube's translation, taken at equilibrium: it includes the force by which a
        bent tube is driven out of its guide (Bigoni et al., Mech. Mater. 80, 2015). Where features of two
        tubes meet at one s > 0 their forces jump; the values given share that place equally. Exact up to the
        tubes' stretch; a tendon that changes its host, or ends on another tube than its host, turns with
        neither, which both leave out.
        """
        found = self._energetics
        return ActuatorForces(self._solution.tension, found["torque"], found["force"])

    @cached_property
    def _contact_records(self) -> dict[str, Any]:
        self._require_convergence()
        return _core.contacts(self._prepared, self._solution, self.s)

    @cached_property
    def _energetics(self) -> dict[str, Any]:
        self._require_convergence()
        return _core.energetics(self._prepared, self._solution)


def _check_dead(k: int, load: Load) -> None:
    if not isinstance(load, PointLoad | DistributedLoad):
        return
    if load.axes == "body" and any(load.force):
        raise RobotError(f"loads[{k}].axes", "a force in body axes has no potential", "axes 'world'")
    if any(load.moment):
        raise RobotError(f"loads[{k}].moment", "a moment has no potential", "forces only", value=load.moment)
