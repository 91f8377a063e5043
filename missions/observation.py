"""What an observer is told of one tick: each agent's status beside the truth. Metrics and recording read only this."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

from comms.frames import Vec3
from comms.status import AgentStatus, Event

# Places are compared and recorded on this grid, so that whoever reads a recording counts what was counted in flight.
PLACES_PER_M = 64


class Phase(StrEnum):
    """Where the mission as a whole stands. Targets move, and coverage counts, in MISSION alone."""

    PREPARE = "prepare"  # connect, preflight, takeoff
    MISSION = "mission"
    RETURN = "return"
    DONE = "done"


@dataclass(frozen=True, slots=True)
class AgentTruth:
    """Where an agent's vehicle really is: ENU meters, meters a second, heading clockwise from north."""

    position_m: Vec3
    velocity_m_s: Vec3
    heading_rad: float


@dataclass(frozen=True, slots=True)
class TargetTruth:
    """Where a target really is (ENU meters, on the ground), whether it is in the world now, and whether it is seen."""

    x_m: float
    y_m: float
    present: bool
    seen: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Totals:
    """What went over the air and over MAVLink since power-on, of all agents together. It grows at its end alone.

    Attributes:
        radio_sent, radio_bytes: per frame. radio_delivered, radio_out_of_range, radio_lost: per frame and receiver.
        radio_refused: what was no frame, or could not be believed.
        mavlink_sent, mavlink_received, mavlink_bad, mavlink_dropped: at the agents' ends of their links.
        vehicles_received, vehicles_bad, vehicles_dropped: at the simulated vehicles' ends.
    """

    radio_sent: int = 0
    radio_delivered: int = 0
    radio_out_of_range: int = 0
    radio_lost: int = 0
    radio_bytes: int = 0
    mavlink_sent: int = 0
    mavlink_received: int = 0
    mavlink_bad: int = 0
    mavlink_dropped: int = 0
    vehicles_received: int = 0
    vehicles_bad: int = 0
    vehicles_dropped: int = 0
    radio_refused: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Observation:
    """One tick of a mission, whole.

    Attributes:
        tick: 0 at launch. time_s: the mission clock, tick times tick_s.
        mission_tick: ticks since MISSION began; None outside MISSION.
        statuses, truths: one per agent, by uid. targets: one per target, by id.
        links: pairs (a, b), a < b, of agents that heard each other in this tick (either direction).
        broken: pairs (from, to) of agents of which one did not hear the other, though in range.
        coverage: share of the present targets seen now; None outside MISSION. coverage_mean: eq. 1 over n, so far.
        utilization: coverage_mean x n / m.
        tick_late_s: how late this tick began against the wall clock; 0 in lockstep.
        totals: what was sent and received so far.
        events: what the mission itself has to say, e.g. "mission starts".
    """

    tick: int
    time_s: float
    phase: Phase
    statuses: tuple[AgentStatus, ...]
    truths: tuple[AgentTruth, ...]
    targets: tuple[TargetTruth, ...]
    mission_tick: int | None = None
    links: tuple[tuple[int, int], ...] = ()
    broken: tuple[tuple[int, int], ...] = ()
    coverage: float | None = None
    coverage_mean: float | None = None
    utilization: float | None = None
    tick_late_s: float = 0.0
    totals: Totals = Totals()
    events: tuple[Event, ...] = ()


class Observer(Protocol):
    """Anything that wants to see every tick: the metrics, the recorder, the progress bar."""

    def observe(self, observation: Observation) -> None: ...
