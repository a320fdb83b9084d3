"""A study: a robot, what of it varies, how that is sampled, and what is kept of every shape."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import KW_ONLY, asdict, dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tactr.errors import RobotError
from tactr.robot import Robot
from tactr.robot import _check as check
from tactr.studies.axes import MOST_SAMPLES, Axis, Range, Samples, Values, actuator, check_axis, whole
from tactr.studies.insertion import InsertionOrder, Segment, segments

OUTPUTS = ("tip", "stability", "jacobian", "compliance", "energy", "shape", "strain")
LEAST_CHUNK, MOST_CHUNKS = 2048, 4096


@dataclass(frozen=True)
class Study:
    """A robot at many configurations: every combination of the ``Values``, and at each the same samples of
    the ``Range``s.

    vary: numbers of the robot that change, each once: actuators ("tubes.NAME.rotation", "translation";
    "tendons.NAME.tension", "displacement") or anything else (paths as in ``Shape.sensitivity``), SI units;
    all else stays as the robot has it. samples: of the ranges, needed where there is one. insertion: rules
    between translations. outputs: what is kept, of OUTPUTS. stations: of the output "shape". tolerance: m, as
    in ``tactr.solve``. chunk: configurations solved and stored at a time. The Values' order is that of a
    table, the first changing slowest; samples change fastest. Raises RobotError.
    """

    robot: Robot
    vary: tuple[Axis, ...]
    _: KW_ONLY
    samples: Samples | None = None
    insertion: InsertionOrder | None = None
    outputs: tuple[str, ...] = ("tip", "stability")
    stations: int = 21
    tolerance: float = 1e-6
    chunk: int | None = None
    name: str = ""
    source: str = field(default="", compare=False, repr=False)

    if TYPE_CHECKING:  # any sequences are taken; tuples are stored

        def __init__(
            self,
            robot: Robot,
            vary: Sequence[Axis],
            *,
            samples: Samples | None = None,
            insertion: InsertionOrder | None = None,
            outputs: Sequence[str] = ("tip", "stability"),
            stations: int = 21,
            tolerance: float = 1e-6,
            chunk: int | None = None,
            name: str = "",
            source: str = "",
        ) -> None: ...

    def __post_init__(self) -> None:
        check.store(self, name=check.name("name", self.name, empty=True))
        check.store(self, vary=check.instances("vary", self.vary, (Range, Values), "Range or Values objects"))
        check.store(self, outputs=check.instances("outputs", self.outputs, str, "texts"))
        check.store(self, tolerance=check.real("tolerance", self.tolerance, "m", above=0))
        for k, output in enumerate(self.outputs):
            check.choice(f"outputs[{k}]", output, OUTPUTS)
        whole("stations", self.stations, 2, 10_000)
        if self.chunk is not None:
            whole("chunk", self.chunk, 1, 10_000_000)
        self._check_vary()
        self._check_samples()
        if self.insertion is not None:
            self._check_insertion(self.insertion)

    def __repr__(self) -> str:
        varied = ", ".join(axis.path for axis in self.vary)
        return (
            f"<Study {self.name!r}: {self.count} configurations of {self.robot.name or 'a robot'}: {varied}>"
        )

    @property
    def ranges(self) -> tuple[Range, ...]:
        """What is sampled."""
        return tuple(axis for axis in self.vary if isinstance(axis, Range))

    @property
    def grid(self) -> tuple[int, ...]:
        """Numbers of values of what is not sampled."""
        return tuple(len(axis.values) for axis in self.vary if isinstance(axis, Values))

    @property
    def count(self) -> int:
        """Number of configurations."""
        return math.prod(self.grid) * self.samples_each

    @property
    def chunk_size(self) -> int:
        """Configurations in a chunk."""
        return self.chunk or max(LEAST_CHUNK, -(-self.count // MOST_CHUNKS))

    @property
    def chunks(self) -> int:
        """Number of chunks; the last one may be shorter."""
        return -(-self.count // self.chunk_size)

    def span(self, chunk: int) -> tuple[int, int]:
        """First configuration of a chunk, and the first one after it."""
        return chunk * self.chunk_size, min((chunk + 1) * self.chunk_size, self.count)

    def inputs(self, start: int, stop: int) -> np.ndarray:
        """What varies of the configurations start to stop, (stop - start, vary), SI units: it depends on the
        study and the configurations' numbers alone."""
        from tactr.studies.sampling import inputs

        return inputs(self, start, stop)

    @cached_property
    def text(self) -> str:
        """All that the configurations and their results depend on, but the robot, as JSON."""
        plain = {
            **{key: getattr(self, key) for key in ("name", "outputs", "stations", "tolerance")},
            "vary": [asdict(axis) for axis in self.vary],
            "samples": None if self.samples is None else asdict(self.samples),
            "insertion": None if self.insertion is None else asdict(self.insertion),
            "chunk": self.chunk_size,
        }
        return json.dumps(plain)

    @cached_property
    def robot_text(self) -> str:
        """The robot as the text of a robot file. Raises RobotError for what a file cannot hold."""
        from tactr.io import dumps

        return dumps(self.robot)

    @cached_property
    def identity(self) -> str:
        """Of study and robot: a digest, the same wherever it is made."""
        return hashlib.sha256(f"{self.text}\n{self.robot_text}".encode()).hexdigest()

    @property
    def samples_each(self) -> int:
        """Samples at every combination of the Values."""
        return 1 if self.samples is None else self.samples.count

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """Translations that are sampled together, by the rules of insertion."""
        if self.insertion is None:
            return ()
        return segments(
            self.robot, self.insertion, {i: axis.ends for i, axis in self._translations().items()}
        )

    def _translations(self) -> dict[int, Axis]:
        places = [(actuator(self.robot, axis.path), axis) for axis in self.vary]
        return {place[1]: axis for place, axis in places if place and place[0] == "translation"}

    def _check_vary(self) -> None:
        if not self.vary:
            raise RobotError("vary", "nothing varies", "at least one Range or Values")
        seen: dict[object, str] = {}
        for k, axis in enumerate(self.vary):
            with _placed(f"vary[{k}]"):
                check_axis(self.robot, axis)
                place = actuator(self.robot, axis.path)
                pulled = place is not None and place[0] in ("tension", "displacement")
                what = ("tendon", place[1]) if place and pulled else axis.path
                if what in seen:
                    problem = f"varies together with {seen[what]}"
                    expected = "each number once, and a tendon by its tension or its displacement"
                    raise RobotError("path", problem, expected, value=axis.path)
                seen[what] = axis.path

    def _check_samples(self) -> None:
        if self.ranges and self.samples is None:
            path = self.ranges[0].path
            raise RobotError(
                "samples", f"{path} has a range, but no number of samples is given", "such as Samples(1000)"
            )
        if self.samples is not None and not self.ranges:
            raise RobotError("samples", "nothing has a range to be sampled", "no samples, or a Range")
        if self.count > MOST_SAMPLES * 64:
            raise RobotError("vary", f"{self.count} configurations", f"at most {MOST_SAMPLES * 64}")

    def _check_insertion(self, rules: InsertionOrder) -> None:
        translations = self._translations()
        if not translations:
            raise RobotError("insertion", "no translation varies", "a range of a tube's translation")
        lengths = [f"tubes.{tube.name}.length" for tube in self.robot.tubes]
        for k, axis in enumerate(self.vary):
            if isinstance(axis, Values) and axis in translations.values():
                problem = "a translation under rules of insertion has a list of values"
                raise RobotError(f"vary[{k}].values", problem, "a range")
            if rules.exposed is not None and axis.path in lengths:
                problem = f"{axis.path} varies, and decides what is exposed"
                raise RobotError(f"vary[{k}].path", problem, "a length that is kept, or no rule exposed")
        _ = self.segments


@contextmanager
def _placed(place: str) -> Iterator[None]:
    try:
        yield
    except RobotError as error:
        raise error.under(place) from None
