"""Study files: what they say, and every mistake with its line."""

import json
from math import pi
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from ruamel.yaml import YAML

from tactr import FileError, examples
from tactr.studies import InsertionOrder, Range, Samples, Values, load_study
from tactr.studies.layout import json_schema

EXAMPLES = sorted((Path(__file__).parents[2] / "examples" / "studies").glob("*.yaml"))

GOOD = """\
name: a study
robot: three_tube_ctr
vary:
  - {path: tubes.inner.rotation, from: -90 deg, to: 90 deg}
  - {path: tubes.inner.translation, from: -400 mm, to: -300 mm}
  - {path: tubes.middle.translation, from: -250 mm, to: -150 mm}
  - {path: tubes.outer.material.E, from: 50 GPa, to: 60 GPa, points: 3}
  - {path: tubes.outer.rotation, values: [0, 1 rad]}
samples: {count: 10, method: latin_hypercube, seed: 7}
insertion: {carriages: 10 mm}
outputs: [tip, energy]
tolerance: 0.01 mm
chunk: 5
"""


def write(folder, text, name="study.yaml"):
    path = folder / name
    path.write_text(text)
    return path


def test_a_whole_file(tmp_path):
    study = load_study(write(tmp_path, GOOD))
    assert study.robot == examples.load("three_tube_ctr")
    assert study.vary == (
        Range("tubes.inner.rotation", -pi / 2, pi / 2),
        Range("tubes.inner.translation", -0.4, -0.3),
        Range("tubes.middle.translation", -0.25, -0.15),
        Values("tubes.outer.material.E", [50e9, 55e9, 60e9]),
        Values("tubes.outer.rotation", [0.0, 1.0]),
    )
    assert study.samples == Samples(10, method="latin_hypercube", seed=7)
    assert study.insertion == InsertionOrder(carriages=0.01)
    assert (study.outputs, study.tolerance, study.chunk, study.count) == (("tip", "energy"), 1e-5, 5, 60)
    assert study.source == GOOD


def test_toml_and_a_robot_file_beside_it(tmp_path):
    (tmp_path / "mine.yaml").write_text(examples.path("two_tube_0").read_text())
    text = 'robot = "mine.yaml"\n[[vary]]\npath = "tendons.outer.tension"\nvalues = ["1 N", "2 N"]\n'
    study = load_study(write(tmp_path, text, "study.toml"))
    assert study.robot == examples.load("two_tube_0")
    assert study.count == 2


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_load_and_fit_the_schema(path):
    assert load_study(path).count > 100
    Draft202012Validator.check_schema(json_schema())
    Draft202012Validator(json_schema()).validate(YAML(typ="safe").load(path.read_text()))


def test_the_schema_refuses_what_the_reader_refuses():
    check = Draft202012Validator(json_schema())
    good = json.loads(json.dumps(YAML(typ="safe").load(GOOD)))
    assert check.is_valid(good)
    for change in (
        {"robt": 1},
        {"samples": {"count": 0}},
        {"vary": [{"path": "x", "from": 1}]},
        {"chunk": "5"},
    ):
        assert not check.is_valid({**good, **change})


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("from: -90 deg", "from: -90 mm", ':4: vary[0].from: "-90 mm" is a length; expected an angle'),
        ("from: -90 deg, ", "", ":4: vary[0]: has to; expected either from and to (sampled)"),
        ("inner.rotation", "iner.rotation", ":4: vary[0].path: tubes has no 'iner'"),
        ("inner.rotation", "inner.rotaton", ":4: vary[0].path: tubes.inner has no 'rotaton'"),
        ("inner.rotation", "inner", "is not a number; expected a further step, one of name, length"),
        ("to: 90 deg", "to: -91 deg", ':4: vary[0].to: "-91 deg" is not above "-90 deg"'),
        ("to: -300 mm", "to: 5 mm", ":5: vary[1].to: 0.005 m is too large"),
        ("count: 10", "count: ten", ':9: samples.count: found "ten"; expected a whole number'),
        ("seed:", "sed:", ":9: samples.sed: is not a known key (did you mean seed?)"),
        ("latin_hypercube", "latin", ':9: samples.method: "latin" is not known'),
        ("carriages: 10 mm", "carriages: 10", ":10: insertion.carriages: 10 has no unit"),
        ("carriages: 10 mm", "carriages: 900 mm", ":10: insertion: the rules cannot be met"),
        ("[tip, energy]", "[tip, enrgy]", ':11: outputs[1]: "enrgy" is not known (did you mean energy?)'),
        ("three_tube_ctr", "three_tube_cr", ":2: robot: there is no example 'three_tube_cr' (did you mean"),
        ("three_tube_ctr", "robots/mine.yaml", ":2: robot: there is no file 'robots/mine.yaml'"),
        ("samples: {count: 10, method: latin_hypercube, seed: 7}\n", "", "samples: tubes.inner.rotation has"),
    ],
)  # fmt: skip
def test_mistakes_are_named_with_their_line(tmp_path, old, new, told):
    assert old in GOOD
    path = write(tmp_path, GOOD.replace(old, new))
    with pytest.raises(FileError) as caught:
        load_study(path)
    assert str(caught.value).startswith(str(path))
    assert told in str(caught.value)


def test_broken_rules_of_tubes_that_stay_are_told_with_their_numbers(tmp_path):
    text = GOOD.replace("  - {path: tubes.middle.translation, from: -250 mm, to: -150 mm}\n", "")
    for rule, told in (
        ("exposed: 500 mm", "'middle' reaches 0.0"),
        ("carriages: 300 mm", "behind 'outer', both stay there, and it must be at least 0.3 m"),
    ):
        with pytest.raises(FileError) as caught:
            load_study(write(tmp_path, text.replace("carriages: 10 mm", rule)))
        assert told in str(caught.value)


def test_a_whole_number_may_be_written_with_an_exponent(tmp_path):
    assert load_study(write(tmp_path, GOOD.replace("count: 10", "count: 1e3"))).samples == Samples(
        1000, method="latin_hypercube", seed=7
    )


@pytest.mark.parametrize("text", ["", "robot: [", "x", "- 1", "\0"])
def test_what_is_no_study_at_all(tmp_path, text):
    with pytest.raises(FileError):
        load_study(write(tmp_path, text))


def test_a_wrong_robot_file_names_itself(tmp_path):
    write(tmp_path, "tubes: []\n", "mine.yaml")
    with pytest.raises(FileError, match=r"mine\.yaml"):
        load_study(write(tmp_path, GOOD.replace("three_tube_ctr", "mine.yaml")))
