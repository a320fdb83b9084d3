"""A calibration in words and as plain data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from tactr.calibration.result import Calibration, Estimate

SHOWN = {"m": (1e3, "mm"), "rad": (180.0 / np.pi, "deg"), "Pa": (1e-9, "GPa"), "m/N": (1e3, "mm/N")}
STRONG = 0.9  # correlations that are told


def as_text(result: Calibration) -> str:
    """Estimates, what is not seen, scores, remarks."""
    parts = [_table(result.estimates)] if result.estimates else []
    if result.unseen:
        parts.append(
            "\n".join(["combinations that the data do not see:", *(f"  {c}" for c in result.unseen)])
        )
    strong = _strong(result)
    if strong:
        parts.append("\n".join(["strong correlations:", *(f"  {a} and {b}: {c:z.2f}" for a, b, c in strong)]))
    parts.append(_scores(result))
    if result.remarks:
        parts.append("\n".join(f"warning: {remark}" for remark in result.remarks))
    return "\n\n".join(parts)


def as_data(result: Calibration) -> dict[str, Any]:
    """For JSON: None instead of NaN."""
    held = result.hold_out
    return {
        "estimates": [
            {
                "name": e.name,
                "value": e.value,
                "standard_error": e.error,
                "interval_95": None if e.interval is None else list(e.interval),
                "start": e.start,
                "unit": e.unit,
                "state": e.state,
            }
            for e in result.estimates
        ],
        "correlation": [[None if np.isnan(c) else float(c) for c in row] for row in result.correlation],
        "unseen": [
            {"weights": c.weights, "standard_error_in_scales": None if np.isinf(c.error) else c.error}
            for c in result.unseen
        ],
        "frame": {name: list(getattr(result.frame, name)) for name in ("marker", "position", "rotation")},
        "noise": result.noise,
        "rows": len(result.measurements),
        "history": result.history,
        "error": _summary(result.error, result.length),
        "hold_out": None
        if held is None
        else {
            **_summary(held.error, result.length),
            "folds": [
                {"name": name, "mean": float(mean)} for name, mean in zip(held.folds, held.means, strict=True)
            ],
            "rows_without_equilibrium": held.missing,
        },
        "starts_left": list(result.left),
        "remarks": [{"kind": remark.kind, "text": remark.text} for remark in result.remarks],
    }


def _summary(error: np.ndarray, length: float) -> dict[str, float]:
    seen = error[np.isfinite(error)]
    return {
        "mean": float(seen.mean()),
        "median": float(np.median(seen)),
        "root_mean_square": float(np.sqrt(np.mean(seen**2))),
        "largest": float(seen.max()),
        "mean_share_of_length": float(seen.mean() / length),
    }


def _table(estimates: tuple[Estimate, ...]) -> str:
    rows = [["parameter", "value", "standard error", "95 % interval", "start"]]
    for e in estimates:
        factor, unit = SHOWN.get(e.unit, (1.0, e.unit))
        start = f"{e.start * factor:.4g} {unit}"
        if e.value is None:
            rows.append([e.name, e.state, "", "", start])
            continue
        digits = (
            6
            if e.error is None
            else int(np.clip(np.ceil(np.log10(abs(e.value / e.error) + 1e-9)) + 2, 2, 12))
        )
        value = f"{e.value * factor:.{digits}g} {unit}".rstrip()
        if e.error is None or e.interval is None:
            rows.append([e.name, value, e.state, "", start])
            continue
        low, high = (f"{end * factor:.{digits}g}" for end in e.interval)
        rows.append([e.name, value, f"{e.error * factor:.2g}", f"{low} to {high}", start])
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return "\n".join(
        "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )


def _strong(result: Calibration) -> list[tuple[str, str, float]]:
    names = [e.name for e in result.estimates]
    pairs = [(i, j) for i in range(len(names)) for j in range(i) if abs(result.correlation[i, j]) > STRONG]
    pairs.sort(key=lambda pair: -abs(result.correlation[pair]))
    return [(names[j], names[i], float(result.correlation[i, j])) for i, j in pairs[:12]]


def _scores(result: Calibration) -> str:
    rows = f"{len(result.measurements)} rows{', one path from rest' if result.history else ''}"
    lines = [f"{rows}, noise of a coordinate {result.noise * 1e3:.4g} mm"]
    lines.append(f"error: {_told(_summary(result.error, result.length))}")
    held = result.hold_out
    if held is not None:
        means = held.means * 1e3
        spread = f"; {len(means)} folds, {means.min():.3g} to {means.max():.3g} mm" if len(means) > 1 else ""
        lines.append(f"held out: {_told(_summary(held.error, result.length))}{spread}")
        if held.missing:
            lines.append(f"{held.missing} rows held out have no equilibrium in the model and do not count")
    if len(result.left) > 1:
        left = ", ".join(f"{each * 1e3:.4g}" for each in result.left)
        lines.append(f"what the starts left (root mean square of a coordinate, mm): {left}")
    return "\n".join(lines)


def _told(summary: dict[str, float]) -> str:
    mean, share = summary["mean"] * 1e3, summary["mean_share_of_length"] * 100
    median, largest = summary["median"] * 1e3, summary["largest"] * 1e3
    return (
        f"mean {mean:.3g} mm ({share:.2g} % of the length), median {median:.3g} mm, largest {largest:.3g} mm"
    )
