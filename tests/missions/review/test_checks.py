"""Conditions for scripts: what holds, what does not, and what is none."""

from __future__ import annotations

import pytest

from missions.cli import main
from missions.problems import InputError
from missions.review.checks import judge, numbers_of
from tests.missions.review.conftest import Flown

NUMBERS = {"coverage": 0.9, "help.calls": 12.0, "faults": 0.0, "coverage_late": None}


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ("coverage > .8", True),
        ("coverage>0.9", False),
        ("coverage >= 90%", True),
        ("coverage < 9e-1", False),
        (".8 < coverage", True),
        ("help.calls == 12", True),
        ("help.calls != 12", False),
        ("faults <= 0 and coverage > .5 and help.calls < 13", True),
        ("faults <= 0 AND coverage > .5 and help.calls < 12", False),
        ("coverage_late > 0", False),
        ("coverage_late <= 0", False),
        ("coverage > -1", True),
    ],
)
def test_conditions(condition: str, holds: bool) -> None:
    assert judge(condition, NUMBERS).holds is holds


@pytest.mark.parametrize(
    ("condition", "told"),
    [
        ("", "comparisons such as coverage > .9"),
        ("coverage", "comparisons such as"),
        ("coverage >", "comparisons such as"),
        ("coverage > .9 and", "joined by and"),
        ("coverage > .9 or faults < 1", "comparisons such as"),
        ("coverage > .9 faults < 1", "comparisons such as"),
        ("covrage > .9", "did you mean coverage"),
        ("coverage = .9", "'= .9'"),
        ("__import__('os').system('true') > 0", "a number, a name"),
        ("coverage > 1" * 2000, "comparisons such as"),
        ("coverage < > 1", "comparisons such as"),
    ],
)
def test_what_is_no_condition_says_what_is_allowed(condition: str, told: str) -> None:
    with pytest.raises(InputError) as raised:
        judge(condition, NUMBERS)
    assert told in str(raised.value)
    assert len(str(raised.value)) < 500


def test_numbers_of_a_report_have_dotted_names(flown: Flown) -> None:
    numbers = numbers_of(flown.report)
    assert numbers["help.calls"] == flown.report["help"]["calls"]
    assert numbers["mavlink.vehicles.received"] == flown.report["mavlink"]["vehicles"]["received"]
    assert numbers["faults"] == len(flown.report["faults"])
    assert "mission" not in numbers


def test_exit_codes(flown: Flown, capsys: pytest.CaptureFixture[str]) -> None:
    review = ["review", str(flown.recording), "--check"]
    assert main([*review, "coverage > 0"]) == 0
    assert main([*review, "coverage > 0", "--check", "coverage > 2"]) == 1
    assert "FAILS: coverage > 2" in capsys.readouterr().out
    assert main([*review, "coverage"]) == 2
