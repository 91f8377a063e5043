"""What an agent says that goes home while the mission goes on."""

from __future__ import annotations

from comms.status import Level
from swarm_agent.bcmommt.belief import Table, hear_mate, hear_tag, new_table, see
from swarm_agent.bcmommt.params import Params
from swarm_agent.bcmommt.speech import calls_said, tags_said
from swarm_agent.farewell import WORTH_S, Farewell
from tests.swarm_agent.bcmommt.scene import PAPER_WORLD as PARAMS

ME, MATE = 0, 1


def on_duty(params: Params = PARAMS, *, follows: tuple[int, ...] = (1, 2)) -> Table:
    table = new_table(4, 3, 0)
    for target in follows:
        see(table, params, target, 1.0 + target, 0.0, 0.0, 0.0, 10.0)
        table.tagged[target] = True
    return table


def test_its_tags_are_calls_for_what_is_lost() -> None:
    table = on_duty()
    table.calling[3] = True  # lost before, and still missed
    see(table, PARAMS, 3, 9.0, 0.0, 0.0, 0.0, 9.0)
    farewell = Farewell(table)
    farewell.tick(table, PARAMS, 10.0)
    assert tags_said(table) == ()
    assert [(call.target, call.x_m, call.loss_in_s) for call in calls_said(table, PARAMS, 10.0)] == [
        (1, 2.0, 0.0), (2, 3.0, 0.0), (3, 9.0, 0.0),
    ]  # fmt: skip
    (event,) = farewell.take_events()
    assert (event.level, event.text) == (Level.WARNING, "leaves T1, T2, and calls until a mate follows")
    assert farewell.take_events() == ()


def test_it_calls_until_a_mate_follows() -> None:
    table = on_duty()
    farewell = Farewell(table)
    farewell.tick(table, PARAMS, 10.0)
    hear_mate(table, MATE, 0.0, 0.0, 10.1)
    hear_tag(table, PARAMS, 1, MATE, 2.0, 10.1)
    farewell.tick(table, PARAMS, 10.2)
    assert farewell.targets == {2}
    hear_mate(table, MATE, 0.0, 0.0, 10.3)
    hear_tag(table, PARAMS, 2, MATE, 2.0, 10.3)
    farewell.tick(table, PARAMS, 10.4)
    assert farewell.over
    assert calls_said(table, PARAMS, 10.4) == ()


def test_old_news_helps_nobody() -> None:
    params = PARAMS._replace(memory_s=0.0)
    table = on_duty(params)
    farewell = Farewell(table)
    for now_s, over in ((10.0, False), (10.0 + WORTH_S, False), (10.1 + WORTH_S, True)):
        farewell.tick(table, params, now_s)
        assert farewell.over is over


def test_who_follows_nobody_has_nothing_to_say() -> None:
    farewell = Farewell(on_duty(follows=()))
    assert farewell.over
    assert farewell.take_events() == ()
