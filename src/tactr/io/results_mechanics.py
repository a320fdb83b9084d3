"""Forces and energies of a shape as variables of its dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from tactr.statics import Shape

Variable = tuple[list[str], np.ndarray, dict[str, str]]


def variable(dims: str, values: Any, units: str, text: str) -> Variable:
    """A variable of a dataset: dimensions, array, attributes."""
    return dims.split(), np.asarray(values), {"units": units, "long_name": text}


def add_mechanics(variables: dict[str, Any], shape: Shape) -> None:
    """Add strain energies, actuator forces, guide reaction and contact."""
    forces, reaction = shape.actuator_forces, shape.guide_reaction
    variables["tube_energy"] = variable("tube", shape.tube_energy, "J", "elastic strain energy")
    variables["base_torque"] = variable(
        "tube", forces.torque, "N m", "by the actuator on the proximal end, about z"
    )
    variables["base_force"] = variable(
        "tube", forces.force, "N", "by the actuator on the proximal end, along z"
    )
    text = "by the guide on the robot outside, across z"
    variables["guide_force"] = variable("axis", reaction.force, "N", text)
    variables["guide_moment"] = variable("axis", reaction.moment, "N m", f"{text}, about its exit")
    if shape.contacts:
        _add_contacts(variables, shape)


def _add_contacts(variables: dict[str, Any], shape: Shape) -> None:
    contacts, tubes = shape.contacts, [tube.name for tube in shape.robot.tubes]
    pairs = np.array([(tubes.index(c.outer), tubes.index(c.inner)) for c in contacts])
    variables["contact_outer"] = variable("contact", pairs[:, 0], "1", "tube that presses, outermost 0")
    variables["contact_inner"] = variable("contact", pairs[:, 1], "1", "tube that it presses on")
    for prefix, parts, units in (
        ("contact", contacts, ("N/m", "N")),
        ("contact_point", [contact.points for contact in contacts], ("N", "N m")),
    ):
        dim = f"{prefix}_station"
        index = np.repeat(np.arange(len(parts)), [len(part.s) for part in parts])
        variables[f"{prefix}_index"] = variable(dim, index, "1", "contact of each entry")
        for name, unit, text in (
            ("s", "m", "arc length from the guide's exit"),
            ("force", units[0], "force of the outer on the inner tube"),
            ("moment", units[1], "moment of the outer on the inner tube, about the centreline"),
        ):
            values = np.concatenate([getattr(part, name) for part in parts])
            dims = dim if name == "s" else f"{dim} axis"
            variables[f"{prefix}_{name}"] = variable(dims, values, unit, text)
