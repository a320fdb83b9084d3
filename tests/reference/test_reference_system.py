"""A and b of eq:finall against a direct differentiation of every tube's balance, and their solution."""

from __future__ import annotations

import numpy as np
import pytest

from tactr.reference.algebra import Array
from tactr.reference.paths import Path
from tactr.reference.system import assemble, solve_scaled

from .reference_charts import as_section, random_chart


@pytest.mark.parametrize(("n", "m"), [(1, 0), (1, 2), (2, 3), (3, 5), (4, 8)])
def test_matrices_equal_the_differentiated_balances(n: int, m: int) -> None:
    for seed in range(5):
        chart = random_chart(seed, n, m)
        section, state = as_section(chart)
        A, b = assemble(section, chart.s, state)
        A_direct, b_direct = chart.system()
        assert A[0] == pytest.approx(A_direct, abs=1e-13)
        assert b[0] == pytest.approx(b_direct, abs=1e-12)


def test_least_squares_as_in_the_paper_gives_the_same_rates() -> None:
    chart = random_chart(1, 3, 4)
    section, state = as_section(chart)
    A, b = assemble(section, chart.s, state)
    x = solve_scaled(section, A, b)
    assert x[0] == pytest.approx(np.linalg.lstsq(A[0], b[0])[0], rel=1e-9)


def test_matrix_is_symmetric_up_to_the_choice_of_unknowns() -> None:
    """A is the derivative of the resultants by the strains: the Hessian of an energy for one tube."""
    chart = random_chart(2, 1, 4)
    section, state = as_section(chart)
    A = assemble(section, chart.s, state)[0][0]
    assert pytest.approx(A.T, abs=1e-13) == A


@pytest.mark.parametrize("polar", [True, False])
def test_path_derivatives(polar: bool) -> None:
    path = Path(0.1, polar, (0.5, 0.3, -0.2, 0.1), (0.2, -1.5, 0.7))
    s, h = 0.34, 1e-5
    _, dz, ddz = path.derivatives(s)
    near: list[Array] = [np.array(path.derivatives(s + d)) for d in (-h, h)]
    slope = (near[1] - near[0]) / (2 * h)
    assert slope[:2] == pytest.approx(np.array([dz, ddz]), rel=1e-8)
