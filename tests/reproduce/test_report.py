"""The report: complete, readable by itself, and the same in both forms."""

import base64
import re
from html import escape
from html.parser import HTMLParser
from xml.etree import ElementTree

import pytest

from tactr.plotting import tube_colour
from tactr.reproduce.figures import figure_of
from tactr.reproduce.tables import summary, tables

EMPTY = {"meta", "img", "br", "link"}
OWN_NAMESPACES = re.compile(r"http://www\.w3\.org/|http://purl\.org/|http://creativecommons\.org/")
LARGEST = 5_000_000


class Page(HTMLParser):
    """Collects elements, links and text, and whether every element is closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.links: list[str] = []
        self.ids: list[str] = []
        self.images: list[dict] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        found = {name: value or "" for name, value in attrs}
        if tag not in EMPTY:
            self.open.append(tag)
        self.links += [found[name] for name in ("href", "src") if name in found]
        self.ids += [found["id"]] if "id" in found else []
        self.images += [found] if tag == "img" else []

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def page(report):
    return Page(report[0])


@pytest.fixture(scope="module")
def drawings(page):
    head = "data:image/svg+xml;base64,"
    assert all(image["src"].startswith(head) for image in page.images)
    return [base64.b64decode(image["src"].removeprefix(head)).decode() for image in page.images]


def test_the_page_is_well_formed_and_small(page, report):
    assert page.open == []
    assert len(report[0].encode()) < LARGEST
    assert "$" not in re.sub(r"base64,[^\"]*", "", report[0])


def test_nothing_is_fetched(page, report, drawings):
    assert page.links
    for link in page.links:
        assert link.startswith(("data:", "#"))
    assert {link[1:] for link in page.links if link.startswith("#")} <= set(page.ids)
    assert "url(" not in report[0]
    assert "http" not in re.sub(r"base64,[^\"]*", "", report[0])
    for drawing in drawings:
        assert not re.search(r"https?://", OWN_NAMESPACES.sub("", drawing))


def test_every_experiment_has_its_section_figure_and_tables(page, report, reproduction):
    html, markdown = report
    assert len(page.images) == len(reproduction.experiments)
    for each, image in zip(reproduction.experiments, page.images, strict=True):
        assert each.key in page.ids
        assert image["alt"] == each.caption
        assert f"## {each.title}" in markdown
        for check in each.checks:
            assert escape(check.statement) in html
            assert check.statement.replace("|", "/") in markdown
        for effect in each.effects:
            assert escape(effect.reason) in html


def test_every_experiment_of_the_paper_s_list_is_reported(report, shared):
    listed = (shared / "paper" / "experiments.md").read_text(encoding="utf-8")
    names = [
        re.split(r"[:(,]", row.split("|")[1])[0].strip() for row in listed.splitlines() if row.startswith("|")
    ]
    titles = {"hysteresis": "Loading and unloading", "ctr": "Concentric tube robot"}
    for name in names[2:]:
        title = titles.get(name.lower(), name)
        assert re.search(rf"<h2>{title}", report[0], re.IGNORECASE), name
    assert len(names) == 10


def test_tables_are_rectangular(report, reproduction):
    every = [summary(reproduction.experiments)]
    every += [table for each in reproduction.experiments for table in tables(each)]
    for table in every:
        assert {len(row) for row in table.rows} == {len(table.head)}
    for block in report[1].split("\n\n"):
        if block.startswith("|"):
            assert len({line.count("|") for line in block.splitlines()}) == 1


def test_what_is_not_printed_is_marked(reproduction):
    tubes = {table.title: table for table in tables(reproduction["three_tubes"])}["Tubes"]
    assert [row[2] for row in tubes.rows] == ["1.05 / 0.85 mm†", "0.7987 / 0.4 mm†‡", "0.38 mm, solid†"]
    assert [row[1] for row in tubes.rows] == ["140", "187", "246.22"]
    assert tubes.note
    tendons = {table.title: table for table in tables(reproduction["two_tubes"])}["Tendons"]
    assert [row[4] for row in tendons.rows] == ["3", "2"]


def test_figures_are_svg_with_the_colours_of_the_tubes(drawings, reproduction):
    """Blue, vermillion and green from the outside in, everywhere; ExoNav II has an inner tube only."""
    for drawing, each in zip(drawings, reproduction.experiments, strict=True):
        ElementTree.fromstring(drawing)
        first = 1 if each.key == "exonav" else 0
        wanted = {first + k for k in range(len(each.cases[0].robot.tubes))}
        assert {k for k in range(8) if tube_colour(k).lower() in drawing} == wanted, each.key


def test_figures_are_the_same_every_time(reproduction):
    assert figure_of(reproduction["assignment"]) == figure_of(reproduction["assignment"])


def test_progress(reproduction, tmp_path, monkeypatch):
    monkeypatch.setattr("tactr.reproduce.report.figure_of", lambda experiment: b"")
    seen = []
    reproduction.save(tmp_path, progress=lambda done, count: seen.append((done, count)))
    assert seen == [(k, 8) for k in range(9)]
