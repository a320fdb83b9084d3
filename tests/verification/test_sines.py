"""The kernel's own sine and cosine against those of numpy in extended precision."""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

CORE = Path(__file__).parents[2] / "core"
COMPILER = os.environ.get("CXX") or shutil.which("c++") or shutil.which("g++")
if COMPILER is None or not CORE.exists():
    pytest.skip("no compiler, or no sources of the kernel", allow_module_level=True)
if np.finfo(np.longdouble).precision < 18:
    pytest.skip("no extended precision on this machine", allow_module_level=True)


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Compiled as the kernel is."""
    out = tmp_path_factory.mktemp("sines") / "sines"
    source = Path(__file__).with_name("sines.cpp")
    flags = ["-std=c++17", "-O2", "-ffp-contract=off", "-fno-math-errno", "-Wno-psabi", f"-I{CORE}"]
    subprocess.run([str(COMPILER), *flags, str(source), "-o", str(out)], check=True)
    return out


def sines(program: Path, x: np.ndarray) -> np.ndarray:
    """(4, k, 2): as the march takes them, of a pack, in single precision, of a pack of that."""
    done = subprocess.run([program], input=x.tobytes(), capture_output=True, check=True)
    return np.frombuffer(done.stdout).reshape(len(x), 4, 2).transpose(1, 0, 2)


def angles(largest: float) -> np.ndarray:
    """Of all sizes, and close to whole quarter turns, where one of the two is small."""
    rng = np.random.default_rng(3)
    quarters = np.arange(-200, 201) * (np.pi / 2)
    sizes = 10.0 ** rng.uniform(-8, np.log10(largest), 20000) * rng.choice([-1.0, 1.0], 20000)
    return np.concatenate(
        [[0.0], quarters, np.nextafter(quarters, 10.0), rng.uniform(-7.0, 7.0, 20000), sizes]
    )


def units_off(found: np.ndarray, x: np.ndarray, kind: type[np.floating]) -> float:
    """Largest error, in units in the last place of the value."""
    exact = np.stack([np.sin(x.astype(np.longdouble)), np.cos(x.astype(np.longdouble))], axis=1)
    unit = np.spacing(np.abs(exact).astype(kind)).astype(np.longdouble)
    return float(np.max(np.abs(found - exact) / unit))


def test_to_two_units_in_the_last_place(program: Path) -> None:
    x = angles(9e4)
    assert units_off(sines(program, x)[0], x, np.float64) < 2.0


def test_single_precision_to_what_it_is_used_for(program: Path) -> None:
    """Angles are rounded, too: compared at those."""
    x = angles(50.0).astype(np.float32).astype(float)
    rough = sines(program, x)[2]
    exact = np.stack([np.sin(x), np.cos(x)], axis=1)
    np.testing.assert_allclose(rough, exact, atol=2e-7)


def test_packs_come_to_the_same_bits(program: Path) -> None:
    one, pack, _, _ = sines(program, angles(9e4))
    np.testing.assert_array_equal(pack, one)
    _, _, rough, rough_pack = sines(program, angles(900.0))
    np.testing.assert_array_equal(rough_pack, rough)


def test_beyond_its_range_a_pack_says_so(program: Path) -> None:
    _, pack, rough, rough_pack = sines(program, np.array([1.01e5, np.inf, np.nan]))
    assert np.isnan(pack).all() and np.isnan(rough).all() and np.isnan(rough_pack).all()
