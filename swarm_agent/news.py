"""What an agent has to tell in words: the lines of the event log that are about the algorithm."""

from __future__ import annotations

from comms.status import OFF_DUTY, AgentStatus, Event, Level


def news(before: AgentStatus | None, now: AgentStatus) -> tuple[Event, ...]:
    """What changed between two ticks of one agent: targets won and lost, help called for and given.

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
            events.append(Event(Level.WARNING, f"has lost T{target}"))
        elif target not in now.tags:
            events.append(Event(Level.INFO, f"leaves T{target} to a mate"))
    for call in now.calls:
        if call.urgent and call.target not in called and call.target not in lost:
            events.append(Event(Level.WARNING, f"calls for help: T{call.target}, in {call.loss_in_s:.0f} s"))
    if now.helping is not None and now.helping != before.helping:
        events.append(Event(Level.INFO, f"goes to help with T{now.helping}"))
    return tuple(events)
