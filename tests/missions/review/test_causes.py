"""Losses and calls are told with their true causes: cases made by hand, tick by tick."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from comms.status import Activity, AgentStatus, Event, HelpCallStatus, Level
from missions.observation import AgentTruth, Observation, Phase, TargetTruth
from missions.review.calls import Fate
from missions.review.losses import Loss
from missions.review.story import Story
from missions.review.timeline import loss_words

_TICK_S = 0.2
CALL = HelpCallStatus(target=0, loss_in_s=4.0, urgent=True)
TARGET = TargetTruth(x_m=10.0, y_m=0.0, present=True, seen=True)


def _agent(uid: int, activity: Activity = Activity.FOLLOW, **doing: object) -> AgentStatus:
    return AgentStatus(uid=uid, activity=activity, **doing)  # type: ignore[arg-type]


def _seen(tick: int, *statuses: AgentStatus, target: TargetTruth = TARGET, near: bool = True) -> Observation:
    """Agent 0 is at the target, agent 1 five meters off; they hear each other if `near`."""
    truths = tuple(AgentTruth((10.0 - 5.0 * uid, 0.0, 10.0), (0.0, 0.0, 0.0), 0.0) for uid in range(len(statuses)))
    return Observation(
        tick=tick,
        time_s=tick * _TICK_S,
        phase=Phase.MISSION,
        mission_tick=tick,
        statuses=statuses,
        truths=truths,
        targets=(target,),
        links=((0, 1),) if near else (),
    )


def _told(observations: Sequence[Observation]) -> Story:
    story = Story(speed_m_s=1.0, sensing_range_m=4.0)
    for seen in observations:
        story.observe(seen)
    return story


def _losses(observations: Sequence[Observation]) -> Sequence[Loss]:
    return _told(observations).losses


def test_a_target_that_left_the_world_is_nobodys_failure() -> None:
    gone = replace(TARGET, present=False, seen=False)
    has, lacks = _agent(0, tags=(0,)), _agent(0, Activity.EXPLORE)
    idle = _agent(1, Activity.EXPLORE)
    (loss,) = _losses([_seen(0, has, idle), _seen(1, lacks, idle, target=gone)])
    assert loss.left
    assert loss_words(loss) == "T0 has left the arena"
    assert loss.chances == ()


def test_who_could_have_come_heard_a_call_only_if_it_was_out_by_then() -> None:
    idle = _agent(1, Activity.EXPLORE)
    quiet, calling, lost = _agent(0, tags=(0,)), _agent(0, tags=(0,), calls=(CALL,)), _agent(0, Activity.EXPLORE)
    # One meter is missing, at one meter a second: agent 1 had to leave a second before the loss.
    for ticks, near, words in (
        ((calling,) * 10, True, "it heard the call"),
        ((*(quiet,) * 9, calling), True, "nobody had called by then"),
        ((quiet,) * 10, True, "nobody had called by then"),
        ((calling,) * 10, False, "it was out of earshot"),
    ):
        seen = [_seen(tick, status, idle, near=near) for tick, status in enumerate((*ticks, lost))]
        (loss,) = _losses(seen)
        assert loss.chances[0].leave_by_s == loss.time_s - 1.0
        assert loss_words(loss).endswith(f"leaving 1.0 s before; {words}")


def test_a_call_that_comes_again_after_a_pause_is_another_and_both_have_an_end() -> None:
    quiet, calling = _agent(0, tags=(0,)), _agent(0, tags=(0,), calls=(CALL,))
    # Out from 0.0 to 0.4 s, silent for more than a second, out at 1.6 s, and silent again.
    said = [calling] * 3 + [quiet] * 5 + [calling] + [quiet] * 8
    first, second = _told([_seen(tick, status, _agent(1)) for tick, status in enumerate(said)]).calls
    assert (first.began_s, first.ended_s, first.fate) == (0.0, 0.4, Fate.KEPT)
    assert (second.began_s, second.fate) == (1.6, Fate.KEPT)


def test_nobody_helps_itself() -> None:
    calling, after = _agent(0, tags=(0,), calls=(CALL,)), _agent(0, Activity.HELPING, helping=0, calls=(CALL,))
    again = _agent(0, tags=(0,))
    said = [calling] * 3 + [after] * 3 + [again] * 8
    (call,) = _told([_seen(tick, status, _agent(1)) for tick, status in enumerate(said)]).calls
    assert call.helpers == []
    assert (call.fate, call.owner) == (Fate.KEPT, 0)


def test_echoes_are_routine_and_not_forgotten() -> None:
    def says(level: Level) -> AgentStatus:
        return _agent(0, tags=(0,), events=(Event(level, "calls for help: T0, in 4 s"),))

    calls = [_seen(tick, says(Level.WARNING), _agent(1)) for tick in range(3)]
    assert [line.routine for line in _told(calls).lines] == [False, True, True]
    errors = [_seen(tick, says(Level.ERROR), _agent(1)) for tick in range(3)]
    assert not any(line.routine for line in _told(errors).lines)
