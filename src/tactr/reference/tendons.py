"""Tendon velocities and the sums over tendons of which all the published matrices are made."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tactr.reference.algebra import Array, cross, hat, times
from tactr.reference.compatibility import TubeStrains
from tactr.reference.paths import routing
from tactr.reference.sections import Section


@dataclass(frozen=True)
class TendonSums:
    """Sums over the tendons j = 1..m_i of each tube i, with Q = lambda / |p_dot|^3 [p_dot]^2.

    Q, rQ, Qr, rQr (B, n, 3, 3): sums of Q, [r] Q, Q [r] and [r] Q [r]. Qg, rQg (B, n, 3): sums of Q g and [r]
    Q g with g = [u] p_dot + [u] r_dot + r_ddot, the part of eq:tendon_position_derivatives that holds no
    strain rate. df, dtau (B, n, 3): force and moment from a tension that varies along the tendon (ours; zero
    in the paper). rQ_each (B, m, 3, 3): [r] Q of the single tendons, which only the literal reading of eq:Gv
    needs.
    """

    Q: Array
    rQ: Array
    Qr: Array
    rQr: Array
    Qg: Array
    rQg: Array
    df: Array
    dtau: Array
    rQ_each: Array


def velocities(section: Section, s: float, u: Array, v: Array) -> tuple[Array, Array, Array, Array]:
    """Return r, r_dot, r_ddot (m, 3) and p_dot^b (B, m, 3), first line of eq:tendon_position_derivatives.

    u, v (B, n, 3) are the strains of the tubes in their own frames.
    """
    r, dr, ddr = routing(section.paths, s)
    hosts = list(section.hosts)
    return r, dr, ddr, cross(u[:, hosts], r) + dr + v[:, hosts]


def length_of(vector: Array) -> Array:
    """Return |vector| (..., 3) -> (..., 1); analytic, so that complex steps pass through."""
    return np.sqrt((vector * vector).sum(axis=-1, keepdims=True))


def tendon_sums(section: Section, s: float, strains: TubeStrains) -> TendonSums:
    """Return the sums over tendons at s (SI units)."""
    r, dr, ddr, p_dot = velocities(section, s, strains.u, strains.v)
    hat_u = hat(strains.u)[:, list(section.hosts)]
    norm = length_of(p_dot)
    hat_p, hat_r = hat(p_dot), hat(r)
    Q = (section.tension_at(s)[:, None] / norm**3)[..., None] * (hat_p @ hat_p)
    g = times(hat_u, p_dot + dr) + ddr
    along = section.tension_rate[:, None] * p_dot / norm
    rQ = hat_r @ Q

    def over_tendons(each: Array) -> Array:
        rest = each.shape[2:]
        summed = section.carriers @ each.reshape(*each.shape[:2], math.prod(rest))
        return summed.reshape(*summed.shape[:2], *rest)

    matrices = over_tendons(np.stack([Q, rQ, Q @ hat_r, rQ @ hat_r], axis=2))
    vectors = over_tendons(np.stack([times(Q, g), times(rQ, g), along, times(hat_r, along)], axis=2))
    return TendonSums(*np.moveaxis(matrices, 2, 0), *np.moveaxis(vectors, 2, 0), rQ_each=rQ)
