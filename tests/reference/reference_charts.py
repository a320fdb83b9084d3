"""The equilibrium of each tube written directly, without the published matrices.

Along a line of states s -> s + h, x -> x + h x', the resultants N_i = n_i + lambda t and M_i = m_i + lambda r
x t are differentiated by a complex step h. What N_i' + [u_i] N_i + f_e,i and M_i' + [u_i] M_i + [v_i] N_i +
tau_e,i leave over is linear in x': A x' - b.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tactr.reference.algebra import Array
from tactr.reference.compatibility import State
from tactr.reference.paths import Path
from tactr.reference.sections import Section, WorldOrBody

H = 1e-30


@dataclass(frozen=True)
class Spiral:
    """Tendon at radius (r0 + r1 s), angle (a0 + a1 s + a2 s^2) of its host, tension l0 + l1 s.

    S may be complex.
    """

    host: int
    radius: tuple[float, float]
    angle: tuple[float, float, float]
    tension: tuple[float, float]

    def at(self, s: complex) -> tuple[Array, Array, complex]:
        """Return r, r' and the tension."""
        (r0, r1), (a0, a1, a2) = self.radius, self.angle
        rho, phi, dphi = r0 + r1 * s, a0 + a1 * s + a2 * s * s, a1 + 2 * a2 * s
        c, sn = np.cos(phi), np.sin(phi)
        r = np.array([rho * c, rho * sn, 0.0])
        dr = np.array([r1 * c - rho * dphi * sn, r1 * sn + rho * dphi * c, 0.0])
        return r, dr, self.tension[0] + self.tension[1] * s


@dataclass(frozen=True)
class Chart:
    """A point of the state space and the data of the tubes there (n tubes): what the balances are made of."""

    s: float
    theta: Array
    u_1: Array
    v_1: Array
    u_d3: Array
    beta: Array
    K_se: Array
    K_bt: Array
    u_star: Array
    du_star: Array
    v_star: Array
    dv_star: Array
    spirals: tuple[Spiral, ...]
    f_e: Array
    tau_e: Array

    def balances(self, rate: Array) -> tuple[Array, Array]:
        """Return what each tube's force and moment balance leave over (n, 3), in its frame, at x' = rate."""
        n = len(self.theta)
        theta_rate = self.u_d3 - self.u_1[2]
        theta_rate[0] = 0.0
        N, M = self.resultants(rate, theta_rate, 1j * H)
        u, v = (a.real for a in self.strains(rate, theta_rate, 0.0))
        force = N.imag / H + np.cross(u, N.real) + self.f_e
        moment = M.imag / H + np.cross(u, M.real) + np.cross(v, N.real) + self.tau_e
        assert force.shape == (n, 3)
        return force, moment

    def strains(self, rate: Array, theta_rate: Array, h: complex) -> tuple[Array, Array]:
        """Return u_i, v_i (n, 3) at s + h by the compatibility constraints."""
        n = len(self.theta)
        u_1, v_1 = self.u_1 + h * rate[:3], self.v_1 + h * rate[3:6]
        u_d3 = self.u_d3 + h * np.concatenate([[rate[2]], rate[6 : 5 + n]])
        beta = self.beta + h * np.concatenate([[0.0], rate[5 + n :]])
        u, v = np.zeros((2, n, 3), dtype=complex)
        for i, theta in enumerate(self.theta + h * theta_rate):
            c, s = np.cos(theta), np.sin(theta)
            Rt = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
            u[i] = Rt @ u_1
            u[i, 2] = u_d3[i]
            v[i] = beta[i] * (Rt @ v_1)
        return u, v

    def resultants(self, rate: Array, theta_rate: Array, h: complex) -> tuple[Array, Array]:
        """Return N_i, M_i (n, 3) at s + h."""
        u, v = self.strains(rate, theta_rate, h)
        N = np.einsum("iab,ib->ia", self.K_se, v - self.v_star - h * self.dv_star)
        M = np.einsum("iab,ib->ia", self.K_bt, u - self.u_star - h * self.du_star)
        for spiral in self.spirals:
            r, dr, tension = spiral.at(self.s + h)
            q = np.cross(u[spiral.host], r) + dr + v[spiral.host]
            pull = tension * q / np.sqrt((q * q).sum())
            N[spiral.host] += pull
            M[spiral.host] += np.cross(r, pull)
        return N, M

    def rows(self, rate: Array) -> Array:
        """Return the balances in the order of eq:finall_A's rows (4 + 2n,)."""
        force, moment = self.balances(rate)
        summed = []
        for part in (moment, force):
            total = np.zeros(3)
            for theta, own in zip(self.theta, part, strict=True):
                c, s = np.cos(theta), np.sin(theta)
                total += np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ own
            summed.append(total[:2])
        return np.concatenate([summed[0], moment[:, 2], summed[1], force[:, 2]])

    def system(self) -> tuple[Array, Array]:
        """Return A and b of A x' = b."""
        size = 4 + 2 * len(self.theta)
        b = -self.rows(np.zeros(size))
        return np.array([self.rows(column) + b for column in np.eye(size)]).T, b


def random_chart(seed: int, n: int, m: int) -> Chart:
    """Return a chart with n tubes, m spiral tendons, large strains and everything varying, of order one."""
    rng = np.random.default_rng(seed)
    some = rng.uniform
    u_1 = some(-2, 2, 3)
    return Chart(
        s=some(0, 0.3),
        theta=np.concatenate([[0.0], some(-2, 2, n - 1)]),
        u_1=u_1,
        v_1=np.array([0, 0, 1]) + some(-0.2, 0.2, 3),
        u_d3=np.concatenate([u_1[2:], some(-2, 2, n - 1)]),
        beta=np.concatenate([[1.0], some(0.8, 1.2, n - 1)]),
        K_se=np.array([np.diag(some(1, 3, 3)) for _ in range(n)]),
        K_bt=np.array([np.diag(some(1, 3, 3)) for _ in range(n)]),
        u_star=some(-1, 1, (n, 3)),
        du_star=some(-1, 1, (n, 3)),
        v_star=np.array([0, 0, 1]) + some(-0.2, 0.2, (n, 3)),
        dv_star=some(-1, 1, (n, 3)),
        spirals=tuple(
            Spiral(
                int(rng.integers(n)), tuple(some(0.2, 0.6, 2)), tuple(some(-2, 2, 3)), tuple(some(0.3, 2, 2))
            )
            for _ in range(m)
        ),
        f_e=some(-1, 1, (n, 3)),
        tau_e=some(-1, 1, (n, 3)),
    )


def as_section(chart: Chart) -> tuple[Section, State]:
    """Return the same data as the reference takes it, with the loads given in body axes."""
    n = len(chart.theta)
    spirals = chart.spirals
    section = Section(
        start=0.0,
        end=1.0,
        tubes=tuple(range(n)),
        K_se=chart.K_se,
        K_bt=chart.K_bt,
        u_star=chart.u_star,
        tendons=tuple(range(len(spirals))),
        paths=tuple(Path(0.0, True, spiral.radius, spiral.angle) for spiral in spirals),
        hosts=tuple(spiral.host for spiral in spirals),
        tension=np.array([spiral.tension[0] for spiral in spirals]),
        tension_rate=np.array([spiral.tension[1] for spiral in spirals]),
        loads=tuple(WorldOrBody(i, chart.f_e[i], chart.tau_e[i], world=False) for i in range(n)),
        v_star=chart.v_star,
        du_star=chart.du_star,
        dv_star=chart.dv_star,
    )
    state = State(
        p=np.zeros((1, 3)),
        R_1=np.eye(3)[None],
        u_1=chart.u_1[None],
        sigma_1=chart.v_1[None] - [0, 0, 1],
        theta=chart.theta[None],
        u_d3=chart.u_d3[None],
        dilation=chart.beta[None] - 1.0,
    )
    return section, state
