"""A tendon pulled and let go again: friction bends the robot differently on the way back."""

import numpy as np

import tactr
from tactr import Annulus, Robot, Straight, Tendon, Tube, materials

robot = Robot(
    [Tube("backbone", length=0.2, section=Annulus(1.2e-3, 0.9e-3), material=materials.nitinol)],
    [Tendon("pull", "backbone", Straight(0, 3e-3), friction=0.15)],
)
pull = [1.0, 5.0, 9.0, 5.0, 1.0, 5.0, 9.0]  # N
driven = tactr.drive(robot, {"tension": np.array(pull)[:, None]})
for tension, tip in zip(pull, driven.tips, strict=True):
    print(f"{tension:.0f} N: tip at y = {tip[1] * 1e3:.2f} mm")

width = float(driven.tips[3, 1] - driven.tips[5, 1])  # of the loop at 5 N, m
held = driven.states[3].tension("pull", [0.0, 0.1, 0.2])  # N along the tendon, on the way back
heat = float(driven.heat[1:].sum())  # J
print(f"at 5 N the tip is {width * 1e3:.2f} mm further on the way back")
print(f"{driven!r}; {held.round(2)} N along the tendon at 5 N; heat {heat * 1e3:.3f} mJ")

later = tactr.drive(robot, [{"tension": [4.0]}], state=driven.state)  # goes on from what it remembers
