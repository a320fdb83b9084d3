"""Shapes as datasets and netCDF files: everything is there, with units, and comes back unchanged."""

import h5py
import numpy as np
import pytest
import xarray as xr

import tactr
from tactr import examples
from tactr.io import loads, results

ROBOTS = ["two_tube_90", "three_tube_ctr", "till_helical", "tdcr_two_segment", "ctr"]


@pytest.mark.parametrize("name", ROBOTS)
def test_saved_and_read_again(name, tmp_path):
    shape = tactr.solve(examples.load(name))
    shape.save(tmp_path / "shape.nc")
    read = xr.load_dataset(tmp_path / "shape.nc", engine="h5netcdf")
    assert read.identical(shape.to_xarray())
    assert loads(read.attrs["robot"]) == shape.robot


def test_the_arrays_are_those_of_the_shape():
    shape = tactr.solve(examples.load("two_tube_90"))
    data = shape.to_xarray()
    assert np.array_equal(data.centreline, shape.centreline)
    assert np.array_equal(data.tip_quaternion, shape.tip_quaternion)
    for k, tube in enumerate(shape.tubes):
        mine = data.isel(tube_station=data.tube_index.values == k)
        for field in ("s", "sigma", "position", "psi", "u", "v", "n", "m"):
            assert np.array_equal(mine[f"tube_{field}"], getattr(tube, field))
        assert np.array_equal(mine.tube_frame, tube.frames)
    for k, tendon in enumerate(shape.tendons):
        mine = data.isel(tendon_station=data.tendon_index.values == k)
        assert np.array_equal(mine.tendon_path, tendon.path)
        assert data.tendon_length.sel(tendon=tendon.name) == tendon.length
    assert data.attrs["status"] == "converged"
    assert data.attrs["discretisation_error_m"] == shape.discretisation_error


def test_displacements_and_slack():
    shape = tactr.solve(examples.load("two_tube_90"), displacement={"inner": -1e-3})
    data = shape.to_xarray()
    assert np.array_equal(data.tendon_motor_tension, shape.tension)
    assert np.array_equal(data.tendon_displacement, shape.displacement)
    assert data.tendon_given.values.tolist() == [0, 1]
    assert data.tendon_slack.values.tolist() == [0, 1]
    assert "displacement: -1" in data.attrs["robot"]


def test_forces_and_energies_are_those_of_the_shape():
    shape = tactr.solve(examples.load("three_tube_ctr"))
    data = shape.to_xarray()
    assert np.array_equal(data.tube_energy, shape.tube_energy)
    assert np.array_equal(data.base_torque, shape.actuator_forces.torque)
    assert np.array_equal(data.base_force, shape.actuator_forces.force)
    assert np.array_equal(data.guide_moment, shape.guide_reaction.moment)
    names = data.tube.values
    for k, contact in enumerate(shape.contacts):
        assert names[data.contact_outer[k]] == contact.outer and names[data.contact_inner[k]] == contact.inner
        along = data.isel(contact_station=data.contact_index.values == k)
        points = data.isel(contact_point_station=data.contact_point_index.values == k)
        for field in ("s", "force", "moment"):
            assert np.array_equal(along[f"contact_{field}"], getattr(contact, field))
            assert np.array_equal(points[f"contact_point_{field}"], getattr(contact.points, field))


def test_every_variable_has_a_unit_and_a_name():
    data = tactr.solve(examples.load("two_tube_90")).to_xarray()
    for name, variable in data.data_vars.items():
        assert variable.attrs["units"], name
        assert variable.attrs["long_name"], name
        assert not np.isnan(variable).any(), name


def test_any_hdf5_reader_opens_it(tmp_path):
    shape = tactr.solve(examples.load("two_tube_90"))
    shape.save(tmp_path / "shape.nc")
    with h5py.File(tmp_path / "shape.nc") as file:
        assert np.array_equal(np.asarray(file["centreline"]), shape.centreline)
        assert file["centreline"].attrs["units"] == "m"


def test_a_function_routing_leaves_a_remark_instead_of_the_robot():
    robot = examples.load("till_straight")
    tendon = tactr.Tendon("t", "backbone", tactr.Function(lambda s: (0.01, 0.0), 0.5), tension=1.0)
    data = tactr.solve(robot.replace(tendons=(tendon,))).to_xarray()
    assert data.attrs["robot"].startswith("# not stored: tendons[0].routing")


def test_no_shape_no_file(tmp_path):
    shape = tactr.solve(examples.load("till_straight"), tension={"tendon": 1e9})
    with pytest.raises(tactr.NotConverged):
        shape.save(tmp_path / "shape.nc")
    assert not (tmp_path / "shape.nc").exists()


def test_where_it_cannot_be_written(tmp_path):
    shape = tactr.solve(examples.load("two_tube_90"))
    with pytest.raises(tactr.FileError, match="cannot be written"):
        shape.save(tmp_path / "missing" / "shape.nc")


def test_without_the_extra(monkeypatch):
    shape = tactr.solve(examples.load("two_tube_90"))
    monkeypatch.setitem(__import__("sys").modules, "xarray", None)
    with pytest.raises(tactr.MissingExtra, match=r"pip install 'tactr\[netcdf\]'"):
        results.to_xarray(shape)
