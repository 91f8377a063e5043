"""What an agent has to tell in words: the lines of the event log that are about the algorithm."""

from __future__ import annotations

from comms.status import OFF_DUTY, AgentStatus, Event, Level
from swarm_agent.reasons import Reasons


def news(before: AgentStatus | None, now: AgentStatus, reasons: Reasons) -> tuple[Event, ...]:
    """What changed between two ticks of one agent, and why: targets won and lost, help called for, given, given up.

    A target that leaves this agent's tags may be followed by a mate now, or be lost: the agent says which it knows.
    """
    if before is None or now.activity in OFF_DUTY:
        return ()
    events = []
    lost = {call.target for call in now.calls if call.target not in now.tags}
    called = {call.target for call in before.calls if call.urgent}
    for target in now.tags:
        if target not in before.tags:
            verb = "captures" if target == before.helping else "follows"
            events.append(Event(Level.INFO, f"{verb} T{target}"))
    for target in before.tags:
        if target in lost:
            events.append(Event(Level.WARNING, f"has lost T{target}: {reasons.losing(target)}"))
        elif target not in now.tags:
            events.append(Event(Level.INFO, f"leaves T{target} to a mate: {reasons.leaving(target)}"))
    for call in now.calls:
        if call.urgent and call.target not in called and call.target not in lost:
            events.append(Event(Level.WARNING, f"calls for help: T{call.target}, in {call.loss_in_s:.0f} s"))
    if before.helping is not None and before.helping not in (now.helping, *now.tags):
        events.append(Event(Level.INFO, f"gives up T{before.helping}: {reasons.not_helping(before.helping)}"))
    if now.helping is not None and now.helping != before.helping:
        events.append(Event(Level.INFO, f"goes to help with T{now.helping}: {reasons.helping(now.helping)}"))
    return tuple(events)
