"""What the world believes of what an agent's process tells it: ids that the mission has, a vehicle that is somewhere.

A stolen key speaks for one agent. What it says must not be more than that: it must not end the recording, or fill
the report. The types in `missions.sides.exchange` bound what is counted; here is what depends on the mission.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite

from msgspec import structs

from comms.knowledge import Knowledge
from comms.messages import FARTHEST_M, FASTEST_M_S
from comms.radio import Roster
from comms.status import AgentStatus
from missions.observation import AgentTruth
from missions.sides.exchange import Done

MOST_LETTERS = 500  # of an event; what an agent or its autopilot has to say is a line
_LEAST_BYTES, _BYTES_EACH = 65_536, 256


def most_done_bytes(roster: Roster) -> int:
    """How long a done can be: what an agent knows of everybody, and what its autopilot said last."""
    return _LEAST_BYTES + _BYTES_EACH * (roster.n_agents + roster.n_targets)


def is_believable(done: Done, uid: int, roster: Roster) -> bool:
    """Whether it can be what agent `uid` of such a mission says."""
    status = done.status
    return status.uid == uid and _is_somewhere(done.truth) and _speaks_of(status, roster)


def shortened(done: Done) -> Done:
    """The same, with events that are not longer than a line."""
    events = done.status.events
    if all(len(event.text) <= MOST_LETTERS for event in events):
        return done
    short = tuple(structs.replace(event, text=event.text[:MOST_LETTERS]) for event in events)
    return structs.replace(done, status=structs.replace(done.status, events=short))


def _is_somewhere(truth: AgentTruth) -> bool:
    near = all(abs(place) <= FARTHEST_M for place in truth.position_m)  # NaN is not
    slow = all(abs(speed) <= FASTEST_M_S for speed in truth.velocity_m_s)
    return near and slow and isfinite(truth.heading_rad)


def _speaks_of(status: AgentStatus, roster: Roster) -> bool:
    """Whether the mission has every target and every agent that is spoken of."""
    n_agents, n_targets = roster
    targets = (*status.tags, *[call.target for call in status.calls], status.helping)
    known = status.knowledge
    return (
        _all_below(n_targets, targets)
        and _all_below(n_agents, status.mates)
        and (known is None or _knows_of(known, n_agents, n_targets))
    )


def _knows_of(known: Knowledge, n_agents: int, n_targets: int) -> bool:
    return all(
        _all_below(n_targets, (belief.target,)) and _all_below(n_agents, (belief.owner, belief.caller, belief.answerer))
        for belief in known.beliefs
    ) and _all_below(n_agents, [mate.uid for mate in known.mates])


def _all_below(count: int, ids: Iterable[int | None]) -> bool:
    return all(one is None or 0 <= one < count for one in ids)
