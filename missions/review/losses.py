"""Losses, one by one: who had the target, was help called, and who could have come."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import hypot, inf

from comms.status import OFF_DUTY, Activity
from missions.metrics import owners_of
from missions.observation import Observation
from missions.review.calls import Call, Calls

# Nobody foresees more: eq. 10 looks as far ahead (section 4.2).
FORESIGHT_S = 20.0


@dataclass(frozen=True, slots=True)
class Chance:
    """A free agent that could have had the target in sight when it was lost, had it left at once when it still could.

    Attributes:
        leave_by_s: the last moment (mission clock) at which it could have left. distance_m: to the target, at the loss.
        in_touch: whether it was in radio contact with an owner then. called: whether the call was out by then.
    """

    agent: int
    leave_by_s: float
    distance_m: float
    in_touch: bool
    called: bool


@dataclass(slots=True)
class Loss:
    """A target that nobody follows any more.

    Attributes:
        time_s: mission clock of the first tick without an owner. owners: who had it until then.
        owners_gone: none of them is on duty any more. left: the target has left the world: nobody could have kept it.
        place_m: where it was, east and north.
        call: the call that was out for it, if any. helpers: who was on the way.
        chances: who could have prevented it; the one that could have left last comes first.
        found_after_s: until somebody had it again; None: never.
    """

    time_s: float
    target: int
    owners: tuple[int, ...]
    owners_gone: bool
    left: bool
    place_m: tuple[float, float]
    call: Call | None
    helpers: tuple[int, ...]
    chances: tuple[Chance, ...]
    found_after_s: float | None = None


class Losses:
    """An observer of losses.

    Args:
        calls: has observed the same tick when this one observes it. speed_m_s, sensing_range_m: of any agent.

    Attributes:
        all: every loss of the mission, in order; as many as the report counts.
    """

    def __init__(self, calls: Calls, *, speed_m_s: float, sensing_range_m: float) -> None:
        self.all: list[Loss] = []
        self._calls, self._speed_m_s, self._sensing_range_m = calls, speed_m_s, sensing_range_m
        self._at_large: dict[int, Loss] = {}
        self._lately: deque[Observation] = deque()
        self._owners: Mapping[int, tuple[int, ...]] = {}

    def observe(self, seen: Observation) -> None:
        """Note which targets nobody has any more, and which somebody has again."""
        if seen.mission_tick is None:
            self._owners = {}
            return
        self._lately.append(seen)
        while seen.time_s - self._lately[0].time_s > FORESIGHT_S:
            self._lately.popleft()
        before, self._owners = self._owners, owners_of(seen.statuses)
        for target in self._at_large.keys() & self._owners.keys():
            loss = self._at_large.pop(target)
            loss.found_after_s = seen.time_s - loss.time_s
        for target in sorted(before.keys() - self._owners.keys()):
            self._at_large[target] = self._lost(seen, target, before[target])
            self.all.append(self._at_large[target])

    def _lost(self, seen: Observation, target: int, owners: tuple[int, ...]) -> Loss:
        call, place = self._calls.out(target, owners), seen.targets[target]
        return Loss(
            time_s=seen.time_s,
            target=target,
            owners=owners,
            owners_gone=all(seen.statuses[uid].activity in OFF_DUTY for uid in owners),
            left=not place.present,
            place_m=(place.x_m, place.y_m),
            call=call,
            helpers=tuple(s.uid for s in seen.statuses if s.helping == target and s.uid not in owners),
            chances=_chances(
                self._lately,
                target,
                owners,
                call,
                speed_m_s=self._speed_m_s,
                sensing_range_m=self._sensing_range_m,
            ),
        )


def longest(losses: Sequence[Loss], count: int) -> list[Loss]:
    """The `count` losses that lasted longest, in order of time; those of targets that left come after all others."""
    found = sorted(losses, key=lambda loss: (loss.left, -(loss.found_after_s or inf)))[:count]
    return sorted(found, key=lambda loss: loss.time_s)


def _chances(
    lately: Sequence[Observation],
    target: int,
    owners: tuple[int, ...],
    call: Call | None,
    *,
    speed_m_s: float,
    sensing_range_m: float,
) -> tuple[Chance, ...]:
    """Free agents that, at full speed from where they were, would have been in sensing range when it was lost.

    Whether they would have looked that way, if they do not see all around, is not asked.
    """
    lost = lately[-1]
    place = lost.targets[target]
    if not place.present:
        return ()
    found: dict[int, Chance] = {}
    for seen in lately:  # later moments replace earlier ones
        for uid, (status, truth) in enumerate(zip(seen.statuses, seen.truths, strict=True)):
            if status.activity is not Activity.EXPLORE or uid in owners:
                continue
            x, y, _ = truth.position_m
            way_m = hypot(x - place.x_m, y - place.y_m) - sensing_range_m
            if way_m <= speed_m_s * (lost.time_s - seen.time_s):
                x, y, _ = lost.truths[uid].position_m
                in_touch = any({uid, owner} == {*link} for link in seen.links for owner in owners)
                called = call is not None and call.began_s <= seen.time_s
                found[uid] = Chance(uid, seen.time_s, hypot(x - place.x_m, y - place.y_m), in_touch, called)
    return tuple(sorted(found.values(), key=lambda chance: -chance.leave_by_s))
