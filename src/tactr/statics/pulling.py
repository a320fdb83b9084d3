"""What a shape says of its tendons' motors: displacements, tensions, slack."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tactr import _core
from tactr.statics.pulls import is_stable

if TYPE_CHECKING:
    from tactr.robot import Robot
    from tactr.statics.pulls import Pulled
    from tactr.statics.rest import RestState
    from tactr.statics.stability import Stability


class Pulling:
    """Displacements of a shape; all but the error raise NotConverged unless it converged."""

    if TYPE_CHECKING:
        _prepared: _core.PreparedRobot
        _solution: _core.Solution
        _base: Robot
        _pulled: Pulled | None
        _rest: Callable[[], RestState]

        @property
        def robot(self) -> Robot: ...

        @property
        def stability(self) -> Stability: ...

        def _require_convergence(self) -> None: ...

    @property
    def displacement_error(self) -> float:
        """What is missing in the displacement of a tendon, at most, m: a taut tendon's motor elsewhere than
        asked for, or a slack one's beyond. A tenth of ``tolerance`` is allowed; 0 without displacements."""
        return 0.0 if self._pulled is None else float(self._pulled.missed.max())

    @property
    def slack(self) -> tuple[str, ...]:
        """Names of the tendons pulled by a displacement that have no tension."""
        self._require_convergence()
        return () if self._pulled is None else self._pulled.slack(self._base)

    @property
    def tension(self) -> np.ndarray:
        """Tension of every tendon at its motor, (tendons,), N; 1 for a TensionProfile."""
        self._require_convergence()
        return self._solution.tension

    @cached_property
    def displacement(self) -> np.ndarray:
        """What the motor of every tendon pulls, (tendons,), m: as given, or for one pulled by a tension the
        displacement that goes with it, rest length - length + compliance (tension - pretension)."""
        self._require_convergence()
        robot, rest = self.robot, self._rest()
        rotation, translation = (
            np.array([getattr(tube, name) for tube in robot.tubes]) for name in ("rotation", "translation")
        )
        lengths = rest.lengths(rotation, translation, needed=np.ones(len(robot.tendons), dtype=bool))
        compliance = np.array([tendon.compliance for tendon in robot.tendons])
        pull = (
            lengths - self._solution.tendon_length + compliance * (self._solution.tension - rest.pretension)
        )
        given = [tendon.displacement for tendon in robot.tendons]
        return np.array([own if asked is None else asked for own, asked in zip(pull, given, strict=True)])

    @property
    def discretisation_error(self) -> float:
        """Estimated error from the finite step size, m: of the tip, or a tendon's length if larger."""
        return self._solution.discretisation_error

    @cached_property
    def stable(self) -> bool:
        """Whether the shape is stable as it is pulled: motors of tendons with displacements held, the other
        tendons at their tensions. Held motors can keep what falls over at held tensions (``stability``)."""
        if self._pulled is None:
            return self.stability.stable
        self._require_convergence()
        return is_stable(self._prepared, self._pulled.pulls, self._solution)
