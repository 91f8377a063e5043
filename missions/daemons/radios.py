"""The radios that a mission names, and whose they are."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from missions.mission import Mission
from missions.problems import InputError


def radios_of(mission: Mission) -> dict[str, list[int]]:
    """Which agents share each of the radios that a mission names, in its order."""
    by_endpoint = groupby(range(len(mission.radio.endpoints)), key=mission.radio.endpoints.__getitem__)
    return {endpoint: list(group) for endpoint, group in by_endpoint}


def check_processes(mission: Mission, per_process: int) -> None:
    """See that agents of one process have one radio, and those of two have two.

    Raises:
        InputError: so many agents in a process do not fit the mission's radios.
    """
    groups = list(radios_of(mission).values())
    if groups and groups != _in_processes(mission, per_process):
        n = len(groups[0])
        fitting = f"{n}" if groups == _in_processes(mission, n) else "no number, but swarm agent for each of them"
        raise InputError(
            f"--processes: got {per_process}; allowed: {fitting}, as agents of one process, and no others, share one "
            "of radio.endpoints"
        )


def _in_processes(mission: Mission, n: int) -> list[list[int]]:
    uids = list(range(mission.agents.count))
    return [uids[first : first + n] for first in range(0, len(uids), n)]


def own_endpoint(mission: Mission, uids: Sequence[int]) -> str:
    """Where the radio of the process that runs these agents listens.

    Raises:
        InputError: other agents than these share it.
    """
    endpoint = mission.radio.endpoints[uids[0]]
    group = radios_of(mission)[endpoint]
    if list(uids) != group:
        words = f"{group[0]}-{group[-1]}" if len(group) > 1 else f"{group[0]}"
        got = f"{uids[0]}-{uids[-1]}" if len(uids) > 1 else f"{uids[0]}"
        raise InputError(f"--id: got {got}; allowed: {words}, which shares {endpoint} of radio.endpoints")
    return endpoint
