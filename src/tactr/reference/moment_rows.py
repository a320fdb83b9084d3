"""Moment equilibrium: the matrices G (summed over tubes, d1 and d2) and H (per tube, d3), RHS_1 and RHS_2.

For each tube the moment balance, eq:moment_each_local1 with eq:moment_sum_local3 and the compatibility
constraints put in, reads iH_u u_1' + iH_v v_1' + iH_ud3 I_3 u_d3,i' + iH_beta beta_i' = RHS_2,i with full
3-row matrices. The paper takes its d3 row per tube, and for d1 and d2 the sum over the tubes turned into tube
1's frame, so that G = sum_i R_d3(theta_i) iH and RHS_1 = sum_i R_d3(theta_i) RHS_2,i. Every function returns
all n tubes at once.
"""

from __future__ import annotations

import numpy as np

from tactr.reference.algebra import Array, cross, times, transposed
from tactr.reference.compatibility import TubeStrains
from tactr.reference.constitutive import Wrench
from tactr.reference.sections import Section
from tactr.reference.tendons import TendonSums


def H_u(section: Section, k: TubeStrains, t: TendonSums) -> Array:
    """eq:Hu (tube 1), eq:Hui: (K_bt,i + sum [r] Q [r]) (R^T - I_33); (B, n, 3, 3)."""
    return (section.K_bt + t.rQr) @ k.S


def H_v(k: TubeStrains, t: TendonSums) -> Array:
    """eq:Hv, eq:Hvi: -sum [r] Q beta_i R^T; (B, n, 3, 3)."""
    return -t.rQ @ (k.beta * transposed(k.R))


def H_ud3(section: Section, t: TendonSums) -> Array:
    """eq:Huzi times I_3: (K_bt,i + sum [r] Q [r]) I_3; (B, n, 3).

    Tube 1 has no such unknown (eq:Huz: zero).
    """
    return (section.K_bt + t.rQr)[..., 2]


def H_beta(k: TubeStrains, t: TendonSums) -> Array:
    """eq:Hbetai: -sum [r] Q R^T v_1; (B, n, 3). For tube 1 there is no such unknown (eq:Hbeta: zero)."""
    return -times(t.rQ, k.Rt_v1)


def RHS_2(section: Section, k: TubeStrains, t: TendonSums, wrench: Wrench) -> Array:
    """eq:RHS21 (tube 1, where c_u = c_v = 0), eq:RHS2i; (B, n, 3), N.

    c_u = theta' [I_3]^T R^T u_1 and c_v = beta theta' [I_3]^T R^T v_1; the last term is ours (varying
    tension).
    """
    return (
        -times(section.K_bt, k.c_u - section.du_star)
        - cross(k.u, wrench.m)
        - cross(k.v, wrench.n)
        + t.rQg
        - times(t.rQr, k.c_u)
        + times(t.rQ, k.c_v)
        - t.dtau
    )


def G_u(k: TubeStrains, iH_u: Array) -> Array:
    """eq:Gu; (B, 3, 3), rows d1 and d2 count."""
    return (k.R @ iH_u).sum(axis=1)


def G_v(k: TubeStrains, iH_v: Array) -> Array:
    """eq:Gv with m_1 as the first sum's bound; (B, 3, 3)."""
    return (k.R @ iH_v).sum(axis=1)


def G_v_printed(section: Section, k: TubeStrains, t: TendonSums) -> Array:
    """eq:Gv as printed: the sum over tube 1's tendons stops at m_i, with i read as its last value n."""
    iH_v = H_v(k, t)
    first = [j for j, host in enumerate(section.hosts) if host == 0][
        : section.hosts.count(len(section.tubes) - 1)
    ]
    iH_v[:, 0] = -t.rQ_each[:, first].sum(axis=1)
    return (k.R @ iH_v).sum(axis=1)


def G_ud3(k: TubeStrains, iH_ud3: Array) -> Array:
    """eq:Guz of every tube, times I_3; (B, n, 3)."""
    return times(k.R, iH_ud3)


def G_beta(k: TubeStrains, iH_beta: Array) -> Array:
    """eq:Gbeta of every tube; (B, n, 3)."""
    return times(k.R, iH_beta)


def RHS_1(k: TubeStrains, iRHS_2: Array) -> Array:
    """eq:RHS1; (B, 3), N."""
    return times(k.R, iRHS_2).sum(axis=1)


def rest_rate_printed(section: Section) -> Array:
    """Return what eq:RHS1 and eq:RHS21 print too much: K_bt,1 u*_i' in place of K_bt,1 u*_1'; (n, 3), N.

    The loose index i is read as its last value n.
    """
    du_star = np.broadcast_to(section.du_star, (len(section.tubes), 3))
    wrong = np.zeros_like(du_star)
    wrong[0] = times(section.K_bt[0], du_star[-1] - du_star[0])
    return wrong
