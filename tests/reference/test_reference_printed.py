"""Terms that are printed otherwise than derived: that both are kept, and how much each matters."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import pytest

from tactr import reference
from tactr.reference.system import assemble
from tactr.robot import Annulus, Helix, Material, PointLoad, Robot, Straight, Tendon, Tube

from .reference_charts import Chart, as_section, random_chart


def two_tubes(host: Literal["own", "outermost"]) -> Robot:
    """Two precurved nitinol tubes, two helical tendons on the outer and a straight one on the inner tube."""
    return Robot(
        [
            Tube(
                "outer",
                length=0.14,
                section=Annulus(1.35e-3, 1.07e-3),
                material=Material(E=65e9, nu=0.33),
                precurvature=(2.0, 0.0, 0.0),
            ),
            Tube(
                "inner",
                length=0.2,
                section=Annulus(1.0e-3, 0.8e-3),
                material=Material(E=45e9, nu=0.33),
                precurvature=(0.0, 4.0, 0.0),
            ),
        ],
        [
            Tendon("a", "outer", Helix(6.5e-3, 8.0, 0.3), tension=3.0),
            Tendon("b", "outer", Helix(6.5e-3, -12.0, 0.3), tension=1.0),
            Tendon("c", "inner", Straight(0.0, -4e-3), host=host, tension=1.0),
        ],
        [PointLoad("inner", force=(0.05, 0.02, 0.0))],
    )


def test_every_difference_says_how_it_is_kept() -> None:
    for difference in reference.DIFFERENCES:
        assert difference.kept in ("as_printed", "transitions", "reading", "ours")
        assert all(label.startswith("eq:") for label in difference.labels)
        assert difference.printed and difference.derived and difference.effect


@pytest.mark.parametrize("host", ["own", "outermost"])
def test_loose_index_of_Gv_moves_the_tip_by_nanometres(host: Literal["own", "outermost"]) -> None:
    robot = two_tubes(host)
    derived = reference.solve(robot)
    printed = reference.solve(robot, as_printed=True, guess=(derived.u_base, derived.v_base))
    assert 2e-9 < np.linalg.norm(printed.tip - derived.tip) < 1e-8


def test_printed_terms_change_Gv_and_the_rest_curvature_rows_only() -> None:
    chart = random_chart(3, 3, 0)
    section, state = as_section(chart)
    A, b = assemble(section, chart.s, state)
    A_printed, b_printed = assemble(section, chart.s, state, as_printed=True)
    change = chart.K_bt[0] @ (chart.du_star[2] - chart.du_star[0])
    assert A_printed == pytest.approx(A)
    expected = np.concatenate([change[:3], np.zeros(7)])
    assert (b_printed - b)[0] == pytest.approx(expected, abs=1e-12)


def test_printed_matrix_differs_in_the_columns_of_v_1_only() -> None:
    seeds = [seed for seed in range(40) if loose_index_matters(random_chart(seed, 2, 3))]
    chart = random_chart(seeds[0], 2, 3)
    section, state = as_section(chart)
    A, A_printed = (assemble(section, chart.s, state, as_printed=printed)[0][0] for printed in (False, True))
    changed = np.abs(A_printed - A) > 1e-12
    assert changed[:2, 3:6].all()
    changed[:2, 3:6] = False
    assert not changed.any()


def loose_index_matters(chart: Chart) -> bool:
    """Whether tube 1 has more tendons than the last tube."""
    hosts = [spiral.host for spiral in chart.spirals]
    return hosts.count(0) > hosts.count(len(chart.theta) - 1)


def test_single_tube_end_keeps_a_transverse_moment(cases: dict[str, tuple[Robot, dict[str, Any]]]) -> None:
    """Printed for every tube and component, eq:boundary_m would set this to zero.

    Contact with the inner tubes fills it.
    """
    robot, _ = cases["three_tubes_mixed"]
    outer = reference.solve(robot, stations=[robot.tubes[0].length]).tubes[0]
    r = np.array([0.0, 0.0065, 0.0])
    direction = np.cross(outer.u[0], r) + outer.v[0]
    moment = outer.m[0] + np.cross(r, 3.0 * direction / np.linalg.norm(direction))
    assert np.linalg.norm(moment[:2]) == pytest.approx(0.013, abs=0.001)
    assert abs(moment[2]) < 1e-10
