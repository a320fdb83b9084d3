"""Whether printed numbers agree with each other."""

from __future__ import annotations

from tactr.reproduce.printed import PrintedError, rounding
from tactr.reproduce.records import Check, verdict


def length_of(error: PrintedError) -> tuple[float, float, float]:
    """The length (mm) of which a printed error in mm is the printed per cent: its least and largest value
    under rounding, and in between the quotient of the printed numbers."""
    mm, percent = float(error.mm), float(error.percent or "nan")
    off, off_percent = rounding(error.mm), rounding(error.percent or "")
    least = 100 * (mm - off) / (percent + off_percent)
    most = 100 * (mm + off) / (percent - off_percent)
    return least, most, 100 * mm / percent


def percentage(error: PrintedError, length: float, what: str, *, derived: bool = False) -> Check:
    """Whether an error's mm and per cent agree for a length (mm).

    derived: the length is not printed, and was taken from them.
    """
    least, most, _ = length_of(error)
    share = 100 * float(error.mm) / length
    agree = verdict(least <= length <= most)
    source = "; the length is not printed and was chosen for it" if derived else ""
    return Check(
        f"{what}: {error.mm} mm is {error.percent} % of the length",
        f"of {length:g} mm it is {share:.2f} %; as printed, the length is {least:.1f} to {most:.1f} mm"
        f"{source}",
        "fitted" if derived and agree == "holds" else agree,
    )
