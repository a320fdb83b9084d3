"""A robot from a file, changed, saved as a file, and its shape as a labelled dataset."""

from pathlib import Path
from tempfile import TemporaryDirectory

import tactr
from tactr import examples

robot = examples.load("helical")
print(robot)

pulled = robot.with_actuation(tension={"helix": 4.0}).replace(name="helical, 4 N")
with TemporaryDirectory() as folder:
    path = Path(folder) / "pulled.yaml"
    tactr.save(pulled, path)
    print(path.read_text())
    assert tactr.load(path) == pulled

data = tactr.solve(pulled).to_xarray()
bend = data.tube_u.isel(tube_station=data.tube_index == 0).sel(axis=["x", "y"])
largest_curvature = float((bend**2).sum("axis").max() ** 0.5)
print("largest curvature:", largest_curvature, "1/m")
