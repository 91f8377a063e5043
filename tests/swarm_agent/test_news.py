"""What an agent says in words, from one tick to the next."""

from __future__ import annotations

from typing import Any

from comms.status import Activity, AgentStatus, HelpCallStatus, Level
from swarm_agent.news import news


def status(**changes: Any) -> AgentStatus:
    return AgentStatus(**{"uid": 1, "activity": Activity.FOLLOW, **changes})


def texts(before: AgentStatus, now: AgentStatus) -> list[str]:
    return [event.text for event in news(before, now)]


def test_nothing_changed_nothing_said() -> None:
    same = status(tags=(1,), calls=(HelpCallStatus(1, 5.0),), helping=None)
    assert news(None, same) == ()
    assert news(same, status(tags=(1,), calls=(HelpCallStatus(1, 4.9),))) == ()


def test_targets_won_left_and_lost() -> None:
    assert texts(status(), status(tags=(3,))) == ["follows T3"]
    assert texts(status(helping=3), status(tags=(3,))) == ["captures T3"]
    assert texts(status(tags=(3,)), status()) == ["leaves T3 to a mate"]
    lost = news(status(tags=(3,)), status(calls=(HelpCallStatus(3, 0.0),)))
    assert [(event.level, event.text) for event in lost] == [(Level.WARNING, "has lost T3")]


def test_coming_home_leaves_nothing_to_a_mate() -> None:
    assert texts(status(tags=(3,)), status(activity=Activity.RETURNING)) == []


def test_help_called_and_given() -> None:
    call = (HelpCallStatus(3, 8.4),)
    assert texts(status(tags=(2, 3)), status(tags=(2, 3), calls=call)) == ["calls for help: T3, in 8 s"]
    offer = (HelpCallStatus(3, 20.0, urgent=False),)
    assert texts(status(tags=(2, 3)), status(tags=(2, 3), calls=offer)) == []
    assert texts(status(tags=(2, 3), calls=offer), status(tags=(2, 3), calls=call)) == ["calls for help: T3, in 8 s"]
    assert texts(status(), status(helping=3)) == ["goes to help with T3"]
    assert texts(status(helping=2), status(helping=3)) == ["goes to help with T3"]
