"""Algorithm 1 as a whole: modes, and laws that hold for every situation."""

from __future__ import annotations

from math import cos, hypot, sin
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comms.messages import Answer, Frame, HelpCall, Tag
from swarm_agent.bcmommt.belief import NOBODY, Table, begin_tick, cell_columns, cell_rows, hear_mate, new_table, see
from swarm_agent.bcmommt.modes import Mode
from swarm_agent.bcmommt.params import Call, Capture, Explore, Gate, Params
from swarm_agent.bcmommt.speech import answers_said, calls_said, hear, tags_said
from swarm_agent.bcmommt.step import Mind, decide, new_mind
from tests.examples import MANY
from tests.swarm_agent.bcmommt.scene import NOW, PAPER_WORLD, call, claim, params, sense, table

P = PAPER_WORLD
ME, SEED, TICK = 2, 1, 100


def act(t: Table, p: Params = P, mind: Mind | None = None, tick: int = TICK) -> tuple[Mind, float, float]:
    return decide(t, p, mind or new_mind(1.0, 0.0), ME, 0.0, 0.0, NOW, SEED, tick)


def test_with_a_tag_it_follows_the_center_of_gravity_with_its_motion() -> None:
    t = table()
    sense(t, 0, 0.2, 0.0, 0.1, 0.0)
    sense(t, 1, 0.0, 0.2, 0.1, 0.0)
    mind, vx, vy = act(t)
    assert mind.mode is Mode.FOLLOW
    assert (vx, vy) == pytest.approx((0.1 + 0.1, 0.1))  # 0.1 m off in both axes, at 1/s, plus 0.1 m/s east


def test_following_far_targets_is_capped_at_the_speed_limit() -> None:
    t = table()
    sense(t, 0, 3.0, 4.0)
    _, vx, vy = act(t)
    assert (vx, vy) == pytest.approx((0.24, 0.32))


def test_a_standoff_is_kept() -> None:
    t = table()
    sense(t, 0, 0.3, 0.0)
    _, vx, vy = act(t, params(standoff_m=0.5))
    assert (vx, vy) == pytest.approx((-0.2, 0.0))


def test_without_tags_it_helps_whom_it_can_and_says_so() -> None:
    t = table()
    call(t, 1, 0, 0.0, 6.0, loss_in=7.0)
    mind, vx, vy = act(t)
    assert (mind.mode, mind.helping, mind.capture_s) == (Mode.HELP, 1, 5.5)
    assert (vx, vy) == pytest.approx((0.0, 0.4))  # 5.5 > 7 - 2: it goes
    assert answers_said(mind) == (Answer(1, 5.5),)


def test_a_helper_with_time_explores_on_but_is_committed() -> None:
    t = table()
    call(t, 1, 0, 0.0, 6.0, loss_in=19.0)
    mind, vx, _ = act(t)
    assert mind.mode is Mode.HELP
    assert vx > 0.35  # the walk goes on east
    call(t, 3, 0, 0.0, -5.6, loss_in=19.0)  # a closer call does not tempt it
    assert act(t, P, mind)[0].helping == 1
    assert act(t, params(commitment=False), mind)[0].helping == 3


def test_the_first_tag_ends_helping() -> None:
    t = table()
    call(t, 1, 0, 0.0, 6.0, loss_in=7.0)
    mind, _, _ = act(t)
    sense(t, 3, 1.0, 0.0)
    mind, _, _ = act(t, P, mind)
    assert (mind.mode, mind.helping) == (Mode.FOLLOW, NOBODY)


def test_with_nothing_to_do_it_explores_at_full_speed_away_from_mates() -> None:
    t = table()
    mind, heading_x = new_mind(0.0, 1.0), 0.0
    for tick in range(100):
        hear_mate(t, 0, 2.0, 0.0, NOW)
        mind, vx, vy = act(t, P, mind, tick)
        assert mind.mode is Mode.EXPLORE
        assert hypot(vx, vy) == pytest.approx(0.4)
        heading_x = mind.heading_x
    assert heading_x < -0.8


def test_stale_first_flies_to_the_near_unseen_and_leaves_a_mate_its_side() -> None:
    p = params(explore=Explore.STALE_FIRST)
    t = table(n_cells=cell_columns(p) * cell_rows(p))
    hear_mate(t, 0, -2.0, 0.0, NOW)
    mind, vx, _ = act(t, p)
    assert vx > 0.0
    assert mind.goal != NOBODY
    assert act(t, p, mind)[0].goal == mind.goal  # it keeps its goal until somebody has seen it


coordinate = st.floats(-5.4, 5.4).map(lambda x: round(x, 3))
velocity = st.floats(-0.3, 0.3).map(lambda v: round(v, 3))
spot = st.tuples(coordinate, coordinate, velocity, velocity)
settings_of_rules = st.builds(
    params,
    call=st.sampled_from(Call),
    gate=st.sampled_from(Gate),
    capture=st.sampled_from(Capture),
    explore=st.sampled_from(Explore),
    commitment=st.booleans(),
    memory_s=st.sampled_from([0.0, 60.0]),
    standoff_m=st.sampled_from([0.0, 0.5]),
)
target_ids = st.integers(0, 5)
heard = st.lists(
    st.builds(
        Frame,
        src=st.integers(0, 4).filter(lambda src: src != ME),
        seq=st.just(1),
        sent_at_s=st.just(NOW - 0.1),
        ttl_s=st.just(1.0),
        position_m=st.tuples(coordinate, coordinate, coordinate),
        velocity_m_s=st.just((0.0, 0.0, 0.0)),
        tags=st.lists(
            st.builds(Tag, target_ids, coordinate, coordinate, velocity, velocity, st.floats(0, 5.5)), max_size=3
        ).map(tuple),
        help_calls=st.lists(
            st.builds(
                HelpCall, target_ids, coordinate, coordinate, velocity, velocity, st.floats(0, 20), st.floats(0, 5)
            ),
            max_size=3,
        ).map(tuple),
        answers=st.lists(st.builds(Answer, target_ids, st.floats(0.5, 60)), max_size=1).map(tuple),
    ),
    max_size=4,
)


@MANY
@given(settings_of_rules, st.lists(st.none() | spot, min_size=4, max_size=4), heard, st.floats(0, 6.28))
def test_laws_of_every_decision(
    p: Params, spots: list[tuple[float, float, float, float] | None], frames: list[Frame], angle: float
) -> None:
    t = new_table(4, 5, cell_columns(p) * cell_rows(p))  # frames speak of targets 4 and 5, which it does not know
    begin_tick(t)
    hear(t, p, frames)
    for j, here in enumerate(spots):
        if here is not None:
            see(t, p, j, here[0], here[1], 0.0, 0.0, NOW)
    mind, vx, vy = decide(t, p, new_mind(cos(angle), sin(angle)), ME, 0.0, 0.0, NOW, SEED, TICK)
    assert hypot(vx, vy) <= p.agent_speed_m_s + 1e-9
    assert (mind.mode is Mode.FOLLOW) == any(t.tagged)
    assert (mind.mode is Mode.HELP) == (mind.helping != NOBODY)
    assert not any(tagged and not sensed for tagged, sensed in zip(t.tagged, t.sensed, strict=True))
    tags, calls = tags_said(t), calls_said(t, p, NOW)
    assert {c.target for c in calls} <= {tag.target for tag in tags}  # nothing was lost yet
    assert len(calls) < max(len(tags), 1)  # never for the nearest
    assert all(0.0 <= c.loss_in_s <= p.horizon_s for c in calls)
    assert hypot(mind.heading_x, mind.heading_y) == pytest.approx(1.0)


@given(heard, st.randoms(use_true_random=False))
def test_the_order_of_frames_does_not_matter(frames: list[Frame], shuffler: Random) -> None:
    frames = list({frame.src: frame for frame in frames}.values())
    tables = []
    for order in (frames, shuffler.sample(frames, len(frames))):
        t = new_table(6, 5, 0)
        hear(
            t, P, [Frame(src, 1, NOW - 0.2, 1.0, (0.0,) * 3, (0.0,) * 3, (Tag(0, 1, 1, 0, 0, 1.0),)) for src in (0, 1)]
        )
        hear(t, P, order)
        tables.append((t.owner, t.owner_distance_m, t.caller, t.call_loss_at_s, t.answerer, t.answer_capture_s))
    assert tables[0] == tables[1]


def test_a_claim_withdrawn_by_one_mate_does_not_shadow_anothers() -> None:
    t = table()
    near, far = (Tag(0, 1.0, 0.0, 0.0, 0.0, d) for d in (1.0, 2.0))
    both = [
        Frame(1, 1, 9.8, 1.0, (0.0,) * 3, (0.0,) * 3, (far,)),
        Frame(2, 1, 9.8, 1.0, (0.0,) * 3, (0.0,) * 3, (near,)),
    ]
    hear(t, P, both)
    assert t.owner[0] == 2
    hear(t, P, [both[0]._replace(sent_at_s=9.9), both[1]._replace(sent_at_s=9.9, tags=())])
    assert t.owner[0] == 1


def test_a_target_that_outruns_its_helper_is_let_go() -> None:
    t = table()
    call(t, 1, 0, 0.0, 6.0, loss_in=7.0)
    mind, _, _ = act(t)
    assert mind.helping == 1
    t.vy_m_s[1] = 5.0
    mind, _, _ = act(t, params(capture=Capture.INTERCEPT, gate=Gate.ALWAYS), mind)
    assert (mind.mode, mind.helping) == (Mode.EXPLORE, NOBODY)


@given(st.lists(spot, min_size=1, max_size=3), st.floats(0, 6.28))
def test_turning_the_world_turns_the_decision(spots: list[tuple[float, float, float, float]], angle: float) -> None:
    c, s = cos(angle), sin(angle)
    plain, turned = table(), table()
    for j, (x, y, vx, vy) in enumerate(spots):
        sense(plain, j, x, y, vx, vy)
        sense(turned, j, c * x - s * y, s * x + c * y, c * vx - s * vy, s * vx + c * vy)
    _, vx, vy = act(plain)
    _, wx, wy = act(turned)
    assert (wx, wy) == pytest.approx((c * vx - s * vy, s * vx + c * vy), abs=1e-6)


@given(st.permutations([0, 1, 2, 3]), st.lists(spot, min_size=4, max_size=4))
def test_names_of_targets_do_not_matter(order: list[int], spots: list[tuple[float, float, float, float]]) -> None:
    plain, renamed = table(), table()
    for j, (x, y, vx, vy) in enumerate(spots):
        sense(plain, j, x, y, vx, vy)
        sense(renamed, order[j], x, y, vx, vy)
    claim(plain, 0, 0, 2.0)
    claim(renamed, order[0], 0, 2.0)
    _, vx, vy = act(plain)
    _, wx, wy = act(renamed)
    assert (wx, wy) == pytest.approx((vx, vy), abs=1e-9)
    assert [renamed.tagged[order[j]] for j in range(4)] == plain.tagged


def test_velocity_is_the_quotient_of_two_sightings_and_zero_after_a_gap() -> None:
    t = table()
    see(t, P, 0, 1.0, 2.0, 0.0, 0.0, 5.0)
    see(t, P, 0, 1.03, 1.98, 0.0, 0.0, 5.1)
    assert (t.vx_m_s[0], t.vy_m_s[0]) == pytest.approx((0.3, -0.2))
    see(t, P, 0, 4.0, 4.0, 0.0, 0.0, 9.0)
    assert (t.vx_m_s[0], t.vy_m_s[0]) == (0.0, 0.0)
    assert t.distance_m[0] == pytest.approx(5.657)
    slow = params(tick_s=1.0)
    see(t, slow, 0, 4.3, 4.0, 0.0, 0.0, 10.0)
    assert t.vx_m_s[0] == pytest.approx(0.3)
    see(t, P, 0, 64.3, 4.0, 0.0, 0.0, 10.1)  # a jump is not a velocity
    assert (t.vx_m_s[0], t.vy_m_s[0]) == (0.0, 0.0)
