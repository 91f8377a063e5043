"""Faults in words: for the event log, the plan and the report."""

from __future__ import annotations

from collections.abc import Sequence

from missions.mission.faults import AnyFault, LastingFault, Partition

ENDLESS = "to the end"


def words(fault: AnyFault) -> str:
    """ "kill: A3, for 20 s", "loss of 30%: all agents, to the end", "reboot: A2"."""
    span = lasting(fault)
    told = f"{fault.what}: {whom(fault)}"
    return f"{told}, {span if span == ENDLESS else f'for {span} s'}" if span else told


def whom(fault: AnyFault) -> str:
    """Which agents it is about; groups that do not hear each other are apart."""
    if isinstance(fault, Partition):
        return " | ".join(map(_names, fault.groups))
    if fault.agents is None:
        return "all agents"
    return _names(fault.agents)


def lasting(fault: AnyFault) -> str:
    """How many seconds it lasts, or that it does to the end; nothing for what happens at once."""
    if not isinstance(fault, LastingFault):
        return ""
    return ENDLESS if fault.for_s is None else f"{fault.for_s:g}"


def _names(uids: Sequence[int]) -> str:
    """A1, A6; several in a row as A0-A4."""
    runs: list[list[int]] = []
    for uid in sorted(uids):
        if runs and runs[-1][-1] == uid - 1:
            runs[-1].append(uid)
        else:
            runs.append([uid])
    return ", ".join(_run(run) for run in runs)


def _run(run: Sequence[int]) -> str:
    return f"A{run[0]}-A{run[-1]}" if len(run) > 2 else ", ".join(f"A{uid}" for uid in run)
