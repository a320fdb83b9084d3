"""Material presets, each with the source of its values; drawing, heat treatment and moisture change them.

``tactr.materials.nitinol`` and so on; ``PRESETS`` maps names to materials.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from tactr.robot.material import Material

_PAPER = (
    "Kheradmand et al., A Comprehensive General Model of Tendon-Actuated Concentric Tube Robots "
    "with Multiple Tubes and Tendons"
)
_NITINOL_DENSITY = "density from SMA Inc., Selected Properties of NiTi (6.45 g/cm^3)"
_STEEL_DENSITY = "density from the data sheet of AISI 304 (8.0 g/cm^3)"

nitinol = Material(
    name="nitinol",
    E=45e9,
    G=16.91e9,
    density=6450.0,
    source=(
        f"{_PAPER}, two-tube experiment, outer tube (superelastic tube, as used there); {_NITINOL_DENSITY}"
    ),
)

nitinol_65 = Material(
    name="nitinol_65",
    E=65e9,
    G=24.4e9,
    density=6450.0,
    source=f"{_PAPER}, helical experiment, tube of 1.35 mm outer diameter; {_NITINOL_DENSITY}",
)

nitinol_austenite = Material(
    name="nitinol_austenite",
    E=83e9,
    nu=0.33,
    density=6450.0,
    source=(
        "SMA Inc., Selected Properties of NiTi: austenite, approximately 83 GPa (martensite 28 to 41 "
        "GPa), Poisson's ratio 0.33; 75 to 83 GPa is usual for small strains, drawn superelastic "
        "tubes are often softer"
    ),
)

stainless_steel = Material(
    name="stainless_steel",
    E=193e9,
    nu=0.29,
    density=8000.0,
    source=(
        "data sheet of AISI 304 (ASM Aerospace Specification Metals): E 193 to 200 GPa, Poisson's "
        "ratio 0.29, 8.0 g/cm^3; the sheet's shear modulus of 86 GPa does not follow from these and "
        "is not used"
    ),
)

stainless_steel_215 = Material(
    name="stainless_steel_215",
    E=215e9,
    G=80e9,
    density=8000.0,
    source=f"{_PAPER}, two-tube experiment, inner tube; {_STEEL_DENSITY}",
)

spring_steel = Material(
    name="spring_steel",
    E=200e9,
    G=81.7e9,
    density=7860.0,
    source=(
        "Budynas and Nisbett, Shigley's Mechanical Engineering Design, properties of spring wires: "
        "music wire ASTM A228, 0.033 to 0.063 in, E 29.0 and G 11.85 Mpsi; density 0.284 lb/in^3"
    ),
)

titanium = Material(
    name="titanium",
    E=114e9,
    G=44e9,
    density=4430.0,
    source="data sheet of Ti-6Al-4V (grade 5), annealed bar, ASM MatWeb MTP644",
)

aluminium = Material(
    name="aluminium",
    E=68.9e9,
    G=26e9,
    density=2710.0,
    source="Hibbeler, Mechanics of Materials, table of average properties: aluminium 6061-T6",
)

nylon = Material(
    name="nylon",
    E=2.93e9,
    nu=0.4,
    density=1150.0,
    source=(
        "data sheet of extruded nylon 6/6 (Quadrant Nylon 101), dry: tensile modulus 2.93 GPa, 1.15 "
        "g/cm^3; Poisson's ratio 0.4 is a textbook value; wet nylon is about half as stiff"
    ),
)

pla = Material(
    name="pla",
    E=3.04e9,
    nu=0.36,
    density=1264.0,
    source=(
        "data sheet of printed PLA (Stratasys FDM), XZ orientation: tensile modulus 3039 MPa, 1.264 "
        "g/cm^3; Poisson's ratio 0.36 is assumed; prints vary with orientation and infill"
    ),
)

peek = Material(
    name="peek",
    E=4.0e9,
    nu=0.4,
    density=1300.0,
    source=(
        "data sheet of Victrex PEEK 450G: tensile modulus 4.0 GPa, 1.30 g/cm^3; Poisson's ratio 0.4 "
        "is typical"
    ),
)

tpu = Material(
    name="tpu",
    E=70e6,
    nu=0.4,
    density=1200.0,
    source=(
        "TPU rod of the SoRoSim data set in github.com/ContinuumRoboticsLab/opencr-mujoco (E 70 MPa); "
        "TPU ranges from about 10 to 700 MPa with its hardness"
    ),
)

PRESETS: Mapping[str, Material] = MappingProxyType(
    {
        preset.name: preset
        for preset in (
            nitinol,
            nitinol_65,
            nitinol_austenite,
            stainless_steel,
            stainless_steel_215,
            spring_steel,
            titanium,
            aluminium,
            nylon,
            pla,
            peek,
            tpu,
        )
    }
)
"""Every preset by its name."""
