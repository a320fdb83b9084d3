"""The paper's experiments, solved: what it prints beside what can be checked without its measurements.

P. Kheradmand et al., "A Comprehensive General Model of Tendon-Actuated Concentric Tube Robots with Multiple
Tubes and Tendons". No measurement is invented: the shapes are the model's. Where to find what:

    printed       the paper's numbers
    two_tubes, helical, loading, three_tubes, assignment, ctr, tacter, exonav     one experiment each
    steel_tube    the one fit that the shapes use
    assumptions, effects     what was assumed, and how far it moves the tip
    figures, report          the HTML and Markdown report (extra: plot)
"""

from tactr.reproduce.records import Case, Check, Effect, Experiment, Fit, Move
from tactr.reproduce.run import Reproduction, run

__all__ = ["Case", "Check", "Effect", "Experiment", "Fit", "Move", "Reproduction", "run"]
