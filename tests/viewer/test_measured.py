"""Measured points: read with their units, and their distances to a shape."""

import math

import numpy as np
import pytest

from tactr import FileError
from tactr.viewer.measured import misfit, read_points

WANTED = [[0.001, 0.002, 0.003], [0.0, 0.0, 0.1]]


@pytest.mark.parametrize(
    "text",
    [
        "x [mm],y [mm],z [mm]\n1,2,3\n0,0,100\n",
        "\ufeffz (mm); x (cm) ;y [m]; note\n3;0.1;0.002;first\n\n100;0;0;\n",
        "X [um]\tY [um]\tZ [um]\r\n1e3\t2e3\t3e3\r\n0\t0\t1e5\r\n",
    ],
)
def test_units_order_and_separators(text):
    np.testing.assert_allclose(read_points(text), WANTED, rtol=1e-12)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "a.csv: is empty"),
        ("x [mm],y [mm],z [mm]\n", "no points"),
        ("x,y,z\n1,2,3\n", "a.csv:1: x: is missing, or has no unit; expected a head such as x"),
        ("x [mm],y [mm]\n1,2\n", "1: z: is missing"),
        ("x [N],y [mm],z [mm]\n1,2,3\n", "1: x: .*is a force"),
        ("x [mm],x [mm],y [mm],z [mm]\n1,2,3,4\n", "x: is given twice"),
        ("x [mm],y [mm],z [mm]\n1,2,3\n1,two,3\n", "3: y: 'two' is not a number"),
        ("x [mm],y [mm],z [mm]\n1,2\n", "2: z: '' is not a number"),
        ("x [mm],y [mm],z [mm]\n1,nan,2\n", "2: y: 'nan' is not a number"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(text, words):
    with pytest.raises(FileError, match=words):
        read_points(text, "a.csv")


def test_distances_to_a_quarter_circle():
    radius, angle = 0.1, np.linspace(0.0, math.pi / 2, 400)
    arc = radius * np.stack([1 - np.cos(angle), 0 * angle, np.sin(angle)], axis=-1)
    turns = np.array([0.2, 0.7, 1.2])
    off = np.array([0.002, -0.003, 0.001])
    points = np.stack(
        [radius - (radius + off) * np.cos(turns), 0 * turns, (radius + off) * np.sin(turns)], axis=-1
    )
    points = np.vstack([points, arc[-1] + [0.0, 0.004, 0.0]])
    found = misfit(points, arc, arc[-1])
    assert found.mean == pytest.approx((0.002 + 0.003 + 0.001 + 0.004) / 4, abs=1e-6)
    assert found.largest == found.tip == pytest.approx(0.004)
    np.testing.assert_allclose(found.gaps[:, 0], points)
    assert "4 measured points: to the centreline 2.50 mm on average, 4.00 mm at most" in str(found)
