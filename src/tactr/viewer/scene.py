"""The robot in viser's scene: nodes made once for a robot, and changed in place when it moves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tactr.plotting.palette import mixed, tube_colour
from tactr.robot import Robot
from tactr.viewer.disks import most_disks, unit_disk
from tactr.viewer.picture import FRAMES_PER_TUBE, Picture
from tactr.viewer.settings import Settings
from tactr.viewer.surface import swept_faces, vertex_count
from tactr.viewer.surroundings import add_surroundings
from tactr.viewer.viser_units import PER_METRE, linear, rgb
from tactr.viewer.walls import STATIONS, Wall
from tactr.viewer.widths import holds_tendons

GREYED, NESTED_OPACITY, HOLLOW_OPACITY = "#b5b5b5", 0.6, 0.18
TRACE_COLOUR, MEASURED_COLOUR, GAP_COLOUR = (30, 30, 30), (0, 0, 0), (204, 0, 119)
HIDDEN = 1e-6  # scale of a disk that is not there


def _opacity(robot: Robot, tube: int, nested: bool) -> float | None:
    """Of a part of a tube: one sees through it what runs inside."""
    if holds_tendons(robot, tube):
        return HOLLOW_OPACITY
    return NESTED_OPACITY if nested else None


class Scene:
    """Nodes for one robot after the other."""

    def __init__(self, server: Any) -> None:
        self._scene = server.scene
        self._walls: list[Any] = []
        self._threads: list[Any] = []
        self._ghosts: list[Any] = []
        self._measured: Any = None
        self._gaps: Any = None
        self._root: Any = None
        self._built, self._greyed = 0, False

    def build(self, robot: Robot) -> None:
        """Nodes for a robot, empty until there is a picture of it."""
        scene = self._scene
        if self._root is not None:
            self._root.remove()
        self._built += 1  # a new name: what is sent for the nodes before must not reach these
        root = f"/robot_{self._built}"
        self._root, self._greyed = scene.add_frame(root, show_axes=False), False
        nothing = np.zeros((vertex_count(STATIONS), 3))
        faces = swept_faces(STATIONS)
        colours = [rgb(tube_colour(k)) for k in range(len(robot.tubes))]
        self._walls = [
            scene.add_mesh_simple(
                f"{root}/tubes/{k}_{'nested' if nested else 'bare'}", nothing, faces, color=colours[k],
                opacity=_opacity(robot, k, nested), visible=False, side="double",
                cast_shadow=False, receive_shadow=False,
            )
            for k in range(len(robot.tubes)) for nested in (True, False)
        ]  # fmt: skip
        self._ghosts = [
            scene.add_mesh_simple(
                f"{root}/rest/{k}_{part}", nothing, faces, color=(120, 120, 120), opacity=0.13,
                visible=False, cast_shadow=False, receive_shadow=False,
            )
            for k in range(len(robot.tubes)) for part in (0, 1)
        ]  # fmt: skip
        line, size = np.zeros((1, 2, 3)), 5.0 * max(tube.tip for tube in robot.tubes)
        self._threads = [
            scene.add_line_segments(
                f"{root}/tendons/{k}", line, line.astype(np.uint8), thickness=3.0, thickness_units="screen",
                visible=False,
            )
            for k in range(len(robot.tendons))
        ]  # fmt: skip
        self._trace = scene.add_line_segments(
            f"{root}/trace", line, TRACE_COLOUR, thickness=2.0, thickness_units="screen", visible=False
        )
        self._transitions = scene.add_point_cloud(
            f"{root}/transitions", np.zeros((1, 3)), (20, 20, 20), point_size=0.014 * size,
            point_shape="circle", precision="float32", visible=False,
        )  # fmt: skip
        self._tip = scene.add_point_cloud(
            f"{root}/tip", np.zeros((1, 3)), (204, 0, 119), point_size=0.018 * size, point_shape="circle",
            precision="float32", visible=False,
        )  # fmt: skip
        self._arrows = scene.add_arrows(
            f"{root}/loads", line, np.zeros((1, 3), dtype=np.uint8), visible=False,
            shaft_radius=0.008 * size, head_radius=0.025 * size, head_length=0.07 * size,
        )  # fmt: skip
        self._add_disks(robot, root)
        self._add_frames(robot, root)
        self._ground = add_surroundings(scene, root, robot)

    def _add_disks(self, robot: Robot, root: str) -> None:
        self._most_disks = most_disks(robot)
        self._disks = None
        if self._most_disks:
            vertices, faces = unit_disk()
            count = self._most_disks
            self._disks = self._scene.add_batched_meshes_simple(
                f"{root}/disks", vertices, faces, np.tile([1.0, 0, 0, 0], (count, 1)), np.zeros((count, 3)),
                batched_scales=np.full((count, 3), HIDDEN), batched_colors=(176, 184, 194), opacity=0.32,
                lod="off", cast_shadow=False, receive_shadow=False, visible=False, side="double",
            )  # fmt: skip

    def _add_frames(self, robot: Robot, root: str) -> None:
        count, reach = FRAMES_PER_TUBE * len(robot.tubes), max(tube.tip for tube in robot.tubes)
        self._frames = self._scene.add_batched_axes(
            f"{root}/frames", np.tile([1.0, 0, 0, 0], (count, 1)), np.zeros((count, 3)), visible=False,
            axes_length=0.4 * reach, axes_radius=0.02 * reach,
        )  # fmt: skip

    def update(self, drawn: Picture, settings: Settings) -> None:
        """Show a picture."""
        self._colour(greyed=False)
        self._set_walls(self._walls, drawn.walls)
        for node, thread in zip(self._threads, drawn.threads, strict=True):
            if len(thread.segments):
                node.points, node.colors = PER_METRE * thread.segments, linear(thread.colours)
            node.visible = settings.tendons and len(thread.segments) > 0
        self._set_points(self._transitions, drawn.transitions)
        self._set_points(self._tip, drawn.tip[None])
        if len(drawn.arrows):
            self._arrows.points, self._arrows.colors = PER_METRE * drawn.arrows, drawn.arrow_colours
        self._arrows.visible = settings.loads and len(drawn.arrows) > 0
        self._set_disks(drawn, settings)
        if len(drawn.frame_position):
            self._frames.batched_positions = PER_METRE * drawn.frame_position
            self._frames.batched_wxyzs = drawn.frame_wxyz
        self._frames.axes_length = PER_METRE * drawn.frame_length
        self._frames.visible = len(drawn.frame_position) > 0
        self._ground.visible = settings.grid

    def rest(self, walls: Sequence[Wall] | None) -> None:
        """Show the rest shape, or none."""
        if walls is None:
            for node in self._ghosts:
                node.visible = False
        else:
            self._set_walls(self._ghosts, walls)

    def trace(self, points: np.ndarray | None) -> None:
        """Show the way of the tip through points (n, 3), m; None or one point: no trace."""
        shown = points is not None and len(points) > 1
        if points is not None and shown:
            self._trace.points = PER_METRE * np.stack([points[:-1], points[1:]], axis=1)
        self._trace.visible = shown

    def measured(self, points: np.ndarray | None, gaps: np.ndarray | None) -> None:
        """Show measured points (n, 3) m and their gaps (n, 2, 3) m to the shape; None: none."""
        if points is None:
            for node in (self._measured, self._gaps):
                if node is not None:
                    node.visible = False
            return
        if self._measured is None:
            self._measured = self._scene.add_point_cloud(
                "/measured/points", np.zeros((1, 3)), MEASURED_COLOUR, point_size=0.02, point_shape="diamond",
                precision="float32",
            )  # fmt: skip
            self._gaps = self._scene.add_line_segments(
                "/measured/gaps", np.zeros((1, 2, 3)), GAP_COLOUR, thickness=2.0, thickness_units="screen"
            )
        self._measured.points, self._measured.visible = PER_METRE * points, True
        if gaps is not None:
            self._gaps.points = PER_METRE * gaps
        self._gaps.visible = gaps is not None

    def grey(self) -> None:
        """Grey the shape that is shown, because it is not that of the state."""
        self._colour(greyed=True)

    def hide(self) -> None:
        """Hide the robot: there is no shape yet."""
        nodes = [*self._walls, *self._threads, *self._ghosts, self._transitions, self._tip, self._arrows]
        for node in nodes:
            node.visible = False

    def _colour(self, *, greyed: bool) -> None:
        if greyed == self._greyed:
            return
        self._greyed = greyed
        for k, node in enumerate(self._walls):
            colour = tube_colour(k // 2)
            node.color = rgb(mixed(GREYED, colour, 0.12) if greyed else colour)
        if greyed:
            for node in self._threads:
                node.colors = linear(np.full(node.points.shape, 170))

    def _set_walls(self, nodes: Sequence[Any], walls: Sequence[Wall]) -> None:
        for node, wall in zip(nodes, walls, strict=True):
            if wall.vertices is not None:
                node.vertices = PER_METRE * wall.vertices
            node.visible = wall.vertices is not None

    def _set_points(self, node: Any, points: np.ndarray) -> None:
        if len(points):
            node.points = PER_METRE * points
        node.visible = len(points) > 0

    def _set_disks(self, drawn: Picture, settings: Settings) -> None:
        if self._disks is None:
            return
        count, found = self._most_disks, drawn.disks
        shown = min(len(found.position), count)
        position, sizes = np.zeros((count, 3)), np.full((count, 3), HIDDEN)
        wxyz = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
        position[:shown] = PER_METRE * found.position[:shown]
        sizes[:shown] = PER_METRE * found.sizes[:shown]
        wxyz[:shown] = found.wxyz[:shown]
        self._disks.batched_positions, self._disks.batched_wxyzs = position, wxyz
        self._disks.batched_scales = sizes
        self._disks.visible = settings.disks and shown > 0
