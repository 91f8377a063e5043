"""Coverage, definition 7's events and help episodes on a few ticks written by hand."""

from __future__ import annotations

from comms.status import Activity, AgentStatus, Event, HelpCallStatus, Level
from missions.coverage import Coverage
from missions.metrics import Metrics
from missions.observation import AgentTruth, Observation, Phase


def status(
    uid: int, *tags: int, calls: tuple[int, ...] = (), helping: int | None = None, activity: Activity = Activity.FOLLOW
) -> AgentStatus:
    return AgentStatus(
        uid=uid,
        activity=activity,
        tags=tags,
        calls=tuple(HelpCallStatus(j, 5.0) for j in calls),
        helping=helping,
    )


def fly(*ticks: tuple[AgentStatus, ...]) -> Metrics:
    metrics = Metrics()
    for tick, statuses in enumerate(ticks):
        metrics.observe(
            Observation(
                tick=tick,
                time_s=tick * 0.1,
                mission_tick=tick,
                phase=Phase.MISSION,
                statuses=statuses,
                truths=(),
                targets=(),
                tick_late_s=0.01 * tick,
            )
        )
    return metrics


def test_coverage_divides_sums_where_targets_come_and_go() -> None:
    coverage = Coverage()
    assert (coverage.now, coverage.mean, coverage.late) == (None, None, None)
    for seen, present in [(1, 1), (0, 3), (2, 2), (1, 2)]:
        coverage.add(seen=seen, present=present)
    assert coverage.now == 0.5
    assert coverage.mean == 4 / 8
    assert coverage.late == 0.5
    coverage.add(seen=0, present=0)
    assert coverage.now is None


def test_coverage_between_ticks_of_the_mission_whatever_is_missing() -> None:
    coverage = Coverage()
    for tick in (0, 1, 4, 5):
        coverage.add(seen=tick, present=10, tick=tick)
    assert coverage.between(0, 2) == 1 / 20
    assert coverage.between(2, 4) is None
    assert coverage.between(2, 6) == 9 / 20


def test_definition_7() -> None:
    metrics = fly(
        (status(0, 1, 2), status(1)),  # two discoveries
        (status(0, 1), status(1, 2)),  # a switch
        (status(0, 1), status(1, 2)),
        (status(0), status(1, 2)),  # a loss
        (status(0, 3), status(1)),  # a discovery and a loss
    )
    assert (metrics.events.target_discovery, metrics.events.tag_switch, metrics.events.target_loss) == (3, 1, 2)


def test_a_switch_with_both_claiming_for_a_moment_is_one_switch() -> None:
    metrics = fly((status(0, 1), status(1)), (status(0, 1), status(1, 1)), (status(0), status(1, 1)))
    assert metrics.events.tag_switch == 1
    assert metrics.events.target_loss == 0


def test_help_episodes() -> None:
    idle = status(1)
    metrics = fly(
        (status(0, 1, 2, calls=(2,)), idle, status(2)),
        (status(0, 1, 2, calls=(2,)), status(1, helping=2), status(2)),
        (status(0, 1, 2, calls=(2,)), status(1), status(2, helping=2)),  # taken over
        (status(0, 1), status(1), status(2, 2)),  # captured
        (status(0, 1, 2, calls=(2,)), status(1), status(2)),  # the old call, after a pause of 0.2 s
        *[(status(0, 1, 2), status(1), status(2))] * 10,
        (status(0, 1, 2, calls=(2,)), status(1), status(2)),  # a new one
    )
    assert (metrics.help.calls, metrics.help.answered) == (2, 2)
    assert (metrics.help.captured, metrics.help.taken_over) == (1, 1)


def test_who_goes_after_what_it_lost_itself_helps_nobody() -> None:
    metrics = fly(
        (status(0, 1, 2, calls=(2,)), status(1)),
        (status(0, 1, calls=(2,), helping=2), status(1, helping=2)),  # one pursues what it has lost, one helps
        (status(0, 1, 2), status(1, helping=2)),  # found again
        (status(0, 1, 2, calls=(2,)), status(1)),  # left to nobody
        (status(0, 1, calls=(2,), helping=2), status(1)),
        (status(0, 1, helping=2), status(1)),  # it goes on though its own call has expired
        (status(0, 1), status(1, 2)),
    )
    counts = metrics.help
    assert (counts.pursued, counts.found_again) == (2, 1)
    assert (counts.answered, counts.captured, counts.taken_over) == (1, 0, 0)


def test_faults_are_told_once_each_with_their_agent() -> None:
    lost = AgentStatus(uid=1, activity=Activity.LOST)
    crash = AgentStatus(uid=0, activity=Activity.LOST, events=(Event(Level.ERROR, "arming refused"),))
    metrics = fly((status(0), status(1)), (crash, lost), (crash.__class__(uid=0, activity=Activity.LOST), lost))
    assert [(fault.agent, fault.what) for fault in metrics.faults] == [
        (0, "arming refused"),
        (1, "leaves the mission: lost"),
    ]
    assert metrics.tick_late_s_max == 0.02


def test_an_agent_that_lands_during_the_mission_is_a_fault() -> None:
    metrics = fly((status(0),), (status(0, activity=Activity.RETURNING),), (status(0, activity=Activity.LANDED),))
    assert [fault.what for fault in metrics.faults] == ["leaves the mission: returning", "leaves the mission: landed"]


def test_two_drones_that_come_too_close_are_a_fault_once() -> None:
    metrics = Metrics()
    for tick, gap in enumerate([5.0, 0.9, 0.8, 5.0, 0.7]):
        metrics.observe(
            Observation(
                tick=5 * tick,
                time_s=0.5 * tick,
                mission_tick=5 * tick,
                phase=Phase.MISSION,
                statuses=(status(0), status(1), status(2)),
                truths=tuple(
                    AgentTruth(place, (0.0, 0.0, 0.0), 0.0) for place in [(0, 0, 10), (gap, 0, 10.5), (0, 0, 12)]
                ),
                targets=(),
            )
        )
    assert [(fault.time_s, fault.agent, fault.what) for fault in metrics.faults] == [(0.5, 1, "came within 1 m of A0")]
