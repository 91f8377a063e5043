"""Where simulated autopilots differ on the wire: one row each. The rest of the differences is in their `autopilot`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.streams import Group
from vehicle_sim.autopilot.telemetry import Builder


class Flavor(NamedTuple):
    """One family of autopilots, as a vehicle speaks for it. Each function is given an autopilot of this family.

    Attributes:
        autopilot: powers one on, given what `Autopilot` is given less its parameters, script and rules.
        builders: the messages it can report, by id. unasked_s: the periods of those that flow unasked.
        groups: what REQUEST_DATA_STREAM switches; none: it does not know that message.
        commands: the handlers of commands, each with a MAV_RESULT.
        set_mode: SET_MODE (base mode, custom mode), with a MAV_RESULT. set_mode_ack: as which command it is answered.
        addressed: whether a message with a target is for the vehicle of a system id.
        hearing: messages it takes in without an answer. answers: those it answers.
    """

    autopilot: Callable[..., Autopilot]
    builders: Mapping[int, Builder]
    unasked_s: Mapping[int, float]
    groups: Mapping[int, Group]
    commands: Mapping[int, Callable[[Any], int]]
    set_mode: Callable[[Any, int, int], int]
    set_mode_ack: int
    addressed: Callable[[Any, int], bool]
    hearing: Mapping[int, Callable[[Any, Any], None]]
    answers: Mapping[int, Callable[[Any, Any], Iterable[Any]]]
