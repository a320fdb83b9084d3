"""The paper's numbers stand in its text; whether they agree with each other is worked out by hand here."""

import re

import pytest

from tactr.reproduce import printed
from tactr.reproduce.consistency import length_of, percentage
from tactr.reproduce.printed import PrintedError, rounding

ERRORS = [
    *printed.TWO_TUBE_ERRORS.values(),
    printed.HELICAL_ERROR,
    *printed.ASSIGNMENT_ERRORS.values(),
    *printed.CTR_ERRORS,
    printed.TACTER_ERROR,
    *printed.EXONAV_ERRORS,
]


def numbers_of(text: str) -> set[str]:
    return set(re.findall(r"\d+(?:\.\d+)?", text))


def test_every_number_is_in_the_paper(shared):
    text = (shared / "paper" / "model.tex").read_text(encoding="utf-8")
    numbers = numbers_of(
        text[text.index("Two-Tube Configuration") : text.index("Limitation and Future Work")]
    )
    wanted = [number for error in ERRORS for number in (error.mm, error.percent) if number]
    wanted += [printed.TWO_TUBE_DISPLACEMENT, printed.HELICAL_LENGTH, printed.THREE_TUBE_PERCENT]
    wanted += [printed.ROD_LENGTH, printed.MIDDLE_LENGTH, printed.ROD_FREE, printed.ROD_COVERED]
    wanted += [printed.EXONAV_LENGTH, str(printed.HELICAL_DISKS), str(printed.DISK_SPACING)]
    assert set(wanted) <= numbers


def test_every_error_of_the_list_of_experiments_is_taken(shared):
    table = (shared / "paper" / "experiments.md").read_text(encoding="utf-8")
    listed = {
        number
        for row in table.splitlines()
        for words in re.findall(r"(?:tip errors?|errors) ([\d.,() %A-Zfmort=agins]+)", row)
        for number in re.findall(r"\d+\.\d\d", words)
    }
    assert len(listed) > 10
    taken = {number for error in ERRORS for number in (error.mm, error.percent)}
    assert listed <= taken


def test_rounding():
    assert rounding("4.34") == pytest.approx(0.005)
    assert rounding("2") == 0.5
    assert rounding("14.5") == pytest.approx(0.05)


def test_the_length_behind_an_error():
    least, most, middle = length_of(printed.HELICAL_ERROR)
    assert middle == pytest.approx(11.36 / 0.0393)
    assert least == pytest.approx(11.355 / 0.03935)
    assert most == pytest.approx(11.365 / 0.03925)
    assert length_of(printed.TACTER_ERROR)[2] == pytest.approx(75.7, abs=0.05)


@pytest.mark.parametrize(
    ("error", "length", "verdict"),
    [
        (PrintedError("11.36", "3.93"), 280, "does not hold"),
        (PrintedError("11.36", "3.93"), 289, "holds"),
        (PrintedError("4.34", "2"), 180, "holds"),  # 2.41 %
        (PrintedError("4.6", "2"), 180, "does not hold"),  # 2.56 %
        (PrintedError("3.14", "4.16"), 75.4, "holds"),
        (PrintedError("3.14", "4.18"), 75.4, "does not hold"),
    ],
)
def test_percentages(error, length, verdict):
    assert percentage(error, length, "").verdict == verdict
    derived = percentage(error, length, "", derived=True)
    assert derived.verdict == ("fitted" if verdict == "holds" else verdict)
