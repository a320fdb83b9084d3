"""The least squares of a calibration, over scipy.optimize.least_squares with exact Jacobians."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, cast

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from tactr.calibration.align import aligned
from tactr.calibration.model import Model, Ticker
from tactr.errors import RobotError

Loss = Literal["linear", "soft_l1", "huber", "cauchy"]
LOSSES: tuple[Loss, ...] = ("linear", "soft_l1", "huber", "cauchy")
TUNING = (
    1.345  # noises, from where a robust loss weighs a residual less (Huber 1964: his is 95 % efficient there)
)
ROUNDS = 8  # of the noise, which priors and robust losses need to be weighed against the data
SETTLED = 0.01  # relative change of the noise
NORMAL = 1.4826  # standard deviation of normal numbers over their median size
FINEST = 1e-12  # m: data without noise are weighed as if they had this
STEPS = 60
INSIDE = 1e-2  # scales: how far from its bounds a number starts


@dataclass(frozen=True)
class Found:
    """values (free,); cost; noise, m; residual (n, k, 3) m, prediction - measurement, NaN where there is
    none; jacobian (numbers, free) of the finite ones, m per SI unit, weighted as the loss asks for; held:
    (free,) bool, at a bound; converged, and what the search said."""

    values: np.ndarray
    cost: float
    noise: float
    residual: np.ndarray
    jacobian: np.ndarray
    held: np.ndarray
    converged: bool
    message: str


def search(
    model: Model, start: np.ndarray, *, noise: float | None, loss: Loss, tick: Ticker | None = None
) -> Found:
    """From one start. noise: m, or None to find it. Raises RobotError where no row has an equilibrium."""
    predicted = model.predict(start, tick)
    usable = np.isfinite(predicted) & np.isfinite(model.measured.points)
    if not usable.any():
        expected = "parameters, units and actuation of a robot that can be in equilibrium"
        raise RobotError("start", "no measured row has an equilibrium there", expected)
    if not model.frees:
        return _as_it_is(model, start, usable, noise)
    start = aligned(model.frees, start, predicted, model.measured.points)
    weigh = loss != "linear" or any(free.prior is not None for free in model.frees)
    least = _Least(model, usable, loss, tick)
    values, known = start, noise
    if known is None:
        known = least.spread(start)
    result = least.solve(values, known)
    for _ in range(ROUNDS if noise is None else 0):
        before, known = known, least.noise(result.x, known)
        if not weigh or abs(known - before) <= SETTLED * before:
            break
        result = least.solve(least.values(result.x), known)
    return least.found(result, known)


def _as_it_is(model: Model, values: np.ndarray, usable: np.ndarray, noise: float | None) -> Found:
    """Nothing is free: how well the robot predicts as it is."""
    residual = np.where(usable, model.predict(values) - model.measured.points, np.nan)
    spread = max(float(np.sqrt(np.nanmean(residual**2))), FINEST)
    empty = np.zeros((int(usable.sum()), 0))
    return Found(values, 0.0, noise or spread, residual, empty, np.zeros(0, bool), True, "nothing is free")


class _Least:
    def __init__(self, model: Model, usable: np.ndarray, loss: Loss, tick: Ticker | None) -> None:
        self._model, self._usable, self._loss, self._tick = model, usable, loss, tick
        self._scales = np.array([free.scale for free in model.frees])
        self._lower = np.array([free.lower for free in model.frees]) / self._scales
        self._upper = np.array([free.upper for free in model.frees]) / self._scales
        self._priors = [(k, *free.prior) for k, free in enumerate(model.frees) if free.prior is not None]
        self._last: tuple[np.ndarray, np.ndarray] | None = None

    def values(self, x: np.ndarray) -> np.ndarray:
        return np.clip(x, self._lower, self._upper) * self._scales

    def residual(self, values: np.ndarray) -> np.ndarray:
        """(n, k, 3), m; shapes belong to the values of the last call."""
        if self._last is None or not np.array_equal(self._last[0], values):
            self._last = values.copy(), self._model.predict(values, self._tick) - self._model.measured.points
        return self._last[1]

    def spread(self, values: np.ndarray) -> float:
        return max(float(np.sqrt(np.mean(self.residual(values)[self._usable] ** 2))), FINEST)

    def noise(self, x: np.ndarray, before: float) -> float:
        r = self.residual(self.values(x))[self._usable]
        freedom = max(len(r) - len(x) + len(self._priors), 1)
        if self._loss == "linear":
            return max(float(np.sqrt((r**2).sum() / freedom)), FINEST)
        return max(NORMAL * float(np.median(np.abs(r))) * np.sqrt(len(r) / freedom), FINEST)

    def solve(self, values: np.ndarray, noise: float) -> OptimizeResult:
        def fun(x: np.ndarray) -> np.ndarray:
            try:
                residual = self.residual(self.values(x))
            except RobotError:  # a number that no robot can have: the search takes a shorter step
                return np.full(int(self._usable.sum()) + len(self._priors), np.inf)
            data = np.where(np.isfinite(residual), residual, np.inf)[self._usable] / noise
            return np.concatenate([data, self._from_priors(self.values(x))])

        def jac(x: np.ndarray) -> np.ndarray:
            values = self.values(x)
            self.residual(values)
            rows = self._model.jacobian(values, self._tick)[self._usable] * self._scales / noise
            priors = [np.eye(len(x))[k] * self._scales[k] / deviation for k, _, deviation in self._priors]
            return np.concatenate([rows, np.reshape(priors, (len(priors), len(x)))])

        # From a bound the search would take steps too small to be seen in shapes solved to a tolerance.
        room = np.minimum(INSIDE, 0.1 * (self._upper - self._lower))
        inside = np.clip(values / self._scales, self._lower + room, self._upper - room)
        return least_squares(
            fun, inside, jac=cast(Any, jac), bounds=(self._lower, self._upper), loss=self._rho(),
            f_scale=TUNING,
            xtol=1e-8, ftol=1e-6, gtol=1e-12, max_nfev=STEPS,
        )  # fmt: skip

    def _rho(self) -> Any:
        """The loss of measured coordinates; priors keep their squares."""
        if self._loss == "linear" or not self._priors:
            return self._loss
        count = len(self._priors)

        def rho(squares: np.ndarray) -> np.ndarray:
            plain = [squares[-count:], np.ones(count), np.zeros(count)]
            return np.concatenate([_rho(self._loss, squares[:-count]), plain], axis=1)

        return rho

    def _from_priors(self, values: np.ndarray) -> np.ndarray:
        return np.array([(values[k] - mean) / deviation for k, mean, deviation in self._priors])

    def found(self, result: OptimizeResult, noise: float) -> Found:
        values = self.values(result.x)
        residual = np.where(self._usable, self.residual(values), np.nan)
        rows = self._model.jacobian(values, self._tick)[self._usable]
        margin = 1e-7 * np.maximum(1.0, np.abs(result.x))
        held = (result.x <= self._lower + margin) | (result.x >= self._upper - margin)
        return Found(
            values,
            float(result.cost),
            noise,
            residual,
            rows * np.sqrt(self._efficiency(residual[self._usable] / noise)),
            held,
            result.status > 0,
            str(result.message),
        )

    def _efficiency(self, z: np.ndarray) -> float:
        """Information of the loss per residual, E[psi']^2 / E[psi^2] over that of squares (Huber 1964)."""
        if self._loss == "linear":
            return 1.0
        step = 1e-4
        psi = {h: _influence(self._loss, z + h) for h in (-step, 0.0, step)}
        slope = np.mean((psi[step] - psi[-step]) / (2 * step))
        return float(slope**2 / np.mean(psi[0.0] ** 2))


def _rho(loss: str, z: np.ndarray) -> np.ndarray:
    """The loss of z = (residual / TUNING)^2 and its two derivatives, (3, n), as least_squares takes them."""
    if loss == "huber":
        far, root = z > 1.0, np.sqrt(np.maximum(z, 1.0))
        return np.where(far, [2 * root - 1, 1 / root, -0.5 / root**3], [z, np.ones_like(z), np.zeros_like(z)])
    if loss == "soft_l1":
        root = np.sqrt(1 + z)
        return np.array([2 * (root - 1), 1 / root, -0.5 / root**3])
    return np.array([np.log1p(z), 1 / (1 + z), -1 / (1 + z) ** 2])


def _influence(loss: str, z: np.ndarray) -> np.ndarray:
    y = z / TUNING
    if loss == "huber":
        return TUNING * np.clip(y, -1.0, 1.0)
    return z / np.sqrt(1 + y**2) if loss == "soft_l1" else z / (1 + y**2)
