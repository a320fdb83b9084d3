"""The summary of a sweep for people to read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tactr.statics.status import Status

if TYPE_CHECKING:
    from tactr.studies.reached import Reached
    from tactr.studies.summary import Summary

GOOD = (Status.CONVERGED.value, Status.UNSTABLE.value)


def text_of(summary: Summary) -> str:
    """Lines: how the solves ended, what is reached, quantiles."""
    lines = [f"{summary.title}: {summary.count} configurations", ""]
    stable = "" if summary.stable is None else f", {_percent(summary.stable)} of those stable"
    lines.append(f"converged: {_percent(summary.converged)}{stable}")
    lines += [f"  {number:>10} {name}" for name, number in summary.statuses.items()]
    if summary.reached is not None:
        lines += ["", *_reached(summary.reached)]
    if summary.quantiles:
        lines += ["", f"{'of stable shapes':<28}{'5 %':>10}{'median':>10}{'95 %':>10}"]
    for name, found in summary.quantiles.items():
        label = f"{name.replace('_', ' ')}{f' ({found.unit})' if found.unit else ''}"
        numbers = "".join(f"{value:>10.4g}" for value in (found.low, found.median, found.high))
        lines.append(f"{label:<28}{numbers}")
    return "\n".join(lines)


def _reached(found: Reached) -> list[str]:
    edge, half, coarse = f"{found.voxel * 1e3:g} mm", _volume(found.half), _volume(found.coarse)
    caution = [
        f"  caution: to voxels of this edge the tips fill {found.dimension:.1f} dimensions, so that the",
        "  volume means little: more samples or a larger edge may tell, or the tips lie on a surface",
    ]
    return [
        f"reachable volume: {_volume(found.volume)}, {found.voxels} voxels of {edge} that hold a stable tip",
        f"  by half the samples {half}, by voxels of twice the edge {coarse};",
        f"  chance that one more random sample meets a new voxel: {_percent(found.unseen)}",
        *([] if found.is_a_volume else caution),
    ]


def _volume(volume: float) -> str:
    return f"{volume * 1e6:.4g} cm^3"


def _percent(share: float) -> str:
    return f"{100 * share:.4g} %"
