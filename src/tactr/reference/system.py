"""The linear system A x = b of the published model, eq:finall, and the rate of the state that follows."""

from __future__ import annotations

import numpy as np

from tactr.reference import force_rows, moment_rows
from tactr.reference.algebra import Array, hat, times
from tactr.reference.compatibility import State, TubeStrains, tube_strains
from tactr.reference.constitutive import Wrench, elastic
from tactr.reference.sections import Section
from tactr.reference.tendons import TendonSums, tendon_sums


def assemble(section: Section, s: float, state: State, *, as_printed: bool = False) -> tuple[Array, Array]:
    """Return A (B, 4 + 2n, 4 + 2n), eq:finall_A, and b (B, 4 + 2n), eq:finall_b.

    Rows: G (2: d1, d2), H (n: d3 of each tube), J (2), K (n). Columns, eq:finall_x: u_1', v_1', u_d3,i',
    beta_i' with i = 2..n. With `as_printed` the terms listed in `tactr.reference.DIFFERENCES` are taken as
    printed.
    """
    k = tube_strains(state)
    t = tendon_sums(section, s, k)
    return matrix(section, k, t, as_printed=as_printed), right_hand_side(
        section, state, k, t, as_printed=as_printed
    )


def matrix(section: Section, k: TubeStrains, t: TendonSums, *, as_printed: bool = False) -> Array:
    """Return A, eq:finall_A; the derivative of the resultants by the strains (B, 4 + 2n, 4 + 2n)."""
    H = (
        moment_rows.H_u(section, k, t),
        moment_rows.H_v(k, t),
        moment_rows.H_ud3(section, t),
        moment_rows.H_beta(k, t),
    )
    K = (
        force_rows.K_u(k, t),
        force_rows.K_v(section, k, t),
        force_rows.K_ud3(t),
        force_rows.K_beta(section, k, t),
    )
    G_v = moment_rows.G_v_printed(section, k, t) if as_printed else moment_rows.G_v(k, H[1])
    G = moment_rows.G_u(k, H[0]), G_v, moment_rows.G_ud3(k, H[2]), moment_rows.G_beta(k, H[3])
    J = (
        force_rows.J_u(k, K[0]),
        force_rows.J_v(k, K[1]),
        force_rows.J_ud3(k, K[2]),
        force_rows.J_beta(k, K[3]),
    )
    return np.concatenate([summed_rows(*G), tube_rows(*H), summed_rows(*J), tube_rows(*K)], axis=1)


def summed_rows(by_u: Array, by_v: Array, by_ud3: Array, by_beta: Array) -> Array:
    """Return rows d1 and d2 of a sum over tubes; (B, 2, 4 + 2n)."""
    columns = [by_u, by_v, np.swapaxes(by_ud3[:, 1:], 1, 2), np.swapaxes(by_beta[:, 1:], 1, 2)]
    return np.concatenate(columns, axis=2)[:, :2]


def tube_rows(by_u: Array, by_v: Array, by_ud3: Array, by_beta: Array) -> Array:
    """Return row d3 of every tube; (B, n, 4 + 2n): a tube's own u_d3,i and beta_i only, none for tube 1."""
    own = np.eye(by_u.shape[1])[:, 1:]
    columns = [by_u[:, :, 2], by_v[:, :, 2], by_ud3[:, :, 2, None] * own, by_beta[:, :, 2, None] * own]
    return np.concatenate(columns, axis=2)


def right_hand_side(
    section: Section, state: State, k: TubeStrains, t: TendonSums, *, as_printed: bool = False
) -> Array:
    """Return b, eq:finall_b (B, 4 + 2n), with the external loads that the paper sets to zero."""
    wrench = elastic(section, k)
    f_e, tau_e = external(section, state, k)
    iRHS_2 = moment_rows.RHS_2(section, k, t, wrench) - tau_e
    iRHS_4 = force_rows.RHS_4(section, k, t, wrench) - f_e
    if as_printed:
        iRHS_2 = iRHS_2 + moment_rows.rest_rate_printed(section)
    RHS_1 = moment_rows.RHS_1(k, iRHS_2)[:, :2]
    RHS_3 = force_rows.RHS_3(k, iRHS_4)[:, :2]
    return np.concatenate([RHS_1, iRHS_2[..., 2], RHS_3, iRHS_4[..., 2]], axis=1)


def external(section: Section, state: State, k: TubeStrains) -> Wrench:
    """Return the external force f_e,i (N/m) and moment tau_e,i (N) in each tube's frame (ours)."""
    f_e, tau_e = np.zeros_like(k.u), np.zeros_like(k.u)
    for load in section.loads:
        force, moment = load.in_tube(state.R_1, k.R)
        f_e[:, load.tube] += force
        tau_e[:, load.tube] += moment
    return Wrench(f_e, tau_e)


def solve_scaled(section: Section, A: Array, b: Array) -> Array:
    """Return x of A x = b, moment and force rows brought to one size first.

    The paper takes the minimum-norm least-squares solution; A is square and regular, so that is the solution.
    """
    size = section.row_size
    return np.linalg.solve(A / size[:, None], (b / size)[..., None])[..., 0]


def state_rate(section: Section, s: float, state: State, *, as_printed: bool = False) -> Array:
    """Return d/ds of the packed state (B, 15 + 3n): eq:shape_evol, theta_i' and eq:finall."""
    A, b = assemble(section, s, state, as_printed=as_printed)
    x = solve_scaled(section, A, b)
    p_dot = times(state.R_1, state.sigma_1) + state.R_1[..., 2]
    R_dot = state.R_1 @ hat(state.u_1)
    theta_dot = state.u_d3[:, 1:] - state.u_d3[:, :1]
    return np.concatenate([p_dot, R_dot.reshape(-1, 9), theta_dot, x], axis=1)
