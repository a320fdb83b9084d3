"""Heat of friction: force on the channel times how far the tendon slips along it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tactr import _core
from tactr.friction.chebyshev import (
    DERIVATIVE,
    FIT,
    INTEGRAL,
    ORDER,
    POINTS,
    WEIGHTS,
    all_points,
    merged,
    points,
)
from tactr.friction.equilibrium import Settled
from tactr.friction.project import Profile
from tactr.friction.wrap import Channel, inner


def heat(
    channels: Sequence[Channel],
    before: tuple[Settled, np.ndarray],
    after: tuple[Settled, np.ndarray],
) -> tuple[np.ndarray, np.ndarray]:
    """Of one step, by channel: heat, J, and the largest slip where the tendon counts as stuck, m.

    before, after: an equilibrium and the translations (tubes,) of its tubes. The tendon's end does not slip;
    a place slips by what the path beyond it has become shorter. Friction is the fall of tension along the
    tendon: its mean over the step where it points the same way before and after, otherwise that after, for
    it turns round before there is slip.
    """
    found, crept = np.zeros(len(channels)), np.zeros(len(channels))
    for k, c in enumerate(channels):
        profiles = [settled.profiles[k] for settled, _ in (before, after)]
        fronts = [inner(p.log.edges, c.end) for p in profiles if p is not None]
        cuts = [inner(w.rise.edges, c.end) for w in (before[0].wraps[k], after[0].wraps[k])]
        edges = merged(np.array([0.0, c.end]), *fronts, *cuts)
        rates = [_rates(c, settled, translation, edges) for settled, translation in (before, after)]
        shorter, half = rates[0] - rates[1], 0.5 * np.diff(edges)
        whole = (shorter @ WEIGHTS) * half
        beyond = np.append(np.cumsum(whole[::-1])[::-1], 0.0)
        slip = beyond[:-1, None] - (shorter @ _INSIDE.T) * half[:, None]
        falls = [_falls(p, edges) for p in profiles]
        along = _rubbing(falls[0][0], falls[1][0]) * slip
        at_edges = _rubbing(falls[0][1], falls[1][1]) * beyond[:-1]
        found[k] = float((along @ WEIGHTS) @ half + at_edges.sum())
        crept[k] = _creep(profiles[1], edges, beyond)
    return found, crept


_INSIDE = np.polynomial.chebyshev.chebvander(POINTS, ORDER) @ INTEGRAL @ FIT
"""From values at the points to integrals from -1 up to them."""


def _rubbing(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    return np.where(before * after > 0.0, 0.5 * (before + after), after)


def _falls(profile: Profile | None, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of the tension: along every panel at its points, N/m, and at its proximal edge, N."""
    panels = len(edges) - 1
    if profile is None:
        return np.zeros((panels, ORDER)), np.zeros(panels)
    pieces = [profile.log.piece(float(middle)) for middle in 0.5 * (edges[:-1] + edges[1:])]
    spans = list(zip(pieces, edges[:-1], edges[1:], strict=True))
    tension = np.array([np.exp(profile.log.on(k, points(a, b))) for k, a, b in spans])
    along = -(tension @ DERIVATIVE.T) * (2.0 / np.diff(edges))[:, None]
    starts = np.exp([float(profile.log.on(k, a)) for k, a, _ in spans])
    ends = np.exp([float(profile.log.on(k, b)) for k, _, b in spans])
    return along, np.append(0.0, ends[:-1] - starts[1:])


def _creep(profile: Profile | None, edges: np.ndarray, slip: np.ndarray) -> float:
    """Largest slip at the edges of panels where the tension was left as it was."""
    if profile is None:
        return 0.0
    stuck = [profile.slides[profile.log.piece(a + 1e-10)] == 0 for a in edges[:-1]]
    return max((abs(float(x)) for x, held in zip(slip[:-1], stuck, strict=True) if held), default=0.0)


def _rates(channel: Channel, settled: Settled, translation: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Length of the tendon per length of its tube at the points of every panel, (k, ORDER)."""
    s = all_points(edges) + translation[channel.tube]
    return _core.sample(settled.core, settled.solution, s)["tendon"][channel.index][:, 4].reshape(-1, ORDER)
