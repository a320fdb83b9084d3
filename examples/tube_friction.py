"""A straight tube turned to and fro in a curved one: its tip lags behind its base."""

import numpy as np

import tactr
from tactr import Annulus, Robot, Tube, materials

nitinol = materials.nitinol
robot = Robot(
    [
        Tube("outer", length=0.15, section=Annulus(2e-3, 1.6e-3), material=nitinol, precurvature=(8, 0, 0)),
        Tube("inner", length=0.15, section=Annulus(1.5e-3, 1.2e-3), material=nitinol, friction=0.15),
    ]
)
base = np.radians([0, 30, 60, 40, 20, 0])
driven = tactr.drive(robot, {"rotation": np.stack([np.zeros(6), base], axis=1)})
tip = np.array([shape.theta[1, -1] for shape in driven])  # of the inner tube in the outer one
for angle, turned in zip(np.degrees(base), np.degrees(tip), strict=True):
    print(f"base at {angle:3.0f} deg: tip at {turned:6.2f} deg")

lag = float(base[2] - tip[2])  # rad, on the way out
back = float(tip[5] - base[5])  # on the way back
contact = driven.state.rubbing.contact("inner")
print(f"lag {np.degrees(lag):.2f} deg out, {np.degrees(back):.2f} deg back; {contact!r}")
