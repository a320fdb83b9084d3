"""State of a section and the compatibility constraints: u_i and v_i from u_1, v_1, theta_i, u_{d3,i}, beta_i.

The published state holds v_1 and beta_i. We keep v_1 - I_3 and beta_i - 1 instead: stretch and shear of metal
tubes are about 1e-5, and forces are the difference between them and their rest values, so v itself would
throw five digits away. Nothing else changes, since both have the same derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tactr.reference.algebra import I_3, I_33, Array, R_d3, hat, times, transposed


@dataclass(frozen=True)
class State:
    """State at one s for a batch of B robots; tube 1 is included in every row (theta_1 = 0, beta_1 = 1).

    p (B, 3) m; R_1 (B, 3, 3); u_1 (B, 3) 1/m; sigma_1 = v_1 - I_3 (B, 3); theta (B, n) rad; u_d3 (B, n) 1/m,
    whose first column is u_1's third component; dilation = beta - 1 (B, n).
    """

    p: Array
    R_1: Array
    u_1: Array
    sigma_1: Array
    theta: Array
    u_d3: Array
    dilation: Array

    @property
    def strains(self) -> Array:
        """The 4 + 2n strains in the order of eq:finall_x: u_1, v_1 - I_3, u_d3,i, beta_i - 1."""
        return np.concatenate([self.u_1, self.sigma_1, self.u_d3[:, 1:], self.dilation[:, 1:]], axis=1)

    def with_strains(self, x: Array) -> State:
        """Return the state with other strains (B, 4 + 2n); the inverse of `strains`."""
        n = self.theta.shape[1]
        dilation = np.concatenate([np.zeros_like(x[:, :1]), x[:, 5 + n :]], axis=1)
        return State(self.p, self.R_1, x[:, :3], x[:, 3:6], self.theta, x[:, [2, *range(6, 5 + n)]], dilation)

    def pack(self) -> Array:
        """Return the state as (B, 15 + 3n) numbers for the integrator."""
        parts = [self.p, self.R_1.reshape(-1, 9), self.theta[:, 1:], self.strains]
        return np.concatenate(parts, axis=1)

    @classmethod
    def unpack(cls, y: Array, n: int) -> State:
        """Return the state of n tubes from the integrator's numbers."""
        theta = np.concatenate([np.zeros_like(y[:, :1]), y[:, 12 : 11 + n]], axis=1)
        empty = y[:, :0]
        frame = cls(y[:, :3], y[:, 3:12].reshape(-1, 3, 3), empty, empty, theta, empty, empty)
        return frame.with_strains(y[:, 11 + n :])


@dataclass(frozen=True)
class TubeStrains:
    """Strains of all tubes in their own frames, and what the compatibility constraints say of their rates.

    With x' = (u_1', v_1', u_d3,i', beta_i'):
        u_i' = S_i u_1' + I_3 u_d3,i' + c_u        (eq:der_equal_curvature)
        v_i' = beta_i R_i^T v_1' + R_i^T v_1 beta_i' + c_v        (eq:shear_dot_relation)
    Tube 1 has S = identity, R = identity, c_u = c_v = 0 and no unknowns of its own; then every sum that the
    paper writes as 'term of tube 1 + sum over i = 2..n' is a sum over i = 1..n.

    R = R_d3(theta), S (B, n, 3, 3); u, v, sigma = v - I_3, Rt_v1 = R^T v_1, c_u, c_v (B, n, 3);
    beta (B, n, 1, 1).
    """

    R: Array
    S: Array
    u: Array
    v: Array
    sigma: Array
    beta: Array
    Rt_v1: Array
    c_u: Array
    c_v: Array


def tube_strains(state: State) -> TubeStrains:
    """Return the strains of every tube: eq:u2_u1_relationship, eq:shear_relation and their derivatives."""
    R = R_d3(state.theta)
    Rt = transposed(R)
    Rt_u1 = times(Rt, state.u_1[:, None])
    Rt_sigma1 = times(Rt, state.sigma_1[:, None])
    Rt_v1 = Rt_sigma1 + I_3
    dtheta = state.u_d3 - state.u_d3[:, :1]
    beta = 1.0 + state.dilation
    # v_i - I_3 without the loss of digits, since R^T I_3 = I_3.
    sigma = Rt_sigma1 + state.dilation[..., None] * Rt_v1
    turning = dtheta[..., None, None] * hat(I_3).T
    S = Rt - I_33
    S[:, 0, 2, 2] = 1.0
    return TubeStrains(
        R=R,
        S=S,
        u=Rt_u1 + dtheta[..., None] * I_3,
        v=sigma + I_3,
        sigma=sigma,
        beta=beta[..., None, None],
        Rt_v1=Rt_v1,
        c_u=times(turning, Rt_u1),
        c_v=beta[..., None] * times(turning, Rt_v1),
    )
