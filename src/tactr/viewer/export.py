"""The robot as GLB and STL, and readings as CSV."""

from __future__ import annotations

import io
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tactr.errors import MissingExtra
from tactr.plotting.palette import tube_colour
from tactr.statics import Shape
from tactr.viewer.surface import swept_faces, swept_vertices
from tactr.viewer.widths import radii

STATIONS = 160
TENDON_RADIUS, TENDON_SHADE = 1.5e-4, (110, 110, 110, 255)
UPRIGHT = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
"""From axes with z up to those of glTF, whose y is up."""


def glb(shape: Shape) -> bytes:
    """Tubes and tendons of a shape as binary glTF, in metres, its y axis up: the robot's z. (extra: view)"""
    trimesh = _trimesh()
    scene = trimesh.Scene()
    for name, (vertices, faces, colour) in {**_tubes(shape), **_tendons(shape)}.items():
        material = trimesh.visual.material.PBRMaterial(
            name=name, baseColorFactor=colour, metallicFactor=0.1, roughnessFactor=0.6, doubleSided=True
        )
        visual = trimesh.visual.TextureVisuals(material=material)
        mesh = trimesh.Trimesh(vertices, faces, visual=visual, process=False)
        scene.add_geometry(mesh, geom_name=name, node_name=name)
    scene.apply_transform(UPRIGHT)
    return bytes(scene.export(file_type="glb"))


def stl(shape: Shape) -> bytes:
    """Tubes of a shape as binary STL, in mm, z along the guide: closed walls, one inside the other. (extra:
    view)"""
    trimesh = _trimesh()
    meshes = [trimesh.Trimesh(1e3 * vertices, faces) for vertices, faces, _ in _tubes(shape).values()]
    for mesh in meshes:  # a rod has a bore of no width
        mesh.update_faces(mesh.nondegenerate_faces())
    return bytes(trimesh.util.concatenate(meshes).export(file_type="stl"))


def csv_text(columns: Sequence[str], rows: Iterable[Sequence[float] | np.ndarray]) -> str:
    """Rows of numbers under their heads; empty where a number is not there."""
    import csv

    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for row in rows:
        writer.writerow(["" if np.isnan(value) else f"{value:.9g}" for value in row])
    return text.getvalue()


Part = tuple[np.ndarray, np.ndarray, tuple[int, int, int, int]]


def _tubes(shape: Shape) -> dict[str, Part]:
    found: dict[str, Part] = {}
    for k, tube in enumerate(shape.robot.tubes):
        own = shape.sample(np.linspace(0.0, tube.tip, STATIONS)).tubes[k]
        outer, inner = radii(shape.robot, k, own.sigma)
        vertices = swept_vertices(own.position, own.frames, outer, inner)
        r, g, b = (int(tube_colour(k)[i : i + 2], 16) for i in (1, 3, 5))
        found[f"tube {tube.name}"] = vertices, swept_faces(len(own.s)), (r, g, b, 255)
    return found


def _tendons(shape: Shape) -> dict[str, Part]:
    fine = shape.sample(STATIONS)
    names = [tube.name for tube in shape.robot.tubes]
    found: dict[str, Part] = {}
    for tendon in fine.tendons:
        frames = fine.tubes[names.index(tendon.tube)].frames[: len(tendon.s)]
        radius = np.full(len(tendon.s), TENDON_RADIUS)
        if len(radius) > 1:
            vertices = swept_vertices(tendon.path, frames, radius, 0.0 * radius, sides=8)
            found[f"tendon {tendon.name}"] = vertices, swept_faces(len(radius), 8), TENDON_SHADE
    return found


def _trimesh() -> Any:
    try:
        import trimesh
    except ImportError:
        raise MissingExtra("trimesh", "view", "a GLB or STL file") from None
    return trimesh
