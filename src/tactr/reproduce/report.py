"""The report: one HTML file that needs nothing else, and the same tables in Markdown."""

from __future__ import annotations

import base64
from collections.abc import Callable
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

from tactr import __version__
from tactr.errors import FileError
from tactr.reproduce.figures import figure_of
from tactr.reproduce.records import Experiment
from tactr.reproduce.tables import Table, summary, tables

if TYPE_CHECKING:
    from tactr.reproduce.run import Reproduction

INTRODUCTION = (
    "Every experiment of Kheradmand et al., A Comprehensive General Model of Tendon-Actuated Concentric Tube "
    "Robots with Multiple Tubes and Tendons, solved with tactr {version}. The raw measurements are not "
    "public, so the paper's tip errors cannot be computed again, and no measurement is drawn: all curves, "
    "and the dots at their tips, are the model's. What the paper prints is used; one number that it does not "
    "print is fitted to one that it does; everything else is assumed, with the reason and with how far the "
    "tip moves when the assumption changes. Statements of the paper that can be checked without its data are "
    "checked."
)
AXES = (
    "World axes: z along the guide, which the robot leaves at z = 0. Tendon angles are from +X. "
    "Lengths in mm."
)

SHORT = 16  # letters of a cell that is not broken


def save(
    reproduction: Reproduction, folder: Path, progress: Callable[[int, int], None] | None
) -> tuple[Path, Path]:
    """Write both files. Raises MissingExtra without matplotlib, FileError where one cannot be written."""
    experiments = reproduction.experiments
    figures = []
    for k, experiment in enumerate(experiments):
        if progress is not None:
            progress(k, len(experiments))
        figures.append(figure_of(experiment))
    page, text = folder / "report.html", folder / "report.md"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        page.write_text(_html(experiments, figures), encoding="utf-8")
        text.write_text(_markdown(experiments), encoding="utf-8")
    except OSError as error:
        raise FileError(
            f"cannot be written: {error.strerror or error}", path=error.filename or folder
        ) from None
    if progress is not None:
        progress(len(experiments), len(experiments))
    return page, text


def remarks(experiment: Experiment) -> list[str]:
    """What a reader should not miss: statements that do not hold, then findings."""
    failed = [f"{c.statement}: {c.found}." for c in experiment.checks if c.verdict == "does not hold"]
    return [*failed, *experiment.findings]


def _html(experiments: tuple[Experiment, ...], figures: list[bytes]) -> str:
    template = Template(files("tactr.reproduce").joinpath("report.html").read_text(encoding="utf-8"))
    sections = (_section(each, figure) for each, figure in zip(experiments, figures, strict=True))
    links = (f'<a href="#{each.key}">{escape(each.title)}</a>' for each in experiments)
    found = (
        f'<li><a href="#{each.key}">{escape(each.title)}</a>: {escape(remark)}</li>'
        for each in experiments
        for remark in remarks(each)
    )
    return template.substitute(
        version=__version__,
        introduction=escape(INTRODUCTION.format(version=__version__)),
        axes=escape(AXES),
        links="\n".join(links),
        summary=_html_table(summary(experiments)),
        remarks="\n".join(found),
        sections="\n".join(sections),
    )


def _section(experiment: Experiment, figure: bytes) -> str:
    data = base64.b64encode(figure).decode("ascii")
    caption = escape(experiment.caption)
    parts = [
        f'<section id="{experiment.key}">\n<h2>{escape(experiment.title)}</h2>',
        f"<p>{escape(experiment.setting)}</p>",
        f'<figure><img alt="{caption}" src="data:image/svg+xml;base64,{data}">',
        f"<figcaption>{caption}</figcaption></figure>",
        *(_html_table(table) for table in tables(experiment)),
        "</section>",
    ]
    if experiment.findings:
        parts[-1:-1] = ["<ul>", *(f"<li>{escape(text)}</li>" for text in experiment.findings), "</ul>"]
    return "\n".join(parts)


def _html_table(table: Table) -> str:
    head = "".join(f"<th>{escape(text)}</th>" for text in table.head)
    rows = "\n".join(f"<tr>{''.join(map(_html_cell, row))}</tr>" for row in table.rows)
    note = f"<p class=note>{escape(table.note)}</p>\n" if table.note else ""
    return (
        f"<h3>{escape(table.title)}</h3>\n{note}<div class=wide><table>\n<thead><tr>{head}</tr></thead>\n"
        f"<tbody>\n{rows}\n</tbody></table></div>"
    )


def _html_cell(text: str) -> str:
    first, _, remark = text.partition("\n")
    style = {"holds": "holds", "fitted": "fitted", "does not hold": "fails", "cannot be checked": "open"}.get(
        text
    )
    kind = f" class={style}" if style else " class=short" if max(map(len, text.split("\n"))) <= SHORT else ""
    return f"<td{kind}>{escape(first)}{f'<small>{escape(remark)}</small>' if remark else ''}</td>"


def _markdown(experiments: tuple[Experiment, ...]) -> str:
    parts = ["# The paper's experiments, solved", INTRODUCTION.format(version=__version__), AXES]
    parts.append(_markdown_table(summary(experiments)))
    found = [f"- {each.title}: {remark}" for each in experiments for remark in remarks(each)]
    parts += ["## What does not hold, and remarks", "\n".join(found)]
    for each in experiments:
        parts += [f"## {each.title}", each.setting, *map(_markdown_table, tables(each))]
    return "\n\n".join(parts) + "\n"


def _markdown_table(table: Table) -> str:
    rows = [table.head, ("---",) * len(table.head), *table.rows]
    lines = [
        "| " + " | ".join(_markdown_cell(text, first=not k) for k, text in enumerate(row)) + " |"
        for row in rows
    ]
    return "\n\n".join(part for part in (f"### {table.title}", table.note, "\n".join(lines)) if part)


def _markdown_cell(text: str, *, first: bool) -> str:
    return text.replace("|", "/").replace("\n", ": " if first else " ")
