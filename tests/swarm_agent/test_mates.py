"""What an agent notices of its mates' radio, by hand: frames every 0.1 s, range 20 m, time to live 0.5 s."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import pytest

from comms.messages import Frame
from swarm_agent.mates import Mates

HERE = (0.0, 0.0, 10.0)


def frame(tick: int, *, src: int = 3, x_m: float = 5.0, east_m_s: float = 0.0, delay_s: float = 0.1) -> Frame:
    return Frame(src, tick, tick * 0.1 - delay_s, 0.5, (x_m, 0.0, 12.0), (east_m_s, 0.0, 0.0))


def flown(ticks: Iterable[int], heard: Callable[[int], list[Frame]]) -> tuple[Mates, dict[int, str]]:
    """The mates after these ticks, and what was told at which."""
    mates, said = Mates(range_m=20.0, ttl_s=0.5), {}
    for tick in ticks:
        mates.hear(tick * 0.1, HERE, heard(tick))
        for event in mates.take_events():
            said[tick] = event.text
    return mates, said


def test_all_is_well_without_a_word() -> None:
    assert flown(range(300), lambda tick: [frame(tick)])[1] == {}


def test_a_mate_that_falls_silent_nearby_is_missed_after_a_second_and_welcomed_back() -> None:
    mates, said = flown(range(200), lambda tick: [] if 50 < tick < 120 else [frame(tick)])
    assert said == {61: "no word from A3 for 1 s, though it was near", 120: "hears A3 again"}
    assert mates.missing == set()


@pytest.mark.parametrize(
    ("x_m", "east_m_s", "missed"),
    [(14.9, 0.0, True), (15.1, 0.0, False), (14.5, 1.0, False), (16.0, -2.0, True), (19.0, 0.0, False)],
)
def test_a_mate_that_may_have_flown_out_of_range_is_not_missed(x_m: float, east_m_s: float, missed: bool) -> None:
    mates, _ = flown(range(100), lambda tick: [] if tick > 50 else [frame(50, x_m=x_m, east_m_s=east_m_s)])
    assert mates.missing == ({3} if missed else set())


@pytest.mark.parametrize(("every", "told"), [(2, True), (4, True), (6, False), (20, False)])
def test_losses_are_told_by_the_gaps_in_the_numbers(every: int, told: bool) -> None:
    # Of `every` frames one is lost: 50, 25, 17, 5 %; what is told is more than 20 %.
    _, said = flown(range(600), lambda tick: [] if tick % every == 0 else [frame(tick)])
    assert any("reception is poor" in text for text in said.values()) is told
    assert not any("no word" in text for text in said.values())


def test_what_was_said_while_a_mate_was_away_is_no_loss() -> None:
    _, said = flown(range(600), lambda tick: [] if 100 < tick < 400 else [frame(tick, x_m=19.0)])
    assert said == {}


def test_late_frames_are_told_and_prompt_ones_again() -> None:
    _, said = flown(range(600), lambda tick: [frame(tick, delay_s=0.4 if 100 <= tick < 300 else 0.1)])
    (poor, words), (good, again) = said.items()
    assert 100 < poor < 150
    assert words == "reception is poor: 0% of mates' frames lost, 0.3 s old"
    assert 300 < good < 400
    assert again == "reception is good again"


def test_a_stranger_number_or_clock_does_no_harm() -> None:
    odd = [frame(1)._replace(seq=2**52), frame(1, src=60000), frame(1)._replace(sent_at_s=9e9, seq=0)]
    mates, said = flown(range(50), lambda tick: odd if tick % 2 else [])
    assert len(said) <= 1
    assert mates.missing <= {3, 60000}
