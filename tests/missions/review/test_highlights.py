"""What stands out: the weightiest, told with its cause, and nothing where nothing happened."""

from __future__ import annotations

from dataclasses import replace

from missions.review.calls import Call, Fate
from missions.review.highlights import highlights, told
from missions.review.losses import Chance, Loss
from missions.review.reading import Review
from tests.missions.review.conftest import Flown


def _loss(**changes: object) -> Loss:
    plain = {
        "time_s": 60.0,
        "target": 7,
        "owners": (1,),
        "owners_gone": False,
        "left": False,
        "place_m": (10.0, 20.0),
        "call": None,
        "helpers": (),
    }
    return Loss(**{**plain, "chances": (), "found_after_s": 30.0, **changes})  # type: ignore[arg-type]


def _quiet(flown: Flown) -> Review:
    report = {**flown.review.report, "injected": []}
    return replace(flown.review, report=report, losses=[], calls=[])


def test_nothing_stands_out_where_nothing_happened(flown: Flown) -> None:
    assert highlights(_quiet(flown)) == []
    brief = replace(_quiet(flown), losses=[_loss(found_after_s=0.4)])
    assert highlights(brief) == []


def test_a_long_loss_is_told_with_its_cause(flown: Flown) -> None:
    chance = Chance(agent=4, leave_by_s=55.0, distance_m=8.0, in_touch=True, called=True)
    for loss, words in (
        (_loss(owners_gone=True), "T7 is lost for 30 s: A1, which had it, was out"),
        (_loss(chances=(chance,)), "it got away from A1; A4 was free and near enough: it heard the call"),
        (_loss(helpers=(3,)), "it got away from A1; A3 came too late"),
        (_loss(found_after_s=None), "T7 is lost for good: it got away from A1, and nobody free was near enough"),
    ):
        (only,) = highlights(replace(_quiet(flown), losses=[loss]))
        assert told(only)[0] == "1:00.0"
        assert told(only)[1].endswith(words)


def test_the_longest_losses_are_told_in_order_of_time(flown: Flown) -> None:
    losses = [_loss(time_s=50.0 + number, target=number, found_after_s=11.0 + 10 * number) for number in range(9)]
    found = highlights(replace(_quiet(flown), losses=losses[::-1]))
    assert [one.text.split()[0] for one in found] == ["T5", "T6", "T7", "T8"]


def test_a_fault_is_told_only_if_it_cost_something(flown: Flown) -> None:
    fault = {"what": "kill", "whom": "A1", "at_s": 25.0, "until_s": 35.0}
    cost = {**fault, "coverage": {"before": 0.97, "during": 0.67, "after": None}}
    free = {**fault, "coverage": {"before": 0.97, "during": 0.95, "after": 0.99}}
    report = {**flown.review.report, "injected": [free, cost]}
    (only,) = highlights(replace(_quiet(flown), report=report, began_s=14.0))
    assert told(only) == (
        "0:39.0",
        "kill, A1: 97.0 % of the targets were seen before, 67.0 % meanwhile",
    )


def test_calls_in_vain_are_counted(flown: Flown) -> None:
    calls = [Call(1, 7, 20.0, 25.0, True, 4.0, fate=fate) for fate in (Fate.LOST, Fate.KEPT, Fate.LOST)]
    (only,) = highlights(replace(_quiet(flown), calls=calls))
    assert told(only) == ("", "2 of 3 help calls ended with the target lost")
