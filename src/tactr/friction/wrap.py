"""How much a tendon turns along its path, taken in space, times its coefficient of friction.

Only what turns presses the tendon on its channel: on an element ds with tension lambda the channel bears
lambda |dt/ds| ds, t the tendon's direction in world axes. Between disks the tendon runs straight, and a disk
bears its turn from one span to the next.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tactr import _core
from tactr.friction.chebyshev import (
    DERIVATIVE,
    FIT,
    ORDER,
    WEIGHTS,
    Curve,
    all_points,
    integrals,
    merged,
    terms,
)
from tactr.robot import Robot, Tendon
from tactr.robot.friction import friction_pieces, rubs
from tactr.statics.assemble import tendon_end

WINDING = 1.5  # rad, most by which a routing turns about its tube in one panel


@dataclass(frozen=True, eq=False)
class Wrap:
    """Friction angle of one tendon from its proximal end on: rise, continuous along every piece, and jumps
    (k + 1,) at its edges, which the rise leaves out; both at least 0, rad times the coefficient.

    bend (k, ORDER, 3): Chebyshev coefficients of dt/ds times the coefficient, world axes, 1/m; kinks (k + 1,
    3): change of direction at the edges, likewise.
    """

    rise: Curve
    jumps: np.ndarray
    bend: np.ndarray
    kinks: np.ndarray

    def bend_at(self, sigma: np.ndarray) -> np.ndarray:
        """dt/ds times the coefficient at sigma (n,), (n, 3), 1/m."""
        edges = self.rise.edges
        index = np.clip(np.searchsorted(edges, sigma, side="right") - 1, 0, len(self.bend) - 1)
        x = (2.0 * sigma - (edges[index] + edges[index + 1])) / (edges[index + 1] - edges[index])
        return np.einsum("nb,nbc->nc", terms(x), self.bend[index])

    def kinks_on(self, sigma: np.ndarray) -> np.ndarray:
        """Kinks at the nearest of ascending sigma (n,), (n, 3)."""
        found = np.zeros((len(sigma), 3))
        for k in np.flatnonzero(self.jumps > 0.0):
            found[np.argmin(np.abs(sigma - self.rise.edges[k]))] += self.kinks[k]
        return found

    def total(self) -> float:
        """Up to the tendon's end."""
        last = len(self.rise.coefficients) - 1
        return float(self.rise.on(last, self.rise.edges[-1]) + self.jumps.sum())

    def jump_at(self, sigma: float, gap: float = 1e-9) -> float:
        """The jump at an edge, 0 elsewhere."""
        near = np.abs(self.rise.edges - sigma) <= gap
        return float(self.jumps[near].sum())

    def up_to(self, sigma: np.ndarray) -> np.ndarray:
        """Rise and the jumps before sigma."""
        before = np.concatenate([[0.0], np.cumsum(self.jumps)])
        return self.rise(sigma) + before[np.searchsorted(self.rise.edges, sigma, side="left")]


@dataclass(frozen=True, eq=False)
class Channel:
    """Where one tendon rubs: index in the robot; end sigma, m; joints: places of sigma where something of
    its own changes; friction: pieces (start, coefficient); contacts: sigma of disks, None: all along."""

    index: int
    tube: int
    end: float
    pieces: tuple[tuple[float, float], ...]
    contacts: tuple[float, ...] | None
    routing_cuts: np.ndarray

    @staticmethod
    def of(robot: Robot, j: int) -> Channel:
        tendon, names = robot.tendons[j], [tube.name for tube in robot.tubes]
        end = tendon_end(robot, tendon)
        contacts = None if tendon.contacts is None else tuple(c for c in tendon.contacts if c < end)
        return Channel(
            j,
            names.index(tendon.tube),
            end,
            friction_pieces(tendon.friction),
            contacts,
            _windings(tendon, end),
        )

    def coefficient(self, sigma: float) -> float:
        """Of friction, at sigma; where it changes, the distal one."""
        found = self.pieces[0][1]
        for start, value in self.pieces:
            if start <= sigma + 1e-12:
                found = value
        return found

    @property
    def rubs(self) -> bool:
        """Whether there is any friction."""
        return rubs(self.pieces)

    def joints(self, section_ends: np.ndarray, base: float) -> np.ndarray:
        """Edges between which tension changes smoothly, from 0 to the tendon's end."""
        inside = section_ends - base
        inside = inside[(inside > 1e-9) & (inside < self.end - 1e-9)]
        own = [start for start, _ in self.pieces if 0.0 < start < self.end]
        disks = [] if self.contacts is None else [c for c in self.contacts if c > 0.0]
        if self.contacts is not None:
            inside = np.zeros(0)  # between disks the tension is the same
            own = []
        return merged(np.array([0.0, self.end]), inside, np.array(own), np.array(disks))


def _windings(tendon: Tendon, end: float) -> np.ndarray:
    """Places that cut the routing where it has turned by so much."""
    sigma = np.linspace(0.0, end, 257)
    xy, _ = tendon.routing.evaluate(sigma)
    x, y = xy[..., 0], xy[..., 1]
    turned = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(np.unwrap(np.arctan2(y, x)))))])
    if turned[-1] <= WINDING or not (np.hypot(x, y) > 1e-9).all():
        return np.zeros(0)
    steps = np.arange(1, int(np.ceil(turned[-1] / WINDING))) * WINDING
    return np.interp(steps, turned, sigma)


class Measure:
    """The wraps of several channels in one shape, and how long the tendons are along their path."""

    def __init__(self, channels: Sequence[Channel], prepared: _core.PreparedRobot, translation: np.ndarray):
        self._channels = channels
        self._translation = translation
        self._ends = prepared.section_ends(translation)
        self.joints = [c.joints(self._ends, float(translation[c.tube])) for c in channels]

    def panels(self, fronts: Sequence[np.ndarray]) -> list[np.ndarray]:
        """Edges of the panels in which directions are smooth; fronts: where tensions have corners."""
        return [
            merged(
                joints,
                c.routing_cuts,
                inner(front, c.end),
                inner(self._ends - self._translation[c.tube], c.end),
            )
            for c, joints, front in zip(self._channels, self.joints, fronts, strict=True)
        ]

    def wraps(
        self, prepared: _core.PreparedRobot, solution: _core.Solution, panels: Sequence[np.ndarray]
    ) -> list[Wrap]:
        """Friction angles of all channels."""
        if not self._channels:
            return []
        places = [
            all_points(edges) + self._translation[c.tube]
            for c, edges in zip(self._channels, panels, strict=True)
        ]
        every, back = np.unique(np.concatenate(places), return_inverse=True)
        records = _core.sample(prepared, solution, every)["tendon"]
        found, first = [], 0
        for c, edges, s in zip(self._channels, panels, places, strict=True):
            rows = records[c.index, back[first : first + len(s)]].reshape(len(edges) - 1, ORDER, -1)
            first += len(s)
            make = _along if c.contacts is None else _at_disks
            found.append(make(c, edges, rows[..., 5:8], rows[..., 4]))
        return found


def inner(places: np.ndarray, end: float) -> np.ndarray:
    """Those strictly between 0 and the end."""
    return places[(places > 1e-9) & (places < end - 1e-9)]


def _along(channel: Channel, edges: np.ndarray, t: np.ndarray, rate: np.ndarray) -> Wrap:
    """t: (k, ORDER, 3) directions at the points of every panel."""
    lengths = np.diff(edges)
    slope = np.einsum("ab,kbc->kac", DERIVATIVE, t) * (2.0 / lengths)[:, None, None]
    turning = np.linalg.norm(slope, axis=-1)
    mu = np.array([channel.coefficient(a) for a in edges[:-1]])
    rows, sofar = np.empty_like(turning), 0.0
    for k in range(len(rows)):
        rows[k] = mu[k] * integrals(turning[k], edges[k], edges[k + 1])
        rows[k, 0] += sofar
        sofar = float(np.sum(rows[k]))  # at the panel's end every polynomial is 1
    coefficients = np.einsum("ab,kbc->kac", FIT, t)
    signs = (-1.0) ** np.arange(ORDER)
    before, after = coefficients.sum(axis=1), np.einsum("b,kbc->kc", signs, coefficients)
    kink = _angles(before[:-1], after[1:])
    kink[kink < 1e-5] = 0.0  # the same direction on both sides but for the fit
    jumps = np.concatenate([[0.0], np.maximum(mu[:-1], mu[1:]) * kink, [0.0]])
    kinks = np.zeros((len(edges), 3))
    kinks[1:-1] = np.maximum(mu[:-1], mu[1:])[:, None] * (after[1:] - before[:-1])
    bend = np.einsum("ab,kbc->kac", FIT, slope) * mu[:, None, None]
    return Wrap(Curve(edges, rows), jumps, bend, kinks)


def _at_disks(channel: Channel, edges: np.ndarray, t: np.ndarray, rate: np.ndarray) -> Wrap:
    contacts = np.array(channel.contacts)
    chords = np.einsum("a,ka,kac->kc", 0.5 * WEIGHTS, rate, t) * np.diff(edges)[:, None]
    spans = np.concatenate([[0.0], contacts[contacts > 1e-9], [channel.end]])
    owner = np.searchsorted(spans, 0.5 * (edges[:-1] + edges[1:]), side="right") - 1
    direction = np.array([chords[owner == k].sum(axis=0) for k in range(len(spans) - 1)])
    first = np.einsum("b,bc->c", (-1.0) ** np.arange(ORDER), FIT @ t[0])
    incoming = np.vstack([first, direction[:-1]])
    turns = _angles(incoming, direction)
    jumps, kinks = np.zeros(len(edges)), np.zeros((len(edges), 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    incoming = np.vstack([first / np.linalg.norm(first), direction[:-1]])
    for n, (place, turn) in enumerate(zip(spans[:-1], turns, strict=True)):
        if place > 0.0 or (len(contacts) and contacts[0] <= 1e-9):
            k = int(np.argmin(np.abs(edges - place)))
            jumps[k] += channel.coefficient(place) * turn
            kinks[k] += channel.coefficient(place) * (direction[n] - incoming[n])
    panels = len(edges) - 1
    return Wrap(Curve(edges, np.zeros((panels, ORDER))), jumps, np.zeros((panels, ORDER, 3)), kinks)


def _angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Between rows, rad."""
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.einsum("kc,kc->k", a, b))


def blended(weights: Sequence[float] | np.ndarray, wraps: Sequence[Wrap]) -> Wrap:
    """A weighted sum, on the edges of the last."""
    last = wraps[-1]
    edges = last.rise.edges
    values = sum(w * wrap.rise(all_points(edges)) for w, wrap in zip(weights, wraps, strict=True))
    jumps = sum(
        w * np.array([wrap.jump_at(edge) for edge in edges]) for w, wrap in zip(weights, wraps, strict=True)
    )
    return Wrap(
        Curve.through(edges, np.asarray(values).reshape(-1, ORDER)),
        np.maximum(jumps, 0.0),
        last.bend,
        last.kinks,
    )
