"""Many at once: the workspace of a robot over two tensions, then a design study over a tube's wall."""

import numpy as np

import tactr

robot = tactr.examples.load("two_tube_90")
names = [tendon.name for tendon in robot.tendons]

first, second = np.meshgrid(np.linspace(0.0, 5.0, 15), np.linspace(0.0, 5.0, 15))
space = tactr.solve_batch(
    robot, tension={names[0]: first.ravel(), names[1]: second.ravel()}, outputs=("stability",)
)
print(space)
reach = np.ptp(space.tip_position[space.converged], axis=0)
print("the tip reaches over", reach * 1e3, "mm")

wall = f"tubes.{robot.tubes[0].name}.section.outer_diameter"
outer = np.linspace(1.0, 1.3, 7) * robot.tubes[0].section.outer_diameter
study = tactr.solve_batch(robot, parameters={wall: outer}, outputs=("compliance",))
assert study.compliance is not None
softness = study.compliance[:, 0, 0]
print("tip compliance in x:", softness, "m/N")
