"""`tactr check`, `schema`, `examples`, help and version."""

import inspect
import json
import re
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest

import tactr
from tactr import examples
from tactr.cli.app import app
from tactr.cli.help_text import COMMANDS, HELP
from tactr.io import loads

BAD = "tubes:\n  - name: a\n    lenght: 140 mm\n    diameter: 1\n    material: nitinol\n"


def test_check(run, tmp_path):
    good, bad = tmp_path / "good.yaml", tmp_path / "bad.yaml"
    good.write_text(examples.path("helical").read_text())
    bad.write_text(BAD)
    code, out, err = run("check", str(good))
    assert (code, err) == (0, "")
    assert out.startswith(f"{good}: fine: tubes outer, inner; tendons helix")
    assert "assumed: tubes[1].outer_diameter: not printed" in out
    code, out, err = run("check", str(bad), "two_tube_0")
    assert code == 2
    assert "two_tube_0: fine" in out
    assert err.splitlines() == [
        f'{bad}:2: tubes[0].length: is missing; expected length of the whole tube, such as "140 mm"',
        f"{bad}:3: tubes[0].lenght: is not a known key (did you mean length?); expected one of name, length, "
        "outer_diameter, inner_diameter, diameter, stiffness, notches, sections, material, precurvature, "
        "translation, rotation, rotation_compliance, translation_compliance, limits, rotation_play, "
        "translation_play, friction",
        f'{bad}:4: tubes[0].diameter: 1 has no unit; expected a length such as "140 mm" (perhaps "1 mm")',
    ]


def test_check_a_study(run, tmp_path):
    study = tmp_path / "study.yaml"
    text = "robot: two_tube_90\nvary:\n- {path: tubes.outer.rotation, from: 0 deg, to: 90 deg, points: 4}\n"
    study.write_text(text)
    code, out, _ = run("check", str(study))
    assert code == 0 and "4 configurations; varied tubes.outer.rotation" in out
    study.write_text(text.replace("outer", "uter"))
    code, _, err = run("check", str(study))
    assert code == 2 and "study.yaml:3" in err and "uter" in err


def test_check_nothing(run):
    assert run("check")[0] == 2


def test_schema(run):
    code, out, _ = run("schema")
    assert code == 0
    jsonschema.Draft202012Validator.check_schema(json.loads(out))


def test_examples(run):
    code, out, _ = run("examples")
    assert code == 0
    for name in examples.names():
        assert re.search(rf"^{name} +\S", out, re.MULTILINE)


def test_an_example_is_a_file_to_start_from(run):
    code, out, _ = run("examples", "two_tube_90")
    assert code == 0
    assert loads(out) == examples.load("two_tube_90")


@pytest.mark.parametrize(
    "words", [["examples", "nothing"], ["frobnicate"], ["schema", "x"], ["solve", "a", "b"]]
)
def test_mistakes(run, words):
    code, out, err = run(*words)
    assert (code, out) == (2, "")
    assert err.startswith("tactr:")


@pytest.mark.parametrize("words", [[], ["--help"], ["-h"], ["help"]])
def test_help(run, words):
    code, out, err = run(*words)
    assert (code, out, err) == (0, HELP, "")


def test_the_ready_made_help_is_complete():
    commands = [name for name in app if not name.startswith("-")]
    assert (
        sorted(commands)
        == sorted(COMMANDS)
        == ["calibrate", "check", "drive", "examples", "reproduce", "schema", "solve", "sweep", "view"]
    )
    for name in commands:
        assert re.search(rf"^  {name} ", HELP, re.MULTILINE)
        text = COMMANDS[name]
        command: Any = app[name].default_command
        parameters = inspect.signature(command).parameters
        assert text.startswith(f"tactr {name}: ")
        for parameter in parameters.values():
            option = parameter.kind is parameter.KEYWORD_ONLY
            word = f"--{parameter.name.replace('_', '-')}" if option else parameter.name.upper()
            assert re.search(rf"^  .*{word}|Usage: .*{word}", text, re.MULTILINE), word
        words = re.findall(r"--([\w-]+)", text)
        assert {word.replace("-", "_") for word in words} <= set(parameters)


@pytest.mark.parametrize(
    "command", ["calibrate", "check", "examples", "reproduce", "schema", "solve", "sweep", "view"]
)
def test_help_of_commands(run, command):
    for words in ([command, "--help"], [command, "x", "-h"]):
        assert run(*words) == (0, COMMANDS[command], "")
    assert max(map(len, COMMANDS[command].splitlines())) <= 110


def test_version(run):
    code, out, _ = run("--version")
    assert code == 0
    assert out.strip() == tactr.__version__


def test_versions_agree():
    project = Path(__file__).parents[2] / "pyproject.toml"
    assert tomllib.loads(project.read_text())["project"]["version"] == tactr.__version__
