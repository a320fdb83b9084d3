"""The error classes themselves."""

import copy
import pickle
import subprocess
import sys

import pytest

from tactr.errors import FileError, MissingExtra, NotConverged, RobotError, TactrError

ERROR = RobotError("length", "-1 m is too small", "above 0", value=-1, owner="Tube 'a'")


def test_text_and_attributes() -> None:
    assert str(ERROR) == "Tube 'a': length: -1 m is too small; expected above 0"
    assert (ERROR.field, ERROR.value, ERROR.expected) == ("length", -1, "above 0")
    assert str(RobotError("", "wrong")) == "wrong"


def test_under_a_path() -> None:
    assert str(ERROR.under("tubes[1]")) == "tubes[1].length: -1 m is too small; expected above 0"
    assert RobotError("[2]", "wrong").under("points").field == "points[2]"
    assert RobotError("", "wrong").under("tubes").field == "tubes"
    assert ERROR.under("tubes[1]").value == -1


@pytest.mark.parametrize(
    "error",
    [
        ERROR,
        FileError(
            "no unit", path="a.yaml", line=3, field="tubes[0].length", value="140", expected="'140 mm'"
        ),
        NotConverged("residual 1e-3", shape="shape"),
        MissingExtra("matplotlib", "plot", "plotting"),
    ],
)
def test_errors_travel_between_processes(error: TactrError) -> None:
    for back in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
        assert type(back) is type(error)
        assert str(back) == str(error)
        assert back.__dict__ == error.__dict__
    assert isinstance(error, TactrError)


def test_file_error_text() -> None:
    error = FileError(
        "no unit", path="a.yaml", line=3, column=5, field="tubes[0].length", expected="'140 mm'"
    )
    assert str(error) == "a.yaml:3:5: tubes[0].length: no unit; expected '140 mm'"
    assert str(FileError("empty")) == "empty"


def test_missing_extra_names_the_command() -> None:
    error = MissingExtra("matplotlib", "plot", "plotting")
    assert isinstance(error, ImportError)
    assert str(error) == "plotting needs matplotlib, which is not installed: pip install 'tactr[plot]'"


def test_description_imports_no_heavy_package() -> None:
    code = (
        "import sys, tactr.robot, tactr.materials; "
        "loaded = {name.split('.')[0] for name in sys.modules}; "
        "heavy = {'scipy', 'matplotlib', 'pydantic', 'xarray', 'ruamel'} & loaded; "
        "sys.exit(', '.join(heavy) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
