"""What is heard of mates and targets that do not exist changes nothing."""

from __future__ import annotations

from copy import deepcopy

import pytest

from comms.messages import Answer, Frame, HelpCall, Tag
from swarm_agent.bcmommt.speech import hear
from tests.swarm_agent.bcmommt.scene import LAST_TICK, PAPER_WORLD, call, table

N_TARGETS, N_AGENTS = 4, 5


def frame(src: int, target: int) -> Frame:
    return Frame(
        src,
        1,
        LAST_TICK,
        0.5,
        (3.0, 4.0, 10.0),
        (0.0, 0.0, 0.0),
        (Tag(target, 1.0, 2.0, 0.0, 0.0, 0.5),),
        (HelpCall(target, 1.0, 2.0, 0.0, 0.0, 5.0, 0.0),),
        (Answer(target, 2.0),),
    )


@pytest.mark.parametrize("src", [N_AGENTS, 65_535])
def test_a_mate_that_does_not_exist_is_not_heard(src: int) -> None:
    t = table(N_TARGETS, N_AGENTS)
    call(t, 1, 2, 5.0, 0.0)
    before = deepcopy(t)
    hear(t, PAPER_WORLD, [frame(src, 1)])
    assert t == before


@pytest.mark.parametrize("target", [N_TARGETS, 65_535])
def test_a_call_for_a_target_that_does_not_exist_is_not_heard(target: int) -> None:
    t, silent = table(N_TARGETS, N_AGENTS), table(N_TARGETS, N_AGENTS)
    hear(t, PAPER_WORLD, [frame(2, target)])
    hear(silent, PAPER_WORLD, [frame(2, target)._replace(tags=(), help_calls=(), answers=())])
    assert t == silent
    assert t.mate_at_s[2] == LAST_TICK  # its place is believed


def test_what_exists_is_heard() -> None:
    t = table(N_TARGETS, N_AGENTS)
    hear(t, PAPER_WORLD, [frame(4, 3)])
    assert (t.owner[3], t.caller[3], t.answerer[3]) == (4, 4, 4)
