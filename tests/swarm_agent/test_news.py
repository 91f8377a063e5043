"""What an agent says in words, from one tick to the next."""

from __future__ import annotations

from typing import Any

import pytest

from comms.status import Activity, AgentStatus, Event, HelpCallStatus, Level
from swarm_agent import news as told
from swarm_agent.bcmommt.belief import Table, hear_answer
from swarm_agent.bcmommt.step import new_mind
from swarm_agent.reasons import Reasons
from tests.swarm_agent.bcmommt.scene import LAST_TICK, NOW, PAPER_WORLD, call, claim, sense, table


def reasons(t: Table | None = None, **changes: Any) -> Reasons:
    """Of agent 1, at the origin."""
    mind = new_mind(0.0, 1.0)._replace(**changes)
    return Reasons(table() if t is None else t, PAPER_WORLD, mind, 1, 0.0, 0.0, NOW)


def news(before: AgentStatus | None, now: AgentStatus, why: Reasons | None = None) -> tuple[Event, ...]:
    return told.news(before, now, why or reasons())


def status(**changes: Any) -> AgentStatus:
    return AgentStatus(**{"uid": 1, "activity": Activity.FOLLOW, **changes})


def texts(before: AgentStatus, now: AgentStatus, why: Reasons | None = None) -> list[str]:
    return [event.text for event in news(before, now, why)]


def test_nothing_changed_nothing_said() -> None:
    same = status(tags=(1,), calls=(HelpCallStatus(1, 5.0),), helping=None)
    assert news(None, same) == ()
    assert news(same, status(tags=(1,), calls=(HelpCallStatus(1, 4.9),))) == ()


def test_targets_won_left_and_lost() -> None:
    assert texts(status(), status(tags=(3,))) == ["follows T3"]
    assert texts(status(helping=3), status(tags=(3,))) == ["captures T3"]
    t = table()
    claim(t, 3, mate=2, distance=1.25)
    left = texts(status(tags=(3,)), status(), reasons(t))
    assert left == ["leaves T3 to a mate: A2 is nearer, at 1.2 m"]


def test_a_lost_target_is_told_with_where_it_was_and_what_kept_the_agent() -> None:
    t = table()
    sense(t, 3, 3.0, 4.0)
    sense(t, 2, 1.0, 0.0)
    t.tagged[2] = True
    lost = news(status(tags=(2, 3)), status(tags=(2,), calls=(HelpCallStatus(3, 0.0),)), reasons(t))
    text = "has lost T3: last seen 5.0 m away, of 5.5 m in sight while it followed T2"
    assert [(event.level, event.text) for event in lost] == [(Level.WARNING, text)]


def test_coming_home_leaves_nothing_to_a_mate() -> None:
    assert texts(status(tags=(3,)), status(activity=Activity.RETURNING)) == []


def test_help_called() -> None:
    call = (HelpCallStatus(3, 8.4),)
    assert texts(status(tags=(2, 3)), status(tags=(2, 3), calls=call)) == ["calls for help: T3, in 8 s"]
    offer = (HelpCallStatus(3, 20.0, urgent=False),)
    assert texts(status(tags=(2, 3)), status(tags=(2, 3), calls=offer)) == []
    assert texts(status(tags=(2, 3), calls=offer), status(tags=(2, 3), calls=call)) == ["calls for help: T3, in 8 s"]


@pytest.mark.parametrize(
    ("loss_in_s", "said"), [(10.0, "A2 loses it in 10 s"), (0.0, "A2 has lost it"), (20.0, "A2 offers it")]
)
def test_help_given_says_who_called_and_how_soon(loss_in_s: float, said: str) -> None:
    t = table()
    call(t, 3, mate=2, x=9.0, y=0.0, loss_in=loss_in_s)
    goes = texts(status(helping=2), status(helping=3), reasons(t, helping=3, capture_s=4.2))
    assert goes[-1] == f"goes to help with T3: {said}, there in 4 s"


def test_help_given_up_says_why() -> None:
    t = table()
    assert texts(status(helping=3), status(), reasons(t)) == ["gives up T3: the call has ended"]
    call(t, 3, mate=2, x=6.0, y=0.0)
    hear_answer(t, PAPER_WORLD, 3, 4, 1.5, LAST_TICK)
    assert texts(status(helping=3), status(), reasons(t)) == ["gives up T3: A4 is quicker, there in 2 s"]
    claim(t, 3, mate=4, distance=0.5)
    assert texts(status(helping=3), status(), reasons(t)) == ["gives up T3: A4 follows it"]
    assert texts(status(helping=3), status(tags=(3,)), reasons(t)) == ["captures T3"]
