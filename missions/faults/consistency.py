"""Rules between a mission's faults and its other keys."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from functools import partial

from missions.mission import Mission
from missions.mission.faults import RADIO_FAULTS, VEHICLE_FAULTS, Partition
from missions.rules import Rule


def fault_rules(mission: Mission) -> Iterator[Rule]:
    """Rules for each of a mission's faults."""
    for number, fault in enumerate(mission.faults):
        at = f"faults.{number}"
        if isinstance(fault, RADIO_FAULTS):
            yield Rule(f"{at}.kind", ("radio.mode",), _radio_is_simulated)
        if isinstance(fault, Partition):
            yield Rule(f"{at}.groups", ("agents.count",), partial(_groups_part_agents, fault))
            continue
        yield Rule(f"{at}.agents", ("agents.count",), partial(_among, fault.agents or ()))
        yield Rule(f"{at}.agents", (), partial(_once, fault.agents or ()))
        if isinstance(fault, VEHICLE_FAULTS):
            yield Rule(f"{at}.agents", ("vehicle.links",), partial(_vehicles_are_simulated, fault.agents))


def _groups_part_agents(fault: Partition, mission: Mission) -> str | None:
    uids = [uid for group in fault.groups for uid in group]
    return _among(uids, mission) if len(uids) == len(set(uids)) else "each agent in one group"


def _among(uids: Iterable[int], mission: Mission) -> str | None:
    count = mission.agents.count
    return f"numbers from 0 to {count - 1}, below agents.count ({count})" if any(u >= count for u in uids) else None


def _once(uids: Sequence[int], _: Mission) -> str | None:
    twice = [uid for uid, times in Counter(uids).items() if times > 1]
    return f"each agent once; {twice[0]} is there twice" if twice else None


def _radio_is_simulated(mission: Mission) -> str | None:
    return (
        None
        if mission.radio.mode != "field"
        else "faults of another kind: where radio.mode is field, no radio is simulated"
    )


def _vehicles_are_simulated(uids: tuple[int, ...] | None, mission: Mission) -> str | None:
    linked = {uid for uid, link in enumerate(mission.vehicle.links) if link is not None}
    if not linked.intersection(range(mission.agents.count) if uids is None else uids):
        return None
    return "agents whose vehicles are simulated: one behind a link (vehicle.links) has faults of its own"
