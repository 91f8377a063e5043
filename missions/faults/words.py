"""Faults in words: for the event log, the plan and the report."""

from __future__ import annotations

from collections.abc import Sequence

from missions.mission.faults import AnyFault, LastingFault, Partition

ENDLESS = "to the end"


def words(fault: AnyFault) -> str:
    """ "kill: agent 3, for 20 s", "loss of 30%: all agents, to the end", "reboot: agent 2"."""
    span = lasting(fault)
    told = f"{fault.what}: {whom(fault)}"
    return f"{told}, {span if span == ENDLESS else f'for {span} s'}" if span else told


def whom(fault: AnyFault) -> str:
    """Which agents it is about; groups that do not hear each other are apart."""
    if isinstance(fault, Partition):
        return " | ".join(_numbers(group) for group in fault.groups)
    if fault.agents is None:
        return "all agents"
    return f"agent{'s' if len(fault.agents) > 1 else ''} {_numbers(fault.agents)}"


def lasting(fault: AnyFault) -> str:
    """How many seconds it lasts, or that it does to the end; nothing for what happens at once."""
    if not isinstance(fault, LastingFault):
        return ""
    return ENDLESS if fault.for_s is None else f"{fault.for_s:g}"


def _numbers(uids: Sequence[int]) -> str:
    return ", ".join(map(str, uids))
