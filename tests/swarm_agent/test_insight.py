"""What an agent tells of its knowledge: what still holds in its table, and why it does what it does."""

from __future__ import annotations

from math import hypot

import pytest

from comms.knowledge import Belief, Knowledge
from swarm_agent.bcmommt.belief import NOBODY, SHOWN_S, Table, hear_answer, hear_position
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Gate, Params
from swarm_agent.bcmommt.step import Mind, decide, new_mind
from swarm_agent.insight import insight
from swarm_agent.reasons import Reasons
from tests.swarm_agent.bcmommt.scene import LAST_TICK, NOW, PAPER_WORLD, call, claim, params, sense, table

ME = 1


def decided(t: Table, p: Params = PAPER_WORLD, now: float = NOW) -> tuple[Mind, Knowledge]:
    """What agent 1 at the origin decides, and what it tells then."""
    mind, east, north = decide(t, p, new_mind(0.0, 1.0), ME, 0.0, 0.0, now, 1, 7)
    reasons = Reasons(t, p, mind, ME, 0.0, 0.0, now)
    return mind, insight(reasons, wanted_m_s=(east, north), mavlink=(b"frame",))


def belief(knowledge: Knowledge, target: int) -> Belief:
    return next(belief for belief in knowledge.beliefs if belief.target == target)


def test_who_knows_nothing_says_so() -> None:
    mind, known = decided(table())
    assert mind.mode is Mode.EXPLORE
    assert (known.beliefs, known.mates) == ((), ())
    assert known.why.endswith("it hears no call for help")
    assert known.mavlink == (b"frame",)
    assert hypot(*known.wanted_m_s) == pytest.approx(PAPER_WORLD.agent_speed_m_s)


def test_own_targets_and_those_of_mates() -> None:
    t = table()
    sense(t, 0, 1.0, 0.0)
    call(t, 2, mate=3, x=9.0, y=0.0, loss_in=6.0)
    _, known = decided(t)
    assert [b.target for b in known.beliefs] == [0, 2]
    mine, theirs = belief(known, 0), belief(known, 2)
    assert (mine.sensed, mine.owner, mine.caller, mine.age_s) == (True, ME, None, 0.0)
    assert (theirs.sensed, theirs.owner, theirs.caller) == (False, 3, 3)
    assert theirs.loss_in_s == pytest.approx(6.0)
    assert theirs.age_s == pytest.approx(0.1)
    assert known.why == "follows T0"


def test_a_moving_target_is_believed_where_it_went() -> None:
    t = table()
    hear_position(t, 1, 4.0, 0.0, 0.2, -0.1, NOW - 5.0)
    _, known = decided(t)
    assert belief(known, 1).place_m == pytest.approx((5.0, -0.5))


@pytest.mark.parametrize(("age_s", "told"), [(SHOWN_S - 0.1, True), (SHOWN_S + 0.1, False)])
def test_old_news_is_not_told(age_s: float, told: bool) -> None:
    t = table()
    hear_position(t, 1, 4.0, 0.0, 0.0, 0.0, NOW - age_s)
    _, known = decided(t)
    assert bool(known.beliefs) is told


def test_a_helper_says_for_whom_and_until_when() -> None:
    t, p = table(), params(gate=Gate.ALWAYS)
    call(t, 2, mate=3, x=9.0, y=0.0, loss_in=6.0)
    mind, known = decided(t, p)
    assert (mind.mode, mind.helping) == (Mode.HELP, 2)
    assert known.why == f"flies to T2: A3 loses it in 6 s, there in {mind.capture_s:.0f} s"
    assert belief(known, 2).answerer == ME
    assert belief(known, 2).capture_s == mind.capture_s


def test_who_does_not_help_says_why() -> None:
    t = table()
    call(t, 2, mate=3, x=25.0, y=0.0, loss_in=6.0)
    mind, known = decided(t)
    assert mind.helping == NOBODY
    assert known.why.endswith("it does not help with T2 (it cannot be there in time)")
    call(t, 1, mate=4, x=6.0, y=0.0)
    hear_answer(t, PAPER_WORLD, 1, 0, 0.5, LAST_TICK)
    _, known = decided(t)
    assert known.why.endswith("T1 (A0 is quicker, there in 0 s) and T2 (it cannot be there in time)")


def test_who_follows_several_says_whom_it_expects_to_lose() -> None:
    t = table()
    sense(t, 0, 1.0, 0.0)
    sense(t, 2, -4.0, 0.0, vx=-0.6)
    _, known = decided(t)
    # 3 m to the edge of what it sees from their middle, which follows half as fast.
    assert belief(known, 2).loss_in_s == pytest.approx(10.0)
    assert known.why == "stays amid T0 and T2; calls, for it expects to lose T2 in 10 s"


def test_what_has_run_out_is_not_told() -> None:
    t = table()
    claim(t, 2, mate=3, distance=1.0, at=NOW - 2 * PAPER_WORLD.tag_lease_s)
    hear_position(t, 2, 3.0, 0.0, 0.0, 0.0, NOW - 2 * PAPER_WORLD.tag_lease_s)
    _, known = decided(t)
    assert belief(known, 2).owner is None
