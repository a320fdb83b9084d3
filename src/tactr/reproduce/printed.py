"""The numbers that the paper prints, as they are printed, in this one place.

Kheradmand et al., A Comprehensive General Model of Tendon-Actuated Concentric Tube Robots with Multiple Tubes
and Tendons. Texts, because their last digit says how far they were rounded. Lengths in mm, tensions in N.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PrintedError:
    """A tip error as printed: mm, and per cent of the robot's length, None where the paper gives none."""

    mm: str
    percent: str | None = None

    def __str__(self) -> str:
        return f"{self.mm} mm" + (f" ({self.percent} %)" if self.percent else "")


def rounding(text: str) -> float:
    """Half a unit of the last digit: as far as a rounded number may lie from the exact one."""
    return 0.5 * 10.0 ** -len(text.partition(".")[2])


TWO_TUBE_ERRORS = {
    "0": PrintedError("4.34", "2"),
    "90": PrintedError("5.78", "3"),
    "180": PrintedError("4.20", "2"),
}
TWO_TUBE_DISPLACEMENT = "90.14"
"""How far the tip moved from rest in the first trial; the paper does not say whether measured or modelled."""

HELICAL_ERROR = PrintedError("11.36", "3.93")
HELICAL_LENGTH = "280"
HELICAL_DISKS, DISK_SPACING, DISK_ANGLE = 14, 20, 10  # disks beside the base's; mm, deg from one to the next

THREE_TUBE_PERCENT = "4"
ROD_LENGTH, MIDDLE_LENGTH, ROD_FREE, ROD_COVERED = "246.22", "187", "59.22", "14.5"

ASSIGNMENT_ERRORS = {"A": PrintedError("4.69"), "B": PrintedError("34.28")}

CTR_ERRORS = PrintedError("1.07"), PrintedError("1.62", "1.08")  # the least and the largest of five
CTR_ANGLES = (0, 45, 90, 135, 180)

TACTER_ERROR = PrintedError("3.31", "4.37")

EXONAV_ERRORS = PrintedError("3.14", "4.16"), PrintedError("4.15", "5.50"), PrintedError("3.59", "4.76")
EXONAV_LENGTH = "75.4"

OWN_LIMIT, ELSEWHERE_LIMIT = "4", "5"  # per cent: "< 4 %" on their set-up, "around 5 %" on other robots
