"""Pictures of sweeps: which tips are in which panel, and what the axes say."""

import numpy as np
import pytest

from tactr import FileError, Range, RobotError, Samples, Study, examples, sweep


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    study = Study(
        examples.load("two_tube_90"),
        [Range("tendons.outer.tension", 0.0, 4.0), Range("tubes.inner.rotation", -3.0, 3.0)],
        samples=Samples(200),
        outputs=["tip", "jacobian", "stability"],
    )
    return sweep(study, tmp_path_factory.mktemp("plot") / "x.zarr")


def test_projections_slices_and_histograms(swept, tmp_path):
    figure = swept.plot(tmp_path / "x.png", colour="tendons.outer.tension")
    assert (tmp_path / "x.png").stat().st_size > 20_000
    *panels, bar = figure.axes[:6] + figure.axes[-4:], figure.axes[6]
    projections, slices, histograms = figure.axes[0:6:2], figure.axes[1:6:2], figure.axes[7:]
    assert bar.get_ylabel() == "tendons.outer.tension (N)"
    assert len(panels) == 1
    tips = 1e3 * swept.dataset.tip_position.values
    for axes, (across, up) in zip(projections, ((0, 2), (1, 2), (0, 1)), strict=True):
        assert (axes.get_xlabel(), axes.get_ylabel()) == (f"{'xyz'[across]} (mm)", f"{'xyz'[up]} (mm)")
        assert axes.get_aspect() == 1.0
        drawn = np.vstack([np.asarray(each.get_offsets()) for each in axes.collections])
        assert np.sort(drawn, axis=0) == pytest.approx(np.sort(tips[:, [across, up]], axis=0))
    drawn = np.asarray(slices[1].collections[0].get_offsets())
    thickness = float(slices[1].get_title().split()[2])
    assert len(drawn) == (np.abs(tips[:, 0]) <= thickness / 2 + 0.05).sum()
    assert [axes.get_xlabel() for axes in histograms][:2] == ["tendons.outer.tension (N)", "stability margin"]
    assert sum(patch.get_height() for patch in histograms[0].patches) >= 198


def test_what_cannot_be_drawn(swept, tmp_path):
    with pytest.raises(RobotError, match="has no 'zz'"):
        swept.plot(colour="zz")
    with pytest.raises(FileError, match="cannot be written"):
        swept.plot(tmp_path / "no" / "x.png")
