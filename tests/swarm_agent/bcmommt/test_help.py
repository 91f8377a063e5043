"""Help calls and answers (section 4.2.2): who calls, who answers, who lets go."""

from __future__ import annotations

import pytest

from swarm_agent.bcmommt.belief import FAR, NOBODY, Table, begin_tick, hear_answer, hear_mate, hear_tag
from swarm_agent.bcmommt.help import choose, is_called, is_lost, issue_calls, keeps, must_go, remember_losses
from swarm_agent.bcmommt.loss import predict_losses
from swarm_agent.bcmommt.params import Call, Gate, Params
from swarm_agent.bcmommt.tags import claim_tags
from tests.swarm_agent.bcmommt.scene import LAST_TICK, NOW, PAPER_WORLD, call, params, sense, table

P = PAPER_WORLD
ANY = params(gate=Gate.ALWAYS)
ME = 2


def chosen(t: Table, p: Params = ANY) -> int:
    return choose(t, p, ME, 0.0, 0.0, NOBODY, FAR, NOW)[0]


def calls(p: Params, *targets: tuple[float, float, float, float]) -> list[bool]:
    t = table(len(targets))
    for j, (x, y, vx, vy) in enumerate(targets):
        sense(t, j, x, y, vx, vy)
    predict_losses(t, p, claim_tags(t, p, ME, NOBODY, NOW))
    issue_calls(t, p, NOW)
    return list(t.calling)


def test_help_is_called_for_the_predicted_losses_but_never_for_the_nearest() -> None:
    fleeing = ((2.1, 0, 0.3, 0), (-2, 0, -0.3, 0))
    assert calls(P, *fleeing) == [True, False]
    assert calls(P, (2.1, 0, 0, 0), (-2, 0, 0, 0)) == [False, False]
    assert calls(P, (2.1, 0, 0.3, 0)) == [False]


def test_all_but_nearest_calls_without_a_prediction_too() -> None:
    p = params(call=Call.ALL_BUT_NEAREST)
    assert calls(p, (2.1, 0, 0, 0), (-2, 0, 0, 0), (0, 3, 0, 0)) == [True, False, True]


def test_the_closest_unanswered_call_is_chosen() -> None:
    t = table()
    call(t, 0, 0, 9.0, 0.0)
    call(t, 1, 1, 0.0, 8.0)
    call(t, 3, 1, 0.0, -8.5)
    assert chosen(t) == 1


def test_unanswered_calls_come_before_answered_ones() -> None:
    t = table()
    call(t, 0, 0, 6.0, 0.0)  # T_r 5.5 s
    call(t, 1, 1, 9.0, 0.0)
    hear_answer(t, P, 0, 4, 30.0, LAST_TICK)  # answered, though I would be quicker
    assert chosen(t) == 1
    hear_answer(t, P, 1, 4, 1.0, LAST_TICK)  # answered by somebody quicker
    assert chosen(t) == 0  # taken over from AH
    hear_answer(t, P, 0, 3, 2.0, LAST_TICK)
    assert chosen(t) == NOBODY


def test_an_equally_quick_answer_goes_to_the_lower_id() -> None:
    for mate, mine in [(1, NOBODY), (3, 0)]:
        t = table()
        call(t, 0, 0, 6.0, 0.0)
        hear_answer(t, P, 0, mate, 5.5, LAST_TICK)
        assert chosen(t) == mine


def test_the_gate_lets_pass_what_is_captured_before_it_is_lost() -> None:
    for loss_in, expected in [(5.6, 0), (5.4, NOBODY)]:
        t = table()
        call(t, 0, 0, 6.0, 0.0, loss_in=loss_in)  # T_r = 5.5 s
        assert chosen(t, P) == expected
        assert chosen(t, ANY) == 0


@pytest.mark.parametrize(("margin", "goes"), [(2.0, False), (4.4, False), (4.6, True)])
def test_a_helper_goes_when_waiting_longer_would_eat_the_margin(margin: float, goes: bool) -> None:
    t = table()
    call(t, 0, 0, 6.0, 0.0, loss_in=10.0)  # T_r 5.5 s: 4.5 s to spare
    assert must_go(t, params(help_margin_s=margin), 0, 5.5, NOW) is goes


def test_a_commitment_ends_when_the_call_is_withdrawn_expires_or_is_taken_over() -> None:
    t = table()
    call(t, 0, 1, 6.0, 0.0)
    assert keeps(t, P, 0, ME, 0.0, 0.0, 5.5, NOW)
    assert not keeps(t, P, 0, ME, 0.0, 0.0, 5.5, NOW + 1.0)  # the lease of 1 s has run out
    hear_answer(t, P, 0, 4, 5.6, LAST_TICK)
    assert keeps(t, P, 0, ME, 0.0, 0.0, 5.5, NOW)
    hear_answer(t, P, 0, 4, 5.4, LAST_TICK)
    assert not keeps(t, P, 0, ME, 0.0, 0.0, 5.5, NOW)
    hear_mate(t, 4, 0.0, 0.0, NOW)  # the rival says nothing of it any more
    assert keeps(t, P, 0, ME, 0.0, 0.0, 5.5, NOW)
    hear_mate(t, 1, 0.0, 0.0, NOW)  # the caller neither
    assert not keeps(t, P, 0, ME, 0.0, 0.0, 5.5, NOW)


def test_a_call_is_settled_once_somebody_else_follows_its_target() -> None:
    t = table()
    call(t, 0, 1, 6.0, 0.0)
    assert is_called(t, P, 0, 0.0, 0.0, NOW)
    hear_tag(t, P, 0, 3, 0.5, LAST_TICK)
    assert not is_called(t, P, 0, 0.0, 0.0, NOW)


def test_a_call_leads_nowhere_once_its_place_is_seen_to_be_empty() -> None:
    t = table()
    call(t, 0, 1, 6.0, 0.0)
    assert is_called(t, P, 0, 3.0, 0.0, NOW)  # 3 m away
    assert not is_called(t, P, 0, 4.0, 0.0, NOW)  # well within sight, and not there
    sense(t, 0, 6.0, 0.0)
    assert is_called(t, P, 0, 4.0, 0.0, NOW)


def lose(p: Params) -> Table:
    """Target 0 was mine and is out of sight one tick later, last seen 5.4 m east going east."""
    t = table()
    sense(t, 0, 5.4, 0.0, 0.3, 0.0)
    claim_tags(t, p, ME, NOBODY, NOW)
    begin_tick(t)
    remember_losses(t, p, 0.0, 0.0, NOW + 0.1)
    claim_tags(t, p, ME, NOBODY, NOW + 0.1)
    issue_calls(t, p, NOW + 0.1)
    return t


def test_a_lost_target_stays_a_call_for_its_memory() -> None:
    p = params(memory_s=60.0, gate=Gate.ALWAYS)
    t = lose(p)
    assert t.calling[0]
    assert choose(t, p, ME, 0.0, 0.0, NOBODY, FAR, NOW + 0.1)[0] == 0
    remember_losses(t, p, 0.0, 0.0, NOW + 59.0)
    assert is_lost(t, p, 0, NOW + 59.0)
    assert not is_lost(t, p, 0, NOW + 61.0)


def test_a_lost_target_is_let_go_when_a_mate_has_it_or_its_place_is_empty() -> None:
    p = params(memory_s=60.0)
    t = lose(p)
    hear_tag(t, p, 0, 4, 1.0, NOW + 0.1)
    remember_losses(t, p, 0.0, 0.0, NOW + 0.2)
    assert not is_lost(t, p, 0, NOW + 0.2)
    t = lose(p)
    remember_losses(t, p, 6.0, 0.0, NOW + 2.0)  # right where it should be by now: (6.0, 0)
    assert not is_lost(t, p, 0, NOW + 2.0)


def test_without_memory_a_lost_target_is_forgotten_within_the_tick_after() -> None:
    p = params(memory_s=0.0)
    t = lose(p)
    assert not t.calling[0]
