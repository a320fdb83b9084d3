"""Where the published text and the equilibrium equations that it starts from disagree."""

from __future__ import annotations

from typing import Literal, NamedTuple


class Difference(NamedTuple):
    """One place: LaTeX labels, what is printed, what the equilibrium gives, how it is kept, the effect.

    kept: "as_printed" and "transitions" are the options of `solve` that give the printed form; "reading"
    where only one reading makes sense; "ours" for what the paper leaves out.
    """

    labels: tuple[str, ...]
    printed: str
    derived: str
    kept: Literal["as_printed", "transitions", "reading", "ours"]
    effect: str


DIFFERENCES: tuple[Difference, ...] = (
    Difference(
        ("eq:RHS1", "eq:RHS21"),
        "K_bt,1 u*_i': the index i is loose",
        "K_bt,1 u*_1'",
        "as_printed",
        "With i read as n, b changes by K_bt,1 (u*_n' - u*_1'). None on a Robot, whose rest curvature is "
        "piecewise constant (u*' = 0); shown on the rows themselves in "
        "tests/reference/test_reference_printed.py.",
    ),
    Difference(
        ("eq:Gv",),
        "sum over j = 1..m_i of tube 1's tendons: the index i is loose",
        "sum over j = 1..m_1",
        "as_printed",
        "None where m_n = m_1. With i read as n and m_n < m_1 (all of the paper's approach A, where m_n = "
        "0), tendons of tube 1 drop out of G_v: 3 to 7 nanometres at the tip of a two-tube nitinol robot "
        "with helical tendons (test_reference_printed.py), since v_1' is small.",
    ),
    Difference(
        ("eq:boundary_n", "eq:boundary_m"),
        "the elastic n and m jump by the wrench of terminating tendons only",
        "resultants jump by point loads only: a continuing tendon whose direction jumps presses on the "
        "robot there",
        "transitions",
        "0.15 mm at the tip of the shared case three_tubes_mixed; none where no direction jumps.",
    ),
    Difference(
        ("eq:boundary_n", "eq:boundary_m"),
        "three force and three moment conditions for every tube",
        "d3 for every tube, d1 and d2 for the sum over tubes: the tubes press on each other at a tube's "
        "end too",
        "reading",
        "6n conditions would meet 4 + 2n unknowns. At the end of the outermost tube of three_tubes_mixed "
        "the condition on d1, d2 that is not imposed is off by 13 mN m (test_reference_printed.py).",
    ),
    Difference(
        ("eq:Gu", "eq:Gv", "eq:Jv", "eq:RHS1", "eq:RHS3"),
        "no brackets after the sum over i = 2..n, in RHS1 and RHS3 after its minus sign",
        "the sum runs to the end of the expression, each term with the sign printed before it",
        "reading",
        "No other reading is defined (i would be loose), or it contradicts eq:moment_sum_local4. With "
        "this one the printed G, H, J, K and RHS equal a direct differentiation of the balances to "
        "rounding (test_reference_system.py).",
    ),
    Difference(
        (
            "eq:moment_sum_local5",
            "eq:moment_localH",
            "eq:force_sum_local4",
            "eq:moment_localK",
            "eq:finall_A",
        ),
        "terms in u_d3,i' and beta_i' without a sum over i",
        "summed over i = 2..n in G and J; tube i's own in H and K",
        "reading",
        "None: columns i = 2..n of A.",
    ),
    Difference(
        ("eq:moment_sum_local1", "eq:moment_each_local1"),
        "tau_c, the moment between tubes",
        "tau_t, the moment of the tendons (as eq:moment_sum_local2 has it); tau_c cancels in the sum and "
        "has no d3 part",
        "reading",
        "None: a label.",
    ),
    Difference(
        ("eq:reduced_force_components",),
        "f_i = f_t,i and tau_i = tau_t,i in d1 and d2 for each tube",
        "for each tube in d3 only; in d1 and d2 for the sum over tubes, where f_c and tau_c cancel",
        "reading",
        "None: the equations that follow are taken that way.",
    ),
    Difference(
        ("eq:der_equal_curvature",),
        "R^T - I_3 (a vector), and the relation after it I_(3,3) u_1,d3' (matrix times scalar)",
        "R^T - I_(3,3), and I_(3,3) u_1'",
        "reading",
        "None: shapes fit no other way, and eq:Gu and the rest print I_(3,3).",
    ),
    Difference(
        ("eq:Kbetai",),
        "label of tube 1, K_beta with index 1 on the left",
        "tube i; tube 1's is zero, eq:Kbeta",
        "reading",
        "None: a label.",
    ),
    Difference(
        ("eq:finall",),
        "solved as a minimum-norm least-squares problem; base conditions R(0) and p_c'(0)",
        "A is square and regular; base conditions R(0), theta_i(0) and p_c(0), since p_c'(0) = R v_1 is "
        "unknown",
        "reading",
        "None: both solutions agree (test_reference_system.py).",
    ),
    Difference(
        ("eq:shape_evol",),
        "p_c' = R v for every tube, with one s",
        "true of tube 1; tube i would give p' = beta_i R_1 v_1, as tubes slide on each other",
        "reading",
        "Kept as the paper has it, following the outermost tube present: |beta_i - 1| is 1e-5 to 1e-4 on "
        "metal tubes.",
    ),
    Difference(
        ("eq:force_components", "eq:moment_components"),
        "f_e = tau_e = 0; no point loads",
        "f_e and tau_e in RHS_1 to RHS_4, point loads in eq:boundary_n and eq:boundary_m",
        "ours",
        "Loaded robots, as in the shared case one_tube_helical_loaded.",
    ),
    Difference(
        ("eq:tendon_forces", "eq:tendon_moment"),
        "lambda constant",
        "for a tension that varies along the tendon: lambda' t more force, lambda' r x t more moment",
        "ours",
        "Robots with a TensionProfile only.",
    ),
)
"""All that was found.

Everything else in eq:Gu to eq:RHS4i, signs, beta factors and [I_3]^T included, is as derived.
"""
