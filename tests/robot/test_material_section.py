"""Materials, presets and sections: values that come out."""

import math
from typing import Any

import numpy as np
import pytest

from tactr import materials
from tactr.robot import Annulus, Material, Rod, Section, Stiffness


def test_shear_modulus_from_either() -> None:
    assert Material(E=200e9, G=80e9).shear_modulus == 80e9
    assert Material(E=200e9, G=80e9).poisson_ratio == pytest.approx(0.25)
    assert Material(E=200e9, nu=0.25).shear_modulus == pytest.approx(80e9)
    assert Material(E=200e9, nu=0.5).poisson_ratio == 0.5


@pytest.mark.parametrize(
    "value", [np.float64(45e9), np.float32(45e9), np.int64(45_000_000_000), 45_000_000_000]
)
def test_numbers_become_plain_floats(value: Any) -> None:
    made = Material(E=value, nu=np.array(0.3), density=6450)  # type: ignore[arg-type]
    assert type(made.E) is float
    assert made.E == pytest.approx(45e9, rel=1e-6)
    assert type(made.nu) is float
    assert type(made.density) is float


def test_presets_have_sources_and_plausible_values() -> None:
    assert {"nitinol", "stainless_steel", "spring_steel", "nylon", "tpu", "pla"} <= set(materials.PRESETS)
    for name, preset in materials.PRESETS.items():
        assert preset.name == name
        assert getattr(materials, name) is preset
        assert len(preset.source) > 20
        assert preset.density is not None
        assert 0.2 < preset.poisson_ratio < 0.5


def test_presets_cannot_be_changed() -> None:
    with pytest.raises(TypeError):
        materials.PRESETS["nitinol"] = materials.pla  # type: ignore[index]


def test_paper_values() -> None:
    assert (materials.nitinol.E, materials.nitinol.shear_modulus) == (45e9, 16.91e9)
    assert (materials.stainless_steel_215.E, materials.stainless_steel_215.shear_modulus) == (215e9, 80e9)


def test_annulus_by_hand() -> None:
    stiff = Annulus(0.003, 0.001).stiffness(Material(E=2e9, G=1e9, density=1000))
    area = math.pi / 4 * (9e-6 - 1e-6)
    inertia = math.pi / 64 * (81e-12 - 1e-12)
    assert stiff.EA == pytest.approx(2e9 * area, rel=1e-14)
    assert stiff.GA == pytest.approx(1e9 * area, rel=1e-14)
    assert stiff.EI_x == stiff.EI_y == pytest.approx(2e9 * inertia, rel=1e-14)
    assert stiff.GJ == pytest.approx(1e9 * 2 * inertia, rel=1e-14)
    assert stiff.linear_density == pytest.approx(1000 * area, rel=1e-14)
    assert (stiff.outer_diameter, stiff.inner_diameter) == (0.003, 0.001)


def test_rod_is_an_annulus_without_bore() -> None:
    material = Material(E=2e9, nu=0.3)
    rod, annulus = Rod(0.002), Annulus(0.002, 0)
    assert rod.stiffness(material) == annulus.stiffness(material)
    assert (rod.outer_diameter, rod.inner_diameter) == (0.002, 0.0)
    assert rod.stiffness(material).linear_density is None


def test_thin_wall_keeps_its_digits() -> None:
    wall = 1e-9
    stiff = Annulus(0.001, 0.001 - 2 * wall).stiffness(Material(E=1e9, nu=0.3))
    assert stiff.EA == pytest.approx(1e9 * math.pi * wall * (0.001 - wall), rel=1e-9)


def test_stiffness_is_a_section() -> None:
    given = Stiffness(EA=1e4, GA=1e3, EI_x=1e-3, EI_y=2e-3, GJ=1e-3)
    assert isinstance(given, Section)
    assert given.stiffness() is given
    assert given.stiffness(materials.nylon) is given
    assert given.outer_diameter is None
