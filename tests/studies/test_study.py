"""What a study describes: its configurations, by number; and what cannot be one."""

import numpy as np
import pytest

from tactr import RobotError, examples
from tactr.studies import InsertionOrder, Range, Samples, Study, Values

ROBOT = examples.load("three_tube_ctr")
TURN = Range("tubes.inner.rotation", 0.0, 1.0)


def test_values_are_combined_like_a_table_and_samples_repeat_at_each():
    study = Study(
        examples.load("two_tube_90"),
        [
            Values("tendons.outer.tension", [1.0, 2.0]),
            Range("tendons.inner.tension", 0.0, 4.0),
            Values("tubes.inner.material.E", [60e9, 120e9, 215e9]),
        ],
        samples=Samples(5),
    )
    assert study.count == 30
    inputs = study.inputs(0, 30)
    assert np.array_equal(inputs[:, 0], np.repeat([1.0, 2.0], 15))
    assert np.array_equal(inputs[:, 2], np.tile(np.repeat([60e9, 120e9, 215e9], 5), 2))
    assert np.array_equal(inputs[:, 1], np.tile(inputs[:5, 1], 6))
    assert len(set(inputs[:5, 1])) == 5
    assert np.array_equal(study.inputs(3, 22), inputs[3:22])


def test_a_grid_has_no_samples():
    study = Study(ROBOT, [Values("tubes.inner.rotation", [0, 1]), Values("tubes.outer.rotation", [2, 3, 4])])
    assert study.inputs(0, 6).tolist() == [[0, 2], [0, 3], [0, 4], [1, 2], [1, 3], [1, 4]]


def test_insertions_meet_the_rules(insertion_study):
    inputs = insertion_study.inputs(0, 200)
    translation, lengths = inputs[:, 1:], np.array([0.199, 0.3305, 0.463])
    assert (translation[:, :-1] - translation[:, 1:] >= 0.01).all()
    assert (np.diff(translation + lengths, axis=1) >= -1e-15).all()
    low, high = (
        np.array([getattr(axis, end) for axis in insertion_study.vary[1:]]) for end in ("low", "high")
    )
    assert ((translation >= low) & (translation <= high)).all()
    assert np.ptp(translation, axis=0) == pytest.approx(high - low, rel=0.25)


def test_a_tube_that_stays_bounds_its_neighbours():
    """The middle tube stays at -200 mm, its tip at 130.5 mm."""
    study = Study(
        ROBOT,
        [Range("tubes.outer.translation", -0.19, 0.0), Range("tubes.inner.translation", -0.46, 0.0)],
        samples=Samples(2000, method="random"),
        insertion=InsertionOrder(exposed=0.005, carriages=0.02),
    )
    outer, inner = study.inputs(0, 2000).T
    assert outer.min() == pytest.approx(-0.18, abs=1e-3)  # 20 mm before the middle one
    assert outer.max() == pytest.approx(0.1255 - 0.199, abs=1e-3)  # 5 mm less exposed
    assert inner.max() == pytest.approx(-0.22, abs=1e-3)
    assert inner.min() == pytest.approx(0.1355 - 0.463, abs=1e-3)


def test_chunks_cover_everything_once(insertion_study):
    spans = [insertion_study.span(chunk) for chunk in range(insertion_study.chunks)]
    assert spans == [(0, 64), (64, 128), (128, 192), (192, 200)]
    large = Study(ROBOT, [TURN], samples=Samples(10**9))
    assert large.chunks <= 4096
    assert large.span(large.chunks - 1)[1] == 10**9


def test_the_identity_tells_studies_apart(insertion_study):
    def other(**changes):
        given = {"vary": [TURN], "samples": Samples(10), **changes}
        return Study(given.pop("robot", ROBOT), given.pop("vary"), **given).identity

    same = other()
    assert other() == same
    assert other(name="x") != same
    assert other(samples=Samples(10, seed=1)) != same
    assert other(vary=[Range("tubes.inner.rotation", 0.0, 1.5)]) != same
    assert other(robot=ROBOT.replace(name="other")) != same
    assert other(outputs=["tip"]) != same


@pytest.mark.parametrize(
    ("vary", "options", "field", "words"),
    [
        ([], {}, "vary", "nothing varies"),
        ([TURN], {}, "samples", "no number of samples"),
        ([Values("tubes.inner.rotation", [1.0])], {"samples": Samples(3)}, "samples", "nothing has a range"),
        ([TURN, TURN], {"samples": Samples(3)}, "vary[1].path", "varies together with"),
        ([Range("tubes.iner.rotation", 0, 1)], {"samples": Samples(3)}, "vary[0].path", "iner"),
        ([Range("tubes.inner.translation", -1, 0)], {"samples": Samples(3)}, "vary[0].low", "outside"),
        ([Range("tubes.inner.translation", -0.1, 0.1)], {"samples": Samples(3)}, "vary[0].high", "too large"),
        ([Values("tubes.inner.material.E", [1e9, -1])], {}, "vary[0].values[1]", "too small"),
        ([TURN], {"samples": Samples(3), "outputs": ["tp"]}, "outputs[0]", "'tp' is not known"),
        ([TURN], {"samples": Samples(3), "chunk": 0}, "chunk", "found 0"),
        ([TURN], {"samples": Samples(3), "insertion": InsertionOrder(exposed=0)}, "insertion", "no trans"),
    ],
)  # fmt: skip
def test_what_cannot_be_a_study(vary, options, field, words):
    with pytest.raises(RobotError) as caught:
        Study(ROBOT, vary, **options)
    assert caught.value.field == field
    assert words in str(caught.value)


def test_rules_that_nothing_meets():
    with pytest.raises(RobotError, match="no translations of 'outer', 'middle' meet them"):
        Study(
            ROBOT,
            [Range("tubes.outer.translation", -0.1, -0.05), Range("tubes.middle.translation", -0.3, -0.2)],
            samples=Samples(3),
            insertion=InsertionOrder(carriages=0.26),
        )


def test_a_tendon_is_pulled_in_one_way():
    robot = examples.load("two_tube_90")
    both = [Range("tendons.outer.tension", 0, 1), Range("tendons.outer.displacement", 0, 1e-3)]
    with pytest.raises(RobotError, match=r"tendons\.outer\.tension"):
        Study(robot, both, samples=Samples(3))


@pytest.mark.parametrize(
    "make",
    [
        lambda: Range("a", 1.0, 1.0),
        lambda: Samples(0),
        lambda: Samples(5, seed=-1),
        lambda: Samples(5, method="sobl"),
        lambda: Values("a", []),
        lambda: InsertionOrder(),
    ],
)
def test_parts_are_checked(make):
    with pytest.raises(RobotError):
        make()
