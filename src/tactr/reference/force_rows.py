"""Force equilibrium: the matrices J (summed over tubes, d1 and d2) and K (per tube, d3), RHS_3 and RHS_4.

As in `moment_rows`: iK_u u_1' + iK_v v_1' + iK_ud3 I_3 u_d3,i' + iK_beta beta_i' = RHS_4,i holds for each
tube (rows d3), J = sum_i R_d3(theta_i) iK and RHS_3 = sum_i R_d3(theta_i) RHS_4,i (rows d1, d2).
"""

from __future__ import annotations

from tactr.reference.algebra import Array, cross, times, transposed
from tactr.reference.compatibility import TubeStrains
from tactr.reference.constitutive import Wrench
from tactr.reference.sections import Section
from tactr.reference.tendons import TendonSums


def K_u(k: TubeStrains, t: TendonSums) -> Array:
    """eq:Ku (tube 1), eq:Kui: sum Q [r] (R^T - I_33); (B, n, 3, 3)."""
    return t.Qr @ k.S


def K_v(section: Section, k: TubeStrains, t: TendonSums) -> Array:
    """eq:Kv, eq:Kvi: (K_se,i - sum Q) beta_i R^T; (B, n, 3, 3)."""
    return (section.K_se - t.Q) @ (k.beta * transposed(k.R))


def K_ud3(t: TendonSums) -> Array:
    """eq:Kuzi times I_3: sum Q [r] I_3; (B, n, 3). Tube 1 has no such unknown (eq:Kuz: zero)."""
    return t.Qr[..., 2]


def K_beta(section: Section, k: TubeStrains, t: TendonSums) -> Array:
    """eq:Kbetai (printed with the label of tube 1): (K_se,i - sum Q) R^T v_1; (B, n, 3).

    Tube 1: eq:Kbeta, zero.
    """
    return times(section.K_se - t.Q, k.Rt_v1)


def RHS_4(section: Section, k: TubeStrains, t: TendonSums, wrench: Wrench) -> Array:
    """eq:RHS4_1 (tube 1, where c_u = c_v = 0), eq:RHS4i; (B, n, 3), N/m.

    The last term is ours (varying tension).
    """
    return (
        -times(section.K_se, k.c_v - section.dv_star)
        - cross(k.u, wrench.n)
        + t.Qg
        - times(t.Qr, k.c_u)
        + times(t.Q, k.c_v)
        - t.df
    )


def J_u(k: TubeStrains, iK_u: Array) -> Array:
    """eq:Ju; (B, 3, 3), rows d1 and d2 count."""
    return (k.R @ iK_u).sum(axis=1)


def J_v(k: TubeStrains, iK_v: Array) -> Array:
    """eq:Jv; (B, 3, 3)."""
    return (k.R @ iK_v).sum(axis=1)


def J_ud3(k: TubeStrains, iK_ud3: Array) -> Array:
    """eq:Juz of every tube, times I_3; (B, n, 3)."""
    return times(k.R, iK_ud3)


def J_beta(k: TubeStrains, iK_beta: Array) -> Array:
    """eq:Jbeta of every tube; (B, n, 3)."""
    return times(k.R, iK_beta)


def RHS_3(k: TubeStrains, iRHS_4: Array) -> Array:
    """eq:RHS3; (B, 3), N/m."""
    return times(k.R, iRHS_4).sum(axis=1)
