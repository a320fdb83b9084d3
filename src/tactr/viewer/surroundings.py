"""What stands round the robot: the guide, and a ground with its scale in mm."""

from __future__ import annotations

from typing import Any

import numpy as np

from tactr.plotting.palette import GUIDE_COLOUR
from tactr.robot import Robot
from tactr.viewer.disks import RIM, round_step, unit_disk
from tactr.viewer.viser_units import PER_METRE, linear, rgb

AXIS_COLOURS = (200, 0, 0), (60, 160, 30)  # x, y: z is hidden in the robot
AXIS_SHARE, NAME_SHARE = 0.16, 0.18  # of the robot's length: the axes, and where their names are


def add_surroundings(scene: Any, root: str, robot: Robot) -> Any:
    """The guide, and a ground with its scale in mm: the node of the ground, which may be hidden."""
    reach = max(tube.tip for tube in robot.tubes)
    widest = guide_radius(robot)
    depth = 0.35 * widest + 0.004
    vertices, faces = unit_disk()
    vertices = (vertices - [0, 0, 0.5]) * [widest, widest, depth]
    scene.add_mesh_simple(
        f"{root}/guide", PER_METRE * vertices, faces, color=rgb(GUIDE_COLOUR), flat_shading=False,
        cast_shadow=False, receive_shadow=False,
    )  # fmt: skip
    step = round_step(reach)
    half = np.ceil(reach / (5 * step)) * 5 * step
    ground = f"{root}/ground"
    node = scene.add_frame(ground, show_axes=False, position=(0, 0, -PER_METRE * depth))
    scene.add_grid(
        f"{ground}/grid", 2 * PER_METRE * half, 2 * PER_METRE * half, cell_size=PER_METRE * step,
        section_size=5 * PER_METRE * step, cell_color=(226, 226, 226), section_color=(196, 196, 196),
        shadow_opacity=0.0, fade_distance=1e3,
    )  # fmt: skip
    for k, name in enumerate("xy"):
        marks = {f"{1e3 * place:.0f} mm": place for place in np.arange(5 * step, half + step, 5 * step)}
        for text, place in {name: NAME_SHARE * reach, **marks}.items():
            scene.add_label(
                f"{ground}/{name}_{text}", text, position=PER_METRE * place * np.eye(3)[k],
                font_screen_scale=0.8, anchor="center-center", depth_test=False,
            )  # fmt: skip
    axes = PER_METRE * AXIS_SHARE * reach * np.array([[[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 1, 0]]])
    axes[..., 2] = 0.02 * reach  # above the lines of the grid
    colours = linear(np.repeat(np.array(AXIS_COLOURS)[:, None], 2, axis=1))
    scene.add_line_segments(f"{ground}/axes", axes, colours, thickness=3.0, thickness_units="screen")
    return node


def guide_radius(robot: Robot) -> float:
    """Radius of the guide drawn, m: round all tendons and tubes."""
    offsets = [
        float(np.hypot(*tendon.routing.r(max(0.0, -robot.tube(tendon.tube).translation))))
        for tendon in robot.tendons
    ]
    tubes = [1.5 * (tube.outer_diameter or 2e-3) for tube in robot.tubes]
    return RIM * 1.15 * max([*offsets, *tubes])
