"""The rows that the rules do not look at decide nothing: an agent that forgets does as one that looks at all rows."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from comms.messages import Frame
from swarm_agent.bcmommt.belief import Table, begin_tick, forget, new_table, see
from swarm_agent.bcmommt.params import Params, Policy
from swarm_agent.bcmommt.speech import calls_said, hear, tags_said
from swarm_agent.bcmommt.step import Mind, new_mind
from swarm_agent.policies.choice import decide
from tests.swarm_agent.bcmommt.scene import NOW, params
from tests.swarm_agent.bcmommt.test_step import ME, heard, spot

N_TARGETS, N_AGENTS = 6, 5
LONG_S = 300.0

policies = st.builds(params, policy=st.sampled_from(Policy), memory_s=st.sampled_from([0.0, 60.0]))
sights = st.lists(st.none() | spot, min_size=N_TARGETS, max_size=N_TARGETS)
# A tick, and how long after the one before: leases run out meanwhile, or all that is known.
ticks = st.lists(st.tuples(st.sampled_from([0.1, 0.1, 3.0, 25.0, LONG_S]), heard, sights), min_size=2, max_size=6)


class AllRows(list[int]):
    """All rows, as a study looks at them: none has to be entered."""

    def insert(self, index: Any, row: Any) -> None:
        """It is there."""


def live(
    t: Table, p: Params, mind: Mind, now: float, frames: list[Frame], sight: list[Any], *, forgets: bool = False
) -> tuple[Any, ...]:
    """One tick of an agent: the next mind, where it flies, what it says."""
    begin_tick(t)
    if forgets:
        forget(t, p, now)
    hear(t, p, [frame._replace(sent_at_s=now - 0.1) for frame in frames])
    for j, here in enumerate(sight):
        if here is not None:
            see(t, p, j, here[0], here[1], 0.0, 0.0, now)
    mind, vx, vy = decide(t, p, mind, ME, 0.0, 0.0, now, 1, round(10 * now))
    return mind, vx, vy, tags_said(t), calls_said(t, p, now)


@given(policies, ticks)
def test_who_forgets_decides_as_who_looks_at_all_rows(p: Params, story: list[Any]) -> None:
    forgetful = new_table(N_TARGETS, N_AGENTS, 0)
    whole = new_table(N_TARGETS, N_AGENTS, 0)._replace(known=AllRows(range(N_TARGETS)), mates=AllRows(range(N_AGENTS)))
    mind = new_mind(1.0, 0.0)
    now = NOW
    for gap_s, frames, sight in story:
        now += gap_s
        done = live(forgetful, p, mind, now, frames, sight, forgets=True)
        assert done == live(whole, p, mind, now, frames, sight)
        mind = done[0]
    assert forgetful.known == sorted(set(forgetful.known))
    assert forgetful.mates == sorted(set(forgetful.mates))


@given(policies, heard, sights)
def test_in_the_end_nothing_is_known(p: Params, frames: list[Frame], sight: list[Any]) -> None:
    t = new_table(N_TARGETS, N_AGENTS, 0)
    live(t, p, new_mind(1.0, 0.0), NOW, frames, sight)
    told = {word.target for frame in frames for word in (*frame.tags, *frame.help_calls)}
    assert t.known == sorted(told | {j for j, here in enumerate(sight) if here is not None})
    assert t.mates == sorted({frame.src for frame in frames})
    for later_s in (0.1, LONG_S, LONG_S + 0.1):  # lost, no longer called for, forgotten
        live(t, p, new_mind(1.0, 0.0), NOW + later_s, [], [None] * N_TARGETS, forgets=True)
    assert t.known == t.mates == []
