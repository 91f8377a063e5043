"""What happened in a mission, counted from its observations alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from math import hypot, inf

from comms.cells import Cells
from comms.frames import Vec3
from comms.status import Activity, AgentStatus, Level
from missions.coverage import Coverage
from missions.faults.costs import Costs
from missions.observation import PLACES_PER_M, Observation, Totals

MAX_FAULTS = 1000
# A call that pauses for less than this is the same call: which of two tags is the nearest changes from tick to tick.
CALL_PAUSE_S = 1.0
# Two drones nearer than this, in every direction, are too near. Looked at now and then: it takes a while to get there.
CLOSE_M = 1.0
LOOK_EVERY_TICKS = 5


@dataclass(slots=True)
class EventCount:
    """Definition 7: a target changes its owner, loses its last one, or gets its first."""

    target_loss: int = 0
    target_discovery: int = 0
    tag_switch: int = 0


@dataclass(slots=True)
class HelpCount:
    """Episodes of help. A call is an episode of one agent calling for one target, however often it is renewed.

    answered: an agent set out to help another. captured: it came to own the target. taken_over: it left the target to
    somebody else who goes after it. pursued: an agent set out for a target that it had lost itself, which is no help.
    found_again: it came to own it.
    """

    calls: int = 0
    answered: int = 0
    captured: int = 0
    taken_over: int = 0
    pursued: int = 0
    found_again: int = 0


# Their names, in the order in which a study keeps them as rows of numbers; and where in the row each is.
EVENT_COUNTS = tuple(one.name for one in fields(EventCount))
HELP_COUNTS = tuple(one.name for one in fields(HelpCount))
TARGET_LOSS, TARGET_DISCOVERY, TAG_SWITCH = range(len(EVENT_COUNTS))
CALLS, ANSWERED, CAPTURED, TAKEN_OVER, PURSUED, FOUND_AGAIN = range(len(HELP_COUNTS))


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that should not have happened: when (mission clock, s), to which agent, and what."""

    time_s: float
    agent: int | None
    what: str


@dataclass(slots=True)
class Metrics:
    """An observer that counts.

    Attributes:
        ticks: of MISSION so far. totals: as of the last tick.
    """

    coverage: Coverage = field(default_factory=Coverage)
    ticks: int = 0
    totals: Totals = field(default_factory=Totals)
    events: EventCount = field(default_factory=EventCount)
    help: HelpCount = field(default_factory=HelpCount)
    faults: list[Fault] = field(default_factory=list)
    costs: Costs = field(default_factory=Costs)
    tick_late_s_max: float = 0.0
    _before: tuple[AgentStatus, ...] = ()
    _on_duty_before: bool = False
    _pursuing: set[int] = field(default_factory=set)  # agents that go after what they lost themselves
    _called_at_s: dict[tuple[int, int], float] = field(default_factory=dict)  # by (agent, target)
    _close: set[tuple[int, int]] = field(default_factory=set)

    def observe(self, observation: Observation) -> None:
        """Count one tick."""
        on_duty = observation.mission_tick is not None
        self.tick_late_s_max = max(self.tick_late_s_max, observation.tick_late_s)
        self.totals = observation.totals
        self._count_faults(observation)
        self.costs.observe(observation)
        if on_duty:
            self.ticks += 1
            self.coverage.add(
                seen=sum(target.seen for target in observation.targets),
                present=sum(target.present for target in observation.targets),
                tick=observation.mission_tick,
            )
            before = self._before if self._on_duty_before else ()
            _count_tags(self.events, owners_of(before), owners_of(observation.statuses))
            _count_help(self.help, before, observation.statuses, self._pursuing)
            self._count_calls(observation)
        self._before, self._on_duty_before = observation.statuses, on_duty

    def fault(self, time_s: float, agent: int | None, what: str) -> None:
        """Note that something went wrong."""
        if len(self.faults) < MAX_FAULTS:
            self.faults.append(Fault(time_s, agent, what))

    def _count_calls(self, observation: Observation) -> None:
        for status in observation.statuses:
            for call in status.calls:
                key = (status.uid, call.target)
                if observation.time_s - self._called_at_s.get(key, -inf) > CALL_PAUSE_S:
                    self.help.calls += 1
                self._called_at_s[key] = observation.time_s

    def _count_faults(self, observation: Observation) -> None:
        time_s, before = observation.time_s, dict(enumerate(self._before))
        for event in observation.events:
            if event.level is Level.ERROR:
                self.fault(time_s, None, event.text)
        for status in observation.statuses:
            errors = [event.text for event in status.events if event.level is Level.ERROR]
            gone = status.activity is Activity.LOST or (
                observation.mission_tick is not None
                and status.activity in (Activity.TAKEN_OVER, Activity.RETURNING, Activity.LANDED)
            )
            changed = status.uid not in before or before[status.uid].activity is not status.activity
            if gone and changed and not errors:
                errors = [f"leaves the mission: {status.activity.value}"]
            for text in errors:
                self.fault(time_s, status.uid, text)
        if observation.mission_tick is not None and observation.mission_tick % LOOK_EVERY_TICKS == 0:
            self._watch_separation(observation)

    def _watch_separation(self, observation: Observation) -> None:
        """Agents on one layer of air (there are more agents than layers) must keep apart by themselves."""
        places = [_on_grid(truth.position_m) for truth in observation.truths]
        cells = Cells([place[:2] for place in places], range_m=CLOSE_M)
        for low, (x, y, z) in enumerate(places):
            for high in cells.near(x, y):
                other_x, other_y, other_z = places[high]
                if high > low and abs(z - other_z) < CLOSE_M and hypot(x - other_x, y - other_y) < CLOSE_M:
                    self._met(observation.time_s, low, high)

    def _met(self, time_s: float, low: int, high: int) -> None:
        if (low, high) not in self._close:
            self._close.add((low, high))
            self.fault(time_s, high, f"came within {CLOSE_M:g} m of A{low}")


def _on_grid(place_m: Vec3) -> Vec3:
    x, y, z = place_m
    return (
        round(x * PLACES_PER_M) / PLACES_PER_M,
        round(y * PLACES_PER_M) / PLACES_PER_M,
        round(z * PLACES_PER_M) / PLACES_PER_M,
    )


def owners_of(statuses: Sequence[AgentStatus]) -> dict[int, tuple[int, ...]]:
    """Who has each target that somebody has."""
    owners: dict[int, tuple[int, ...]] = {}
    for status in statuses:
        for target in status.tags:
            owners[target] = (*owners.get(target, ()), status.uid)
    return owners


def _count_tags(count: EventCount, before: Mapping[int, Sequence[int]], now: Mapping[int, Sequence[int]]) -> None:
    # For a moment two agents may both claim a target (their claims cross in the air): a switch is complete when the
    # new owner is there and the old one has let go.
    for target, owners in now.items():
        if target not in before:
            count.target_discovery += 1
        elif not {*before[target]} <= {*owners}:
            count.tag_switch += 1
    count.target_loss += sum(1 for target in before if target not in now)


def _count_help(
    count: HelpCount, before: Sequence[AgentStatus], now: Sequence[AgentStatus], pursuing: set[int]
) -> None:
    """One tick, and who pursues after it."""
    helped = {status.helping for status in now}
    for index, status in enumerate(now):
        was_helping = before[index].helping if before else None
        if status.helping == was_helping:
            continue
        if was_helping is not None:
            caught, own = was_helping in status.tags, status.uid in pursuing
            count.captured += caught and not own
            count.found_again += caught and own
            count.taken_over += not caught and not own and was_helping in helped
        pursuing.discard(status.uid)
        if status.helping is not None:
            own = pursues(status)
            count.pursued += own
            count.answered += not own
            if own:
                pursuing.add(status.uid)


def pursues(status: AgentStatus) -> bool:
    """Whether an agent that goes after a called target calls for it itself: it has lost it, and helps nobody."""
    return any(call.target == status.helping for call in status.calls)
