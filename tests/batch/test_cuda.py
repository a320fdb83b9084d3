"""Batches on graphics processors: the source compiles for them; on one, it agrees with the CPU."""

import shutil
import subprocess
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import Annulus, Material, Robot, Straight, Tendon, Tube
from tactr.batch.cuda import cuda_door

CORE = Path(__file__).parents[2] / "core"
NVCC = shutil.which("nvcc") or shutil.which("/usr/local/bin/nvcc")


def robot() -> Robot:
    """One tube, one tendon."""
    tube = Tube("tube", length=0.1, section=Annulus(1e-3, 0.8e-3), material=Material(E=60e9, nu=0.3))
    return Robot([tube], [Tendon("pull", "tube", Straight(0.0, 4e-3), tension=1.0)])


def has_gpu() -> bool:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return cuda_door() is not None


def test_without_a_gpu_the_cpu_does_it_and_says_so() -> None:
    if has_gpu():
        pytest.skip("there is a GPU")
    pull: dict[str, Any] = {"tension": {"pull": np.linspace(0.0, 2.0, 5)}}
    with pytest.warns(RuntimeWarning, match="solving on the CPU instead: .+"):
        found = tactr.solve_batch(robot(), **pull, device="cuda")
    np.testing.assert_array_equal(found.tip_position, tactr.solve_batch(robot(), **pull).tip_position)


def test_on_a_gpu_tips_agree_with_the_cpu_to_a_nanometre() -> None:
    if not has_gpu():
        pytest.skip("no GPU, or built without GPU code")
    pull: dict[str, Any] = {"tension": {"pull": np.linspace(0.0, 2.0, 500)}}
    found = tactr.solve_batch(robot(), **pull, device="cuda")
    np.testing.assert_allclose(found.tip_position, tactr.solve_batch(robot(), **pull).tip_position, atol=1e-9)


@pytest.mark.slow
def test_the_source_compiles_for_the_device(tmp_path: Path) -> None:
    if NVCC is None:
        pytest.skip("no nvcc")
    command = [
        NVCC,
        "-std=c++17",
        "-ptx",
        "-arch=sm_80",
        "--fmad=false",
        "--expt-relaxed-constexpr",
        "-Xcicc",
        "-O0",
    ]
    out = tmp_path / "lanes.ptx"
    done = subprocess.run(
        [*command, CORE / "lanes_cuda.cu", "-o", out], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    kernels = [line for line in out.read_text().splitlines() if ".entry" in line]
    assert len(kernels) == 4 and all("solve_lanes_on_device" in line for line in kernels)
