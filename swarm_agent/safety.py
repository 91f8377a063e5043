"""What an agent checks before each setpoint: that it can still stop inside its fence, and short of its mates.

    guard = Guard(
        SafetyConfig(uid=3, fence=circle(50.0), separation_m=2.0, max_speed_m_s=5.0, acceleration_m_s2=2.5)
    )
    guard.hear(now_s, inbox)
    told_m_s = guard.safe(now_s, position_m, velocity_m_s, wish_m_s)  # the wish itself where nothing is near

Everything in the way is a wall, which limits the velocity towards it (a control barrier): at that velocity it must be
`slowing_s` away. Who keeps that of all walls can always come to rest straight on, whatever stands where. But what
turns a vehicle does not brake it: so a velocity that walls bend is changed no faster than the vehicle can follow. It
is first braked, as all walls ask, and turned towards the wish with what acceleration is left; both ends of that turn
are allowed, hence all between. Two agents that both do so share the gap between them, half each. Layers keep the
others apart.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import cos, hypot, isfinite, radians, sin
from typing import NamedTuple

from comms.frames import Vec3
from comms.messages import Frame
from comms.status import Event, Level
from swarm_agent.fence import Fence, Wall, walls

Velocity = tuple[float, float]

LEVEL_M = 1.0  # agents nearer than this in height share a layer
MEMORY_S = 2.0  # a mate that has fallen silent is expected where it was flying to, for so long
# A velocity setpoint takes effect about a second late: radio, tick, and the lag of the recorded ArduCopter 4.5.5.
REACTION_S = 1.0
BRAKES = 0.7  # the share of a vehicle's acceleration that is counted on
BACK_PER_S = 0.5  # who is too far goes back with this speed per meter
SHORT_M = 1.0  # of the fence: for the noise of positions, and the end of a swing
GIVE_WAY = radians(20.0)  # mates that meet head-on pass each other on the right
MOST_WALLS = 12  # that bend one velocity; two or three do
TOLERANCE_M_S = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class SafetyConfig:
    """What an agent keeps to.

    Attributes:
        uid: whose safety it is. separation_m: least horizontal distance to a mate on the same layer; 0: mates do not
            matter.
        max_speed_m_s, acceleration_m_s2: what its vehicle can do, horizontally.
    """

    uid: int
    fence: Fence
    separation_m: float
    max_speed_m_s: float
    acceleration_m_s2: float


class Limit(NamedTuple):
    """No faster than `speed_m_s` along the unit vector (east, north); negative: at least so fast the other way."""

    east: float
    north: float
    speed_m_s: float


def slowing_s(speed_m_s: float, acceleration_m_s2: float) -> float:
    """How many seconds of its flight an agent keeps free ahead, its reaction included.

    Who then slows down in proportion to the way left comes to rest where it was headed, and never brakes harder than
    is counted on.
    """
    return REACTION_S + speed_m_s / (BRAKES * acceleration_m_s2)


def stopping_distance_m(speed_m_s: float, acceleration_m_s2: float) -> float:
    """How far an agent flies until it has stopped so."""
    return speed_m_s * slowing_s(speed_m_s, acceleration_m_s2)


class Guard:
    """One agent's safety. It knows where its mates are from their frames alone."""

    def __init__(self, config: SafetyConfig) -> None:
        self._config = config
        self._brakes_m_s2 = BRAKES * config.acceleration_m_s2
        self._slowing_s = slowing_s(config.max_speed_m_s, config.acceleration_m_s2)
        self._reach_m = stopping_distance_m(config.max_speed_m_s, config.acceleration_m_s2)
        self._asked_at_s = 0.0
        self._course: Velocity | None = None  # what it was told last, since walls in reach first bent its wish
        self._mates: dict[int, tuple[float, Frame]] = {}
        self._outside = False
        self._events: list[Event] = []

    def hear(self, now_s: float, inbox: Sequence[Frame]) -> None:
        """Note where mates are, and forget those that have been silent for `MEMORY_S`."""
        for frame in inbox:
            self._mates[frame.src] = (now_s, frame)
        if len(self._mates) == len(inbox):
            return
        silent = [uid for uid, (heard_at_s, _) in self._mates.items() if now_s - heard_at_s > MEMORY_S]
        for uid in silent:
            del self._mates[uid]

    def safe(self, now_s: float, position_m: Vec3, velocity_m_s: Vec3, wish_m_s: Velocity) -> Velocity:
        """The velocity to fly (east, north): the wish, the same numbers, while no wall in reach forbids it.

        Once a wall has bent a wish, what is flown is turned by acceleration only, also towards a wish that no wall
        forbids, until all walls are out of reach.

        Args:
            velocity_m_s: how the vehicle flies now.
        """
        (x, y, _), (east, north, _) = position_m, velocity_m_s
        since_s, self._asked_at_s = now_s - self._asked_at_s, now_s
        if not 0.0 <= since_s <= REACTION_S:  # others have flown it meanwhile
            since_s, self._course = 0.0, None
        if not all(map(isfinite, (x, y, east, north, *wish_m_s))):
            self._course = None
            return (0.0, 0.0)
        fence = walls(self._config.fence, x, y, reach_m=self._reach_m + SHORT_M)
        self._say_outside(fence)
        mates = self._mates_near(now_s, position_m) if self._config.separation_m > 0.0 else []
        if not (fence or mates):
            self._course = None
            return wish_m_s
        avoid = [self._limit(mate) for mate in mates]
        limits = avoid + [self._limit(wall._replace(distance_m=wall.distance_m - SHORT_M)) for wall in fence]
        if self._course is None and max(_excess(wish_m_s, limits), _excess((east, north), limits)) <= TOLERANCE_M_S:
            return wish_m_s
        course = (east, north) if self._course is None else self._course
        self._course = self._turned(course, wish_m_s, limits, avoid, since_s)
        return self._course

    def _turned(
        self, course: Velocity, wish: Velocity, limits: Sequence[Limit], avoid: Sequence[Limit], for_s: float
    ) -> Velocity:
        """The course, braked as walls ask; what acceleration that leaves turns it towards the wish."""
        fastest_m_s = self._config.max_speed_m_s
        if _excess(wish, avoid) > TOLERANCE_M_S:
            wish = _turned_right(wish)
        braked = nearest_allowed(course, limits, max_speed_m_s=fastest_m_s)
        wanted = nearest_allowed(wish, limits, max_speed_m_s=fastest_m_s)
        left = self._brakes_m_s2 * for_s - hypot(braked[0] - course[0], braked[1] - course[1])
        return _moved(braked, wanted, max(left, 0.0))

    def take_events(self) -> tuple[Event, ...]:
        """What happened since the last call."""
        events = tuple(self._events)
        self._events.clear()
        return events

    def _mates_near(self, now_s: float, position_m: Vec3) -> list[Wall]:
        """The mates on this layer, where they should be by now; half of the gap to each is this agent's."""
        x, y, up = position_m
        found = []
        for uid, (_, frame) in self._mates.items():
            mate, speed = frame.position_m, frame.velocity_m_s
            if not abs(mate[2] - up) < LEVEL_M:  # NaN fails this, too
                continue
            age_s = max(0.0, now_s - frame.sent_at_s)
            dx, dy = mate[0] + age_s * speed[0] - x, mate[1] + age_s * speed[1] - y
            if not (isfinite(dx) and isfinite(dy)):
                continue
            distance_m = hypot(dx, dy)
            share_m = (distance_m - self._config.separation_m) / 2.0
            if share_m > self._reach_m:
                continue
            if distance_m > 0.0:
                found.append(Wall(dx / distance_m, dy / distance_m, share_m))
            else:  # in one place: the two fly apart, one east and one west
                found.append(Wall(1.0 if uid < self._config.uid else -1.0, 0.0, share_m))
        return found

    def _limit(self, wall: Wall) -> Limit:
        """The speed at which the wall is `_slowing_s` away; a wall that was passed is left behind."""
        if wall.distance_m < 0.0:
            return Limit(wall.east, wall.north, max(BACK_PER_S * wall.distance_m, -self._config.max_speed_m_s))
        return Limit(wall.east, wall.north, wall.distance_m / self._slowing_s)

    def _say_outside(self, fence: Sequence[Wall]) -> None:
        outside = bool(fence) and fence[0].distance_m < 0.0
        if outside != self._outside:
            self._outside = outside
            text = (
                f"{-fence[0].distance_m:.1f} m outside its fence: coming back" if outside else "inside its fence again"
            )
            self._events.append(Event(Level.ERROR if outside else Level.INFO, text))


def nearest_allowed(wish_m_s: Velocity, limits: Sequence[Limit], *, max_speed_m_s: float) -> Velocity:
    """Of the velocities that break no limit the one nearest to the wish; where all break one, one that does little.

    Limits are taken into account one by one, each time the one that is broken most: few of many matter.
    """
    velocity, taken = wish_m_s, list[Limit]()
    while limits and len(taken) < MOST_WALLS:
        worst = max(limits, key=lambda limit: _excess(velocity, (limit,)))
        if worst in taken or (taken and _excess(velocity, (worst,)) <= TOLERANCE_M_S):
            break
        taken.append(worst)
        velocity = _nearest_of_few(wish_m_s, taken, max_speed_m_s)
    return velocity


def _nearest_of_few(wish: Velocity, limits: Sequence[Limit], max_speed_m_s: float) -> Velocity:
    """It is the wish, or lies on the edge of one limit, or where two edges cross: few enough to look at all of them."""
    candidates = [wish, (0.0, 0.0)]
    candidates += [_pushed(wish, limit) for limit in limits]
    for one, other in combinations(limits, 2):
        candidates += _crossing(one, other)

    def badness(velocity: Velocity) -> tuple[float, float]:
        excess = max(_excess(velocity, limits), hypot(*velocity) - max_speed_m_s)
        return max(excess, TOLERANCE_M_S), hypot(velocity[0] - wish[0], velocity[1] - wish[1])

    return min(candidates, key=badness)


def _excess(velocity: Velocity, limits: Iterable[Limit]) -> float:
    """By how much (m/s) the velocity breaks the limit that it breaks most; 0 or less: none."""
    return max((velocity[0] * east + velocity[1] * north - speed for east, north, speed in limits), default=0.0)


def _pushed(velocity: Velocity, limit: Limit) -> Velocity:
    excess = velocity[0] * limit.east + velocity[1] * limit.north - limit.speed_m_s
    return velocity[0] - excess * limit.east, velocity[1] - excess * limit.north


def _crossing(one: Limit, other: Limit) -> list[Velocity]:
    """The velocity at the edge of both; none where they are parallel."""
    spread = one.east * other.north - one.north * other.east
    if abs(spread) < 1e-6:
        return []
    east = (one.speed_m_s * other.north - other.speed_m_s * one.north) / spread
    north = (other.speed_m_s * one.east - one.speed_m_s * other.east) / spread
    return [(east, north)]


def _turned_right(velocity: Velocity) -> Velocity:
    east, north = velocity
    return east * cos(GIVE_WAY) + north * sin(GIVE_WAY), north * cos(GIVE_WAY) - east * sin(GIVE_WAY)


def _moved(velocity: Velocity, towards: Velocity, by_m_s: float) -> Velocity:
    """The velocity after a change by at most so much; the other one itself if that is not farther."""
    east, north = towards[0] - velocity[0], towards[1] - velocity[1]
    change = hypot(east, north)
    if change <= by_m_s:
        return towards
    return velocity[0] + by_m_s / change * east, velocity[1] + by_m_s / change * north
