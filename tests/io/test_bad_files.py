"""Every mistake in a robot file is reported: its line and field, what was found, what would be right."""

import math

import pytest

import tactr
from tactr.io import RobotFileError, load, loads

GOOD = """\
name: demo
tubes:
  - name: outer
    length: 140 mm
    outer_diameter: 1 mm
    inner_diameter: 0.8 mm
    material: nitinol
    precurvature:
      - {from: 0 mm, u: [0, 0, 0]}
      - {from: 60 mm, u: [10 1/m, 0, 0]}
  - name: inner
    length: 180 mm
    outer_diameter: 0.7 mm
    inner_diameter: 0.4 mm
    material: {E: 215 GPa, nu: 0.3, density: 7900 kg/m^3}
    rotation: 30 deg
tendons:
  - name: first
    tube: outer
    routing: {kind: straight, x: 0 mm, y: 6.5 mm}
    tension: 3 N
  - name: second
    tube: inner
    host: outermost
    routing: {kind: helix, radius: 6.5 mm, rate: 0.5 deg/mm, phase: 310 deg}
    tension: {sigma: [0, 180 mm], values: [2 N, 1 N]}
loads:
  - {kind: point, tube: inner, force: [0.1 N, 0, 0]}
"""

CASES = {
    "unknown key": (
        ("length: 140 mm", "lenght: 140 mm"),
        [
            (4, "tubes[0].lenght", "is not a known key (did you mean length?)", "one of name, length"),
            (3, "tubes[0].length", "is missing", "length of the whole tube"),
        ],
    ),
    "missing unit": (
        ("140 mm", "140"),
        [(4, "tubes[0].length", "140 has no unit", 'a length such as "140 mm"')],
    ),
    "wrong kind": (("30 deg", "30 mm"), [(16, "tubes[1].rotation", '"30 mm" is a length', "an angle")]),
    "bore": (
        ("0.7 mm", "0.9 mm"),
        [(13, "tubes[1].outer_diameter", "does not fit into the bore", "at most 0.0008 m")],
    ),
    "wall": (("0.8 mm", "1.8 mm"), [(6, "tubes[0].inner_diameter", "leaves no wall", "below 0.001 m")]),
    "negative length": (("180 mm\n", "-5 mm\n"), [(12, "tubes[1].length", "-0.005 m", "above 0")]),
    "negative tension": (("3 N", "-3 N"), [(21, "tendons[0].tension", "-3 N", "cannot push")]),
    "zero stiffness": (("215 GPa", "0 GPa"), [(15, "tubes[1].material.E", "0 Pa", "above 0")]),
    "negative stiffness": (("215 GPa", "-1 GPa"), [(15, "tubes[1].material.E", "-1e+09 Pa", "above 0")]),
    "no such tube": (("tube: outer", "tube: otter"), [(19, "tendons[0].tube", "no tube 'otter'", "'outer'")]),
    "nothing outside": (
        ("rotation: 30 deg", "translation: -180 mm"),
        [
            (
                16,
                "tubes[1].translation",
                "leaves nothing of 'inner' outside the guide",
                "a translation above -0.1",
            )
        ],
    ),
    "tendon end": (
        ("host: outermost", "end: 300 mm"),
        [(24, "tendons[1].end", "0.3 m is beyond the end of 'inner'", "at most its length 0.18 m")],
    ),
    "unknown material": (
        ("nitinol", "Nitinol"),
        [(7, "tubes[0].material", "did you mean nitinol?", "stainless_steel")],
    ),
    "two shear moduli": (
        ("nu: 0.3", "nu: 0.3, G: 1 GPa"),
        [(15, "tubes[1].material", "has G and nu", "either G, or nu")],
    ),
    "half a section": (
        ("    inner_diameter: 0.8 mm\n", ""),
        [(3, "tubes[0]", "has outer_diameter", "outer_diameter and inner_diameter")],
    ),
    "two sections": (
        ("0.8 mm\n", "0.8 mm\n    diameter: 1 mm\n"),
        [(3, "tubes[0]", "has outer_diameter", "either")],
    ),
    "routing kind": (
        ("kind: straight", "kind: strait"),
        [(20, "tendons[0].routing.kind", '"strait" is not known (did you mean straight?)', "helix")],
    ),
    "no routing kind": (
        ("kind: straight, ", ""),
        [(20, "tendons[0].routing.kind", "is missing", "straight")],
    ),
    "routing keys": (
        ("rate", "rte"),
        [
            (25, "tendons[1].routing.rte", "did you mean rate?", "one of kind, radius"),
            (25, "tendons[1].routing", "none of the keys needed", "either rate, or pitch"),
        ],
    ),
    "routing text": (
        ("{kind: straight, x: 0 mm, y: 6.5 mm}", "straight"),
        [(20, "tendons[0].routing", 'found "straight"', "a mapping with the key kind")],
    ),
    "host": (
        ("outermost", "outer"),
        [(24, "tendons[1].host", '"outer" is not known (did you mean outermost?)', "own")],
    ),
    "vector length": (
        ("[10 1/m, 0, 0]", "[10 1/m, 0]"),
        [(10, "tubes[0].precurvature[1].u", "found a list of 2", "a list of 3")],
    ),
    "late piece": (
        ("60 mm", "600 mm"),
        [(10, "tubes[0].precurvature[1]", "not before the tube's end", "below")],
    ),
    "first piece": (
        ("from: 0 mm", "from: 1 mm"),
        [(9, "tubes[0].precurvature[0]", "starts at 0.001 m", "at 0")],
    ),
    "profile": (
        ("[2 N, 1 N]", "[2 N]"),
        [(26, "tendons[1].tension.values", "1 tensions for 2 places", "one tension")],
    ),
    "load": (
        ("tube: inner, force", "tube: iner, force"),
        [(28, "loads[0].tube", "no tube 'iner'", "'inner'")],
    ),
    "two tubes of one name": (
        ("name: inner", "name: outer"),
        [(11, "tubes[1].name", "already the name", "its own")],
    ),
    "text for a number": (
        ("nu: 0.3", "nu: much"),
        [(15, "tubes[1].material.nu", "does not start with a number", "0.3")],
    ),
    "number for a text": (("name: demo", "name: 3"), [(1, "name", "found 3", "a text")]),
    "no list": (
        ("loads:\n  - {kind: point, tube: inner, force: [0.1 N, 0, 0]}", "loads: 3"),
        [(27, "loads", "found 3", "a list")],
    ),
    "twice": (
        ("name: demo", "name: demo\nname: again"),
        [(2, "name", "is given twice; the first one is on line 1", "")],
    ),
    "assumed": (
        ("name: demo", "assumed:\n  tubes[7].length: a guess"),
        [(2, "assumed.tubes[7].length", "is not a field of this file", "tubes[0].outer_diameter")],
    ),
}


def test_the_good_file_is_good():
    assert loads(GOOD).tube("inner").rotation == pytest.approx(math.pi / 6, rel=1e-15)


@pytest.mark.parametrize("case", CASES)
def test_bad_input(case):
    (old, new), wanted = CASES[case]
    assert old in GOOD
    with pytest.raises(RobotFileError) as caught:
        loads(GOOD.replace(old, new, 1))
    problems = caught.value.problems
    assert sorted((p.line, p.field) for p in problems) == sorted((line, field) for line, field, *_ in wanted)
    for line, field, found, right in wanted:
        problem = next(p for p in problems if (p.line, p.field) == (line, field))
        assert found in problem.problem
        assert right in problem.expected


def test_all_problems_are_listed_in_the_order_of_the_file(tmp_path):
    path = tmp_path / "bad.yaml"
    path.write_text(GOOD.replace("140 mm", "140").replace("3 N", "-3 N").replace("30 deg", "30 mm"))
    with pytest.raises(tactr.FileError) as caught:
        load(path)
    lines = str(caught.value).splitlines()
    assert [line.split(": ")[0] for line in lines] == [f"{path}:4", f"{path}:16", f"{path}:21"]
    assert [line.split(": ")[1] for line in lines] == [
        "tubes[0].length",
        "tubes[1].rotation",
        "tendons[0].tension",
    ]
    assert (caught.value.line, caught.value.field) == (4, "tubes[0].length")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty; expected at least a list of tubes"),
        ("# nothing\n", "is empty"),
        ("just words", 'found "just words"; expected a mapping with name, description'),
        ("- a\n- b\n", "1: found a list; expected a mapping"),
        ("tubes: []", "tubes: 0 tubes were given; expected 1 to 8 tubes"),
        ("name: x", "tubes: is missing; expected a list of tubes, outermost first"),
        ("tubes: [1, 2\nname: }", "2: is not YAML"),
        (
            "tubes:\n\t- name: a\n",
            "2: is not YAML: found character '\\t' that cannot start any token (indent",
        ),
        ("name: a: b", "1: is not YAML: mapping values are not allowed here (a text that holds"),
        ("name: a\n---\nname: b\n", "2: holds a second document"),
        ("1: 2", "has 1 as a key; keys are texts"),
        ("[a]: 2", "has a list or mapping as a key"),
        ("name: \0", "is not YAML"),
        ("tubes: [.nan]", "tubes[0]: found"),
    ],
)
def test_not_a_robot_file(text, words):
    with pytest.raises(tactr.FileError) as caught:
        loads(text)
    assert words in str(caught.value)


@pytest.mark.parametrize("word", ["yes", "no", "on", "off", "1:30", "0o17", "2001-01-01"])
def test_yaml_1_2_reads_these_as_texts(word):
    robot = loads(GOOD.replace("name: demo", f"name: {word}", 1))
    assert robot.name == word


def test_toml_problems_have_lines_too():
    text = '[[tubes]]\nname = "a"\nlength = 140\ndiameter = "1 mm"\nmaterial = "nitinol"\n\n'
    text += '[[tendons]]\nname = "t"\ntube = "a"\n\n'
    text += '[tendons.routing]\nkind = "straight"\nx = "1 mm"\nz = "2 mm"\n'
    with pytest.raises(RobotFileError) as caught:
        loads(text, format="toml")
    found = {(problem.line, problem.field) for problem in caught.value.problems}
    assert found == {(3, "tubes[0].length"), (14, "tendons[0].routing.z"), (11, "tendons[0].routing")}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a = [1,\nb=", "2: is not TOML"),
        ("a=1\na=2", "is not TOML"),
        ("", "tubes: is missing"),
        ("x = 1979-05-27", "x: is not a"),
    ],
)
def test_not_toml(text, words):
    with pytest.raises(tactr.FileError) as caught:
        loads(text, format="toml")
    assert words in str(caught.value)


def test_unreadable_paths(tmp_path):
    for path, words in (
        (tmp_path / "missing.yaml", "no such file"),
        (tmp_path, "is a directory"),
    ):
        with pytest.raises(tactr.FileError) as caught:
            load(path)
        assert words in str(caught.value)
    (tmp_path / "folder.yaml").mkdir()
    with pytest.raises(tactr.FileError, match="is a directory"):
        load(tmp_path / "folder.yaml")
    (tmp_path / "robot.json").touch()
    with pytest.raises(tactr.FileError, match=r"has the ending '.json'; expected one of .yaml"):
        load(tmp_path / "robot.json")
    (tmp_path / "latin.yaml").write_bytes(b"name: x\ndescription: \xe9\n")
    with pytest.raises(tactr.FileError, match=r"latin.yaml:2: is not a text in UTF-8"):
        load(tmp_path / "latin.yaml")


def test_a_byte_order_mark_is_fine(tmp_path):
    path = tmp_path / "bom.yaml"
    path.write_text(GOOD, encoding="utf-8-sig")
    assert load(path).name == "demo"
