"""Where tendons rub, as the kernel takes it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from tactr.robot import Robot, Routing
from tactr.robot.friction import FrictionPieces, friction_pieces, rubs
from tactr.statics.assemble import tendon_end

WINDING = 1.5  # rad, most by which a routing turns about its tube where directions are fitted at once


@dataclass(frozen=True)
class Channel:
    """Where one tendon rubs: index in the robot; end sigma, m; friction: pieces (start, coefficient);
    contacts: sigma of disks, None: all along; cuts: sigma between which its routing turns by less than
    WINDING."""

    index: int
    tube: int
    end: float
    pieces: FrictionPieces
    contacts: tuple[float, ...] | None
    cuts: tuple[float, ...]

    @staticmethod
    def of(robot: Robot, j: int) -> Channel:
        tendon, names = robot.tendons[j], [tube.name for tube in robot.tubes]
        end = tendon_end(robot, tendon)
        contacts = None if tendon.contacts is None else tuple(c for c in tendon.contacts if c < end)
        pieces = friction_pieces(tendon.friction)
        return Channel(j, names.index(tendon.tube), end, pieces, contacts, _windings(tendon.routing, end))

    @property
    def row(self) -> tuple[int, int, float, list, list | None, list]:
        """For the kernel."""
        contacts = None if self.contacts is None else list(self.contacts)
        return self.index, self.tube, self.end, list(self.pieces), contacts, list(self.cuts)


def channels(robot: Robot) -> list[Channel]:
    """Of all tendons with friction, in the robot's order."""
    return [Channel.of(robot, j) for j, tendon in enumerate(robot.tendons) if rubs(tendon.friction)]


@lru_cache(maxsize=512)
def _windings(routing: Routing, end: float) -> tuple[float, ...]:
    """Places that cut the routing where it has turned by so much. Kept: one robot is driven many times."""
    sigma = np.linspace(0.0, end, 257)
    xy, _ = routing.evaluate(sigma)
    x, y = xy[..., 0], xy[..., 1]
    turned = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(np.unwrap(np.arctan2(y, x)))))])
    if turned[-1] <= WINDING or not (np.hypot(x, y) > 1e-9).all():
        return ()
    steps = np.arange(1, int(np.ceil(turned[-1] / WINDING))) * WINDING
    return tuple(np.interp(steps, turned, sigma).tolist())
