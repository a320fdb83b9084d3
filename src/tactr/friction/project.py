"""The quasi-static step of Coulomb friction along one tendon.

With y = log(tension) and the friction angle Phi (wrap angle times coefficient) the cone |T'| <= mu T |dt/ds|
is |y'| <= Phi'. From the base on, where y is given, y keeps the old profile where the cone allows it, and
otherwise slides along the cone towards it. For an old profile inside the new cone that is its projection on
[y0 - Phi, y0 + Phi], a play operator in y0; where the tendon has become straighter than the old profile
needs, it slides as well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tactr.friction.chebyshev import ORDER, Curve, merged, points
from tactr.friction.wrap import Wrap

NOISE = 1e-9  # of log tension: what the cone may be missed by before the tendon is taken to slide
NO_TENSION = -1e4  # as a log tension: nothing comes down to it
LOOKS = 33  # places at which a cell is looked at


@dataclass(frozen=True, eq=False)
class Profile:
    """Logarithm of the tension along one tendon, N; slides: -1, 0 or 1 for every piece, towards the base,
    stuck, towards the end; driven: whether the piece follows the tension at the base."""

    log: Curve
    slides: tuple[int, ...]
    driven: tuple[bool, ...]

    def tension(self, sigma: np.ndarray) -> np.ndarray:
        """N, at sigma (n,), m."""
        return np.exp(self.log(sigma))

    @staticmethod
    def even(tension: float, end: float) -> Profile:
        """The same tension, N, above 0, all along."""
        return Profile(_constant(float(np.log(tension)), end), (0,), (False,))


@dataclass
class _Run:
    start: float
    slide: int
    y: float  # at the start
    driven: bool


def project(old: Curve | None, y0: float, wrap: Wrap, joints: np.ndarray) -> Profile:
    """The new profile: old (None: no tension so far), y0: log tension at the base; joints: edges between
    which the wrap is smooth."""
    if old is None:
        old = _constant(NO_TENSION, wrap.rise.edges[-1])
    return _Walk(old, wrap, y0).profile(joints)


def _constant(y: float, end: float) -> Curve:
    coefficients = np.zeros((1, ORDER))
    coefficients[0, 0] = y
    return Curve(np.array([0.0, end]), coefficients)


class _Walk:
    """From the base to the end, cell by cell between edges of the old profile and of the wrap."""

    def __init__(self, old: Curve, wrap: Wrap, y0: float) -> None:
        self._old, self._wrap = old, wrap
        self._cells = merged(old.edges, wrap.rise.edges)
        self._runs: list[_Run] = []
        self._y, self._driven = y0, True

    def profile(self, joints: np.ndarray) -> Profile:
        for a, b in zip(self._cells[:-1], self._cells[1:], strict=True):
            self._cross(a, b)
        return _pieces(self._runs, self._old, self._wrap, joints)

    def _cross(self, a: float, b: float) -> None:
        middle = 0.5 * (a + b)
        i, j = self._old.piece(middle), self._wrap.rise.piece(middle)
        kept, rise = (lambda s: self._old.on(i, s)), (lambda s: self._wrap.rise.on(j, s))
        target, jump = float(kept(a)), self._wrap.jump_at(a)
        if jump > 0.0:
            before = self._y
            self._y = min(max(target, before - jump), before + jump)
            if abs(self._y - target) <= 1e-13:
                self._driven = False
            self._runs.append(
                _Run(a, 0 if not self._driven else int(np.sign(self._y - before)), self._y, self._driven)
            )
        place = a
        for _ in range(8):
            if place >= b:
                return
            difference = self._y - float(kept(place))
            if abs(difference) <= NOISE:
                place = self._stay(place, b, kept, rise)
            else:
                place = self._slide(place, b, -1 if difference > 0.0 else 1, kept, rise)
        if place < b:  # so many turns within one cell are noise
            self._driven, self._y = False, float(kept(place))
            self._begin(place, 0)
            self._y = float(kept(b))

    def _slide(self, a, b, way, kept, rise) -> float:
        self._begin(a, way)
        run_y, start = self._y, float(rise(a))

        def beyond(s):
            return way * (kept(s) - (run_y + way * (rise(s) - start)))

        looks = np.linspace(a, b, LOOKS)
        met = np.flatnonzero(beyond(looks[1:]) <= 0.0)
        if len(met) == 0:
            self._y = run_y + way * (float(rise(b)) - start)
            return b
        x = _root(beyond, looks[met[0]], looks[met[0] + 1])
        self._y, self._driven = float(kept(x)), False
        if b - x <= 1e-9:
            self._y = float(kept(b))
            return b
        self._begin(x, 0)
        return x

    def _stay(self, a, b, kept, rise) -> float:
        """Up to b, or to where the old profile falls or rises faster than friction holds."""
        looks = np.linspace(a, b, LOOKS)
        y, phi = kept(looks), rise(looks)
        for way in (-1, 1):
            g = way * y - phi  # falls where the cone holds
            over = g - np.minimum.accumulate(g)
            bad = np.flatnonzero(over > 10.0 * NOISE)
            if len(bad):
                first = int(np.argmin(g[: bad[0] + 1]))
                x = _least(
                    lambda s, way=way: way * kept(s) - rise(s), looks[max(first - 1, 0)], looks[first + 1]
                )
                x = max(x, a)
                self._driven = False
                if x > a + 1e-9:
                    self._begin(a, 0)
                else:
                    x = a
                self._y = float(kept(x))
                return self._slip(x, b, way, kept, rise)
        self._driven = False
        self._begin(a, 0)
        self._y = float(kept(b))
        return b

    def _slip(self, a, b, way, kept, rise) -> float:
        """Sliding at the limit from where the old profile leaves the cone, until it is met again."""
        self._begin(a, way)
        start, y = float(rise(a)), self._y
        looks = np.linspace(a, b, LOOKS)
        ahead = way * (kept(looks) - (y + way * (rise(looks) - start)))
        lost = np.flatnonzero(ahead[1:] > NOISE)
        met = np.flatnonzero(ahead[1:] <= 0.0)
        met = met[met > lost[0]] if len(lost) else met[:0]
        if len(met) == 0:
            self._y = y + way * (float(rise(b)) - start)
            return b
        x = _root(lambda s: way * (kept(s) - (y + way * (rise(s) - start))), looks[met[0]], looks[met[0] + 1])
        self._y = float(kept(x))
        if x < b - 1e-9:
            self._begin(x, 0)
        return x if x < b - 1e-9 else b

    def _begin(self, place: float, slide: int) -> None:
        if self._runs and self._runs[-1].slide == slide:
            return
        self._runs.append(_Run(place, slide, self._y, self._driven))


def _root(f, a: float, b: float) -> float:
    """Where f falls through 0 between a and b: regula falsi of the Illinois kind."""
    fa, fb = float(f(a)), float(f(b))
    if fa <= 0.0:
        return a
    for _ in range(60):
        x = (a * fb - b * fa) / (fb - fa)
        fx = float(f(x))
        if abs(fx) < 1e-14 or b - a < 1e-13:
            return x
        if fx > 0.0:
            a, fa, fb = x, fx, 0.5 * fb
        else:
            b, fb, fa = x, fx, 0.5 * fa
    return x


def _least(f, a: float, b: float) -> float:
    """Where f is least between a and b: golden sections."""
    ratio = 0.5 * (np.sqrt(5.0) - 1.0)
    for _ in range(40):
        c, d = b - ratio * (b - a), a + ratio * (b - a)
        a, b = (a, d) if float(f(c)) < float(f(d)) else (c, b)
    return 0.5 * (a + b)


def _pieces(runs: list[_Run], old: Curve, wrap: Wrap, joints: np.ndarray) -> Profile:
    """Runs as polynomials: cut at joints where it slides, at the old edges where it is stuck."""
    end = joints[-1]
    edges, values, slides, driven = [runs[0].start], [], [], []
    for k, run in enumerate(runs):
        stop = runs[k + 1].start if k + 1 < len(runs) else end
        if stop - run.start <= 1e-9:
            if k + 1 < len(runs):
                continue
            break
        cuts = joints if run.slide != 0 else old.edges
        inside = cuts[(cuts > run.start + 1e-9) & (cuts < stop - 1e-9)]
        if run.slide != 0:
            base = float(wrap.rise.on(wrap.rise.piece(run.start + 1e-12), run.start))
        for a, b in zip([run.start, *inside], [*inside, stop], strict=True):
            sigma = points(a, b)
            if run.slide == 0:
                y = old.on(old.piece(0.5 * (a + b)), sigma)
            else:
                y = run.y + run.slide * (wrap.rise(sigma) - base)
            values.append(y)
            edges.append(b)
            slides.append(run.slide)
            driven.append(run.driven)
    curve = Curve.through(np.array(edges), np.array(values).reshape(-1, ORDER))
    return Profile(curve, tuple(slides), tuple(driven))
