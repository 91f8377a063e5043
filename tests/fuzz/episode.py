"""An episode: everything that arrives at one party, tick by tick, made from a seed and a number."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Literal, NamedTuple

from comms.mavlink import Endpoint
from tests.fuzz import px4_sessions, sessions
from tests.fuzz.hostile import ORDERS, REPORTS, Sender, storm_frame
from tests.fuzz.sessions import SYSTEM, Turns, wait
from vehicle_sim.vehicle import FLAVOR_NAMES, KINDS, FlavorName

Subject = Literal["vehicle", "pilot"]
Session = Callable[[Random], Turns]
# How a day of each flavor begins, and what may come then.
DAYS: dict[FlavorName, tuple[Session, tuple[Session, ...]]] = {
    "ardupilot": (sessions.take_off, sessions.SESSIONS),
    "px4": (px4_sessions.take_off, px4_sessions.SESSIONS),
}
FRAMES = 400  # roughly, of one episode
SPANS_S = (0.1,) * 12 + (0.02, 0.25, 0.5, 1.0)
PILOT_SHARE = 0.2
STORMS = (0, 0, 1, 2, 4, 8, 16)  # hostile frames in a tick
GROUND = Sender(((255, 190), (255, 191), (255, 0), (42, 1), (SYSTEM, 1), (0, 0), (1, 240)), SYSTEM, ORDERS)
VEHICLE = Sender(((SYSTEM, 1),) * 6 + ((SYSTEM, 0), (9, 1), (255, 190)), 255, REPORTS)


class Shot(NamedTuple):
    """One tick: how long it lasts, what arrives (frame by frame, so that it can shrink), what an agent wants (0-1)."""

    span_s: float
    wires: tuple[bytes, ...]
    wish: float


class Episode(NamedTuple):
    """`flavor`, `kind` and `boot_s` are the vehicle's."""

    subject: Subject
    flavor: FlavorName
    kind: str
    boot_s: float
    shots: tuple[Shot, ...]

    @property
    def frames(self) -> int:
        return sum(len(shot.wires) for shot in self.shots)


def make_episode(seed: int, number: int) -> Episode:
    """Episode `number` of `seed`: the same two numbers make the same episode."""
    rng = Random(f"{seed}/{number}")
    subject: Subject = "pilot" if rng.random() < PILOT_SHARE else "vehicle"
    flavor, boot_s = rng.choice(FLAVOR_NAMES), rng.choice((0.0, 0.5, 2.0))
    shots = _siege(rng, flavor) if subject == "vehicle" else _babel(rng)
    return Episode(subject, flavor, rng.choice(KINDS), boot_s, shots)


def _siege(rng: Random, flavor: FlavorName) -> tuple[Shot, ...]:
    """A vehicle's day: sessions of a ground station, between storms."""
    station = Endpoint(system_id=255, component_id=190)
    fierce = rng.random()
    shots: list[Shot] = []
    begin, goes_on = DAYS[flavor]
    frames, turns = 0, wait(rng) + begin(rng)
    while frames < FRAMES:
        if not turns:
            turns = rng.choice(goes_on)(rng)
        for message in turns.pop(0):
            station.send(message)
        session = station.take()
        storm = rng.choice(STORMS) if rng.random() < fierce else 0
        wires = [session] if session else []
        wires += [storm_frame(rng, GROUND) for _ in range(storm)]
        rng.shuffle(wires)
        frames += len(wires)
        shots.append(Shot(rng.choice(SPANS_S), tuple(wires), 0.0))
    return tuple(shots)


def _babel(rng: Random) -> tuple[Shot, ...]:
    """What a pilot hears beside its own vehicle, which flies meanwhile: at first nothing, so that it gets off."""
    shots: list[Shot] = []
    frames, quiet, wish = 0, rng.choice((0, 50, 250, 300)), rng.random()
    while frames < FRAMES:
        storm = 0 if len(shots) < quiet else rng.choice(STORMS)
        if rng.random() < 0.02:
            wish = rng.random()
        wires = tuple(storm_frame(rng, VEHICLE) for _ in range(storm))
        frames += len(wires)
        shots.append(Shot(0.1, wires, wish if len(shots) >= quiet - 30 else 0.0))
    return tuple(shots)
