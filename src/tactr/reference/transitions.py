"""What crosses a section's end: eq:boundary_n and eq:boundary_m, and the resultant form that corrects them.

Tubes press on each other without friction, so of the six components per tube only the d3 ones hold tube by
tube; d1 and d2 hold for the sum over tubes. (Printed for every tube, eq:boundary_n and eq:boundary_m are 6n
conditions for 4 + 2n unknowns.)
- "resultant", the default: elastic part plus pull of the tendons is continuous but for point loads. A tendon
  that ends acts on the tube to which it is fixed. One that goes on while its host ends hands its d3 pull, as
  it is just beyond, on to its next host, so that the kink presses on the host that ends.
- "published": the elastic part alone is carried over for tendons that continue; only terminating ones enter.
  The two differ where a continuing tendon's direction jumps: the paper leaves the force of that kink out.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from tactr.reference.algebra import Array, R_d3, times
from tactr.reference.compatibility import State, TubeStrains, tube_strains
from tactr.reference.constitutive import Wrench, elastic, pull, resultant
from tactr.reference.sections import Section, SectionEnd
from tactr.reference.system import matrix, solve_scaled
from tactr.reference.tendons import tendon_sums

Transitions = Literal["resultant", "published"]

SMALL_STEP = 1e-9
"""Newton stops after a step this small (curvatures in 1/m, strains in 1e-6): its square is what is left."""
MAX_STEPS = 60


class BlownUp(Exception):
    """The march from these base strains does not reach the tip."""


class Crossing(NamedTuple):
    """State just beyond a section's end; d3 force (N) and moment (N m) left on each ended tube (B, 2 e)."""

    state: State
    left_over: Array


def arriving(
    section: Section, end: SectionEnd, k: TubeStrains, R_1: Array, transitions: Transitions
) -> Wrench:
    """Return what each tube hands on at the section's end, in its own frame, point loads taken off.

    Each (B, n, 3).
    """
    s = section.end
    if transitions == "resultant":
        n, m = resultant(section, s, k)
    else:
        n, m = (
            a + b for a, b in zip(elastic(section, k), pull(section, s, k, only=end.tendons), strict=True)
        )
    for tendon, anchor in zip(end.tendons, end.anchors, strict=True):
        # Fixed to one tube, guided by another: its d3 pull changes tubes; d1 and d2 stay within the sum.
        force, moment = (part[..., 2] for part in pull(section, s, k, only=(tendon,)))
        host = section.hosts[tendon]
        n[:, anchor, 2] += force[:, host]
        n[:, host, 2] -= force[:, host]
        m[:, anchor, 2] += moment[:, host]
        m[:, host, 2] -= moment[:, host]
    for load in end.loads:
        force, moment = load.in_tube(R_1, k.R)
        n[:, load.tube] -= force
        m[:, load.tube] -= moment
    return Wrench(n, m)


def balance_rows(wrench: Wrench, R: Array) -> Array:
    """Return moments and forces in the order of eq:finall_A's rows (B, 4 + 2n)."""
    M, N = (times(R, part).sum(axis=1)[:, :2] for part in (wrench.m, wrench.n))
    return np.concatenate([M, wrench.m[..., 2], N, wrench.n[..., 2]], axis=1)


def finish(section: Section, end: SectionEnd, state: State, transitions: Transitions) -> Array:
    """Return what is left over at the robot's tip, in the order of `balance_rows`.

    All zero at the solution.
    """
    k = tube_strains(state)
    return balance_rows(arriving(section, end, k, state.R_1, transitions), k.R)


def cross_over(
    section: Section, end: SectionEnd, beyond: Section, state: State, transitions: Transitions
) -> Crossing:
    """Return the state at the start of the section beyond, in the frame of its own outermost tube."""
    k = tube_strains(state)
    handed = arriving(section, end, k, state.R_1, transitions)
    staying = [i for i in range(len(section.tubes)) if i not in end.tubes]
    n_d3, m_d3 = (part[..., 2].copy() for part in handed)
    heirs = moved_tendons(section, end, beyond) if transitions == "resultant" else ()
    if heirs:
        # Tube 1 ended; what is left in its d3 rows is, at the solution, the pull of the tendons that move on.
        n_d3[:, staying[0]] += n_d3[:, 0]
        m_d3[:, staying[0]] += m_d3[:, 0]
    M, N = (times(k.R, part).sum(axis=1) for part in (handed.m, handed.n))
    turn = R_d3(-state.theta[:, staying[0]])
    M, N = (times(turn, part)[:, :2] for part in (M, N))
    target = np.concatenate([M, m_d3[:, staying], N, n_d3[:, staying]], axis=1)
    carrier = beyond if transitions == "resultant" else slack(beyond)
    after = settle(carrier, beyond.start, seen_from(state, k, staying), target)
    left = np.stack([handed.n[:, list(end.tubes), 2], handed.m[:, list(end.tubes), 2]], axis=2)
    if heirs:
        force, moment = pull(beyond, beyond.start, tube_strains(after), only=heirs)
        left[:, end.tubes.index(0)] -= np.stack(
            [force[..., 2].sum(axis=1), moment[..., 2].sum(axis=1)], axis=1
        )
    return Crossing(after, left.reshape(len(left), -1))


def moved_tendons(section: Section, end: SectionEnd, beyond: Section) -> tuple[int, ...]:
    """Return the tendons (indices in the section beyond) whose host was tube 1 and ended while they go on."""
    ended = {section.tubes[i] for i in end.tubes}
    host_before = {j: section.tubes[i] for j, i in zip(section.tendons, section.hosts, strict=True)}
    return tuple(k for k, j in enumerate(beyond.tendons) if host_before[j] in ended)


def seen_from(state: State, k: TubeStrains, staying: list[int]) -> State:
    """Return the state of the staying tubes with the first of them as tube 1 of the paper."""
    first = staying[0]
    dilation = state.dilation[:, staying]
    return State(
        p=state.p,
        R_1=state.R_1 @ k.R[:, first],
        u_1=k.u[:, first],
        sigma_1=k.sigma[:, first],
        theta=state.theta[:, staying] - state.theta[:, [first]],
        u_d3=state.u_d3[:, staying],
        dilation=(dilation - dilation[:, :1]) / (1.0 + dilation[:, :1]),
    )


def slack(section: Section) -> Section:
    """Return the section without tension: its resultants are the elastic parts."""
    return replace(section, tension=0.0 * section.tension, tension_rate=0.0 * section.tension_rate)


def settle(section: Section, s: float, state: State, target: Array) -> State:
    """Return the state whose strains carry the given resultants (B, 4 + 2n), ordered as in `balance_rows`.

    Newton; the derivative of the resultants by the strains is the published matrix A. Raises BlownUp.
    """
    n = len(section.tubes)
    size = np.concatenate([np.ones(3), np.full(3, 1e-6), np.ones(n - 1), np.full(n - 1, 1e-6)])
    for _ in range(MAX_STEPS):
        k = tube_strains(state)
        excess = balance_rows(resultant(section, s, k), k.R) - target
        step = solve_scaled(section, matrix(section, k, tendon_sums(section, s, k)), excess)
        state = state.with_strains(state.strains - step)
        if np.abs(step / size).max() < SMALL_STEP:
            return state
    raise BlownUp
