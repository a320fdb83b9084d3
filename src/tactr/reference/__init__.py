"""The published model as printed: A x = b in NumPy, integrated by SciPy, solved by shooting.

P. Kheradmand et al., "A Comprehensive General Model of Tendon-Actuated Concentric Tube Robots with Multiple
Tubes and Tendons", equation by equation: names are the paper's symbols, docstrings give its LaTeX labels.
Slow; for reading and for checking the fast kernel against. Where to find what:

    compatibility   u_i, v_i and their derivatives           eq:u2_u1_relationship to eq:shear_dot_relation
    constitutive    n_i, m_i                                 eq:constitutive_model_single
    tendons         tendon velocities, sums over tendons     eq:tendon_forces to
    eq:tendon_position_derivatives
    moment_rows     G, H, RHS_1, RHS_2                       eq:Gu to eq:RHS1, eq:Hu to eq:RHS2i
    force_rows      J, K, RHS_3, RHS_4                       eq:Ju to eq:RHS3, eq:Ku to eq:RHS4i
    system          A x = b                                  eq:finall
    transitions     ends of tubes and tendons                eq:boundary_n, eq:boundary_m
    march, shooting initial value problem, boundary conditions
    cutting         from a `tactr.Robot` to sections
    differences     DIFFERENCES: where print and derivation disagree, how both are kept, how much it matters

All tubes start at s = 0: the published model knows no transmission length.
"""

from tactr.reference.differences import DIFFERENCES, Difference
from tactr.reference.solution import ReferenceShape, ReferenceTube, solve

__all__ = ["DIFFERENCES", "Difference", "ReferenceShape", "ReferenceTube", "solve"]
