"""Elastic forces and moments, eq:constitutive_model_single, and the resultants of section and tendons."""

from __future__ import annotations

from typing import NamedTuple

from tactr.reference.algebra import Array, hat, times
from tactr.reference.compatibility import TubeStrains
from tactr.reference.sections import Section
from tactr.reference.tendons import length_of, velocities


class Wrench(NamedTuple):
    """Force n (N) and moment m (N m) of every tube in its own frame, each (B, n, 3)."""

    n: Array
    m: Array


def elastic(section: Section, k: TubeStrains) -> Wrench:
    """Return n_i = K_se,i (v_i - v*_i) and m_i = K_bt,i (u_i - u*_i)."""
    return Wrench(
        times(section.K_se, k.sigma - section.sigma_star), times(section.K_bt, k.u - section.u_star)
    )


def pull(section: Section, s: float, k: TubeStrains, only: tuple[int, ...] | None = None) -> Wrench:
    """Return what the tendons (all, or `only` these) carry at s: sums of lambda t and of lambda r x t."""
    r, _, _, p_dot = velocities(section, s, k.u, k.v)
    tension = section.tension_at(s)
    carriers = (
        section.carriers if only is None else section.carriers * [j in only for j in range(len(tension))]
    )
    force = tension[:, None] * p_dot / length_of(p_dot)
    return Wrench(carriers @ force, carriers @ times(hat(r), force))


def resultant(section: Section, s: float, k: TubeStrains) -> Wrench:
    """Return N_i = n_i + sum lambda t and M_i = m_i + sum lambda r x t of every tube at s."""
    n, m = elastic(section, k)
    force, moment = pull(section, s, k)
    return Wrench(n + force, m + moment)
