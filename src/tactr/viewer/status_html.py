"""The state of the robot as HTML: what it is, whether it stands, and its numbers."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from tactr.plotting.palette import tube_colour
from tactr.robot import Robot
from tactr.viewer.readings import Readings, readings
from tactr.viewer.session import Level, Outcome
from tactr.viewer.tension_colours import SCALE

COLOURS: dict[Level, tuple[str, str]] = {
    "good": ("#e8f5ee", "#00704f"),
    "warning": ("#fff3dc", "#8a5a00"),
    "bad": ("#fde8e4", "#a33100"),
}
SIGNS: dict[Level, str] = {"good": "●", "warning": "▲", "bad": "■"}
LONGEST = 340
FONT = "font-size:13px;line-height:1.45;font-family:inherit;color:#222"


def status_html(outcome: Outcome) -> str:
    """A coloured box: in one word how the state is, why, and the numbers of its shape."""
    ground, ink = COLOURS[outcome.level]
    head = f'<b style="font-size:15px">{SIGNS[outcome.level]} {escape(outcome.headline)}</b>'
    found = readings(outcome.shape) if outcome.shape is not None and outcome.fresh else None
    if found is not None:
        head += f'<span style="float:right"> stability margin {found.margin:.2g}</span>'
    reason = f"<div>{escape(_short(outcome.reason))}</div>" if outcome.reason else ""
    if outcome.level == "bad":
        kept = (
            "The last good shape is shown in grey" if outcome.shape is not None else "There is no shape yet"
        )
        reason += f"<div>{kept}.</div>"
    box = (
        f'<div data-status="{escape(outcome.headline)}" style="background:{ground};color:{ink};'
        f'border-left:4px solid {ink};padding:5px 9px;margin:0 0 6px">{head}{reason}</div>'
    )
    return f'<div style="{FONT};padding:2px 10px 10px">{box}{_numbers(found)}</div>'


def busy_html() -> str:
    """A solve that takes its time."""
    ground, ink = COLOURS["warning"]
    return (
        f'<div style="{FONT};padding:2px 10px 10px"><div data-status="solving" style="background:{ground};'
        f'color:{ink};border-left:4px solid {ink};padding:5px 9px"><b style="font-size:15px">solving …</b>'
        "<div>No equilibrium is near: all ways to find one are being tried.</div></div></div>"
    )


def _numbers(found: Readings | None) -> str:
    if found is None:
        return ""
    x, y, z = 1e3 * found.tip
    i, j, k = found.direction
    turned = ", ".join(f"{part:z.3f}" for part in found.quaternion)
    rows = [
        ("tip", f'<b data-tip="{x:.4f} {y:.4f} {z:.4f}">{_triple(x, y, z, 2)}</b> mm'),
        ("points to", _triple(i, j, k, 3)),
        ("quaternion", f'<span title="of the tip, w first">{turned}</span>'),
    ]
    if found.lengths:
        rows.append(("tendons", _tendons(found)))
    rows.append(
        ("solved", f"in {1e3 * found.solve_time:.2f} ms, residual {found.residual:.0e}"),
    )
    cells = "".join(
        f'<tr><td style="color:#666;padding-right:10px;vertical-align:top">{name}</td><td>{value}</td></tr>'
        for name, value in rows
    )
    return f'<table style="font-variant-numeric:tabular-nums;border-spacing:0">{cells}</table>'


def _triple(x: float, y: float, z: float, digits: int) -> str:
    return ", ".join(f"{value:z.{digits}f}" for value in (x, y, z))


def _tendons(found: Readings) -> str:
    lines = []
    for name, length in found.lengths.items():
        tension = found.tensions[name]
        pull = "profile" if tension is None else "slack" if name in found.slack else f"{tension:.2f} N"
        lines.append(f"{escape(name)} {1e3 * length:.2f} mm, {pull}")
    return "<br>".join(lines)


def legend_html(robot: Robot, most_tension: float) -> str:
    """Which colour is which tube, and what the colours of tendons mean."""
    tubes = " ".join(
        f'<span style="white-space:nowrap;margin-right:8px">'
        f'<span style="color:{tube_colour(k)}">■</span> {escape(tube.name)}</span>'
        for k, tube in enumerate(robot.tubes)
    )
    stops = ", ".join(f"rgb({r:.0f},{g:.0f},{b:.0f})" for r, g, b in SCALE)
    tendons = (
        f'<div style="white-space:nowrap">tendons 0 N <span style="display:inline-block;width:90px;'
        f'height:9px;background:linear-gradient(90deg, {stops})"></span> {most_tension:g} N and more</div>'
    )
    text = " ".join(robot.description.split())
    about = f'<div style="color:#666">{escape(_short(text, 150))}</div>' if text else ""
    if not robot.tendons:
        tendons = ""
    return f'<div style="{FONT};padding:0 10px 4px">{about}<div>{tubes}</div>{tendons}</div>'


def errors_html(problems: Sequence[str]) -> str:
    """Messages of a file that cannot be used, one a line, as on the command line."""
    ground, ink = COLOURS["bad"]
    lines = "".join(f"<div>{escape(line)}</div>" for line in problems)
    return (
        f'<div style="{FONT};padding:2px 10px 10px"><div data-errors="{len(problems)}" '
        f'style="background:{ground};color:{ink};border-left:4px solid {ink};padding:5px 9px;'
        f'overflow-wrap:anywhere">{lines}</div></div>'
    )


COPY = (
    "const t=this.previousElementSibling;t.select();"
    "(navigator.clipboard?navigator.clipboard.writeText(t.value):Promise.reject())"
    ".catch(()=>document.execCommand('copy')).then(()=>this.textContent='Copied')"
)


def copy_html(text: str) -> str:
    """A text with a button that copies it."""
    return (
        f'<textarea data-copy readonly style="width:100%;height:380px;font:12px monospace">{escape(text)}'
        f'</textarea><button onclick="{escape(COPY)}" style="padding:4px 14px;margin-top:6px">Copy</button>'
    )


def note_html(text: str) -> str:
    """A remark."""
    return f'<div style="{FONT};color:#555;padding:2px 10px">{escape(text)}</div>' if text else ""


def _short(text: str, longest: int = LONGEST) -> str:
    return text if len(text) <= longest else text[: longest - 1].rsplit(" ", 1)[0] + " …"
