"""The two parties under the storm. `take` lives through one shot and checks the laws; it raises what goes wrong."""

from __future__ import annotations

from math import hypot, inf, nan

from swarm_agent.autopilot import Fly, Intent, Land, Pilot, PilotConfig, Prepare, Return
from tests.fuzz.episode import Episode, Shot
from tests.fuzz.hostile import HOME
from tests.fuzz.laws import (
    HEARTBEAT_ID,
    HEARTBEAT_S,
    SLACK,
    VEHICLE_LAWS,
    Broken,
    Tick,
    frame_ids,
    is_small,
    keeps_to_its_limits,
)
from tests.fuzz.sessions import SYSTEM
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.autopilot.faults import wind
from vehicle_sim.vehicle import VehicleConfig

WEIGH_EVERY = 100  # ticks: looking at everything a subject has takes milliseconds
MAX_EVENTS = 200
# Wishes of an agent; the last ones are of one that has lost its mind.
WISHES: tuple[Intent, ...] = (
    Prepare(), Fly((2.0, -1.0)), Fly((-9.0, 4.0)), Fly((0.0, 0.0)), Fly((0.3, 3.0)), Fly((nan, 1.0)), Fly((inf, -inf)),
    Fly((1e30, 1e-300)), Return(), Land(),
)  # fmt: skip


def _vehicle(episode: Episode) -> SimulatedVehicle:
    config = VehicleConfig(kind=episode.kind, flavor=episode.flavor, boot_s=episode.boot_s)  # type: ignore[arg-type]
    return SimulatedVehicle(config=config, system_id=SYSTEM, home=HOME)


class VehicleUnderFire:
    """A simulated vehicle that hears everything in the episode, each fourth frame on a link that is seldom read."""

    def __init__(self, episode: Episode) -> None:
        self.vehicle = _vehicle(episode)
        self._side = self.vehicle.open_channel()
        self._ideal = episode.kind == "ideal"
        self._now_s = 0.0
        self._beat_at_s = 0.0
        self._ticks = 0
        self._wind_m_s = 0.0

    def take(self, shot: Shot) -> None:
        """One tick."""
        before = self.vehicle.truth
        self._now_s += shot.span_s
        self._ticks += 1
        self._side.hear(b"".join(shot.wires[3::4]))
        wire_out = self.vehicle.tick(self._now_s, b"".join(w for k, w in enumerate(shot.wires) if k % 4 != 3))
        air = wind(self.vehicle.autopilot.parameters)
        self._wind_m_s = max(self._wind_m_s, air.speed_m_s + hypot(air.gust_m_s, air.gust_m_s))
        after, seen_m_s = self.vehicle.truth, self._wind_m_s
        tick = Tick(self.vehicle, before, after, shot.span_s, self._now_s, wire_out, self._ideal, seen_m_s)
        for law in VEHICLE_LAWS:
            law(tick)
        if HEARTBEAT_ID in frame_ids(wire_out):
            self._beat_at_s = self._now_s
        if self._now_s - self._beat_at_s > HEARTBEAT_S + shot.span_s + SLACK:
            raise Broken(f"no heartbeat for {self._now_s - self._beat_at_s:.2f} s")
        if self._ticks % WEIGH_EVERY == 0:
            self.finish()

    def finish(self) -> None:
        """What is checked now and then, and at the end."""
        is_small(self.vehicle)
        list(frame_ids(self._side.take()))

    @property
    def state(self) -> str:
        """How deep the episode is, in words."""
        truth = self.vehicle.truth
        return f"{self.vehicle.mode_name} {'armed' if truth.armed else 'safe'} {'down' if truth.on_ground else 'up'}"


class PilotUnderFire:
    """A pilot that flies a real simulated vehicle while it hears what the episode says in that vehicle's name."""

    def __init__(self, episode: Episode) -> None:
        self.pilot = Pilot(PilotConfig(uid=2, system_id=SYSTEM, home=HOME, altitude_m=16.0, max_speed_m_s=5.0))
        self._vehicle = _vehicle(episode)
        self._wire = b""
        self._now_s = 0.0
        self._ticks = 0

    def take(self, shot: Shot) -> None:
        """One tick."""
        self._now_s += shot.span_s
        self._ticks += 1
        heard = self._vehicle.tick(self._now_s, self._wire) + b"".join(shot.wires)
        wish = WISHES[int(shot.wish * len(WISHES))]
        self._wire = self.pilot.tick(self._now_s, heard, wish)
        keeps_to_its_limits(self._wire, self.pilot.config)
        if len(self.pilot.take_events()) > MAX_EVENTS:
            raise Broken("the pilot has too much to say")
        if self._ticks % WEIGH_EVERY == 0:
            self.finish()

    def finish(self) -> None:
        """What is checked now and then, and at the end."""
        is_small(self.pilot)

    @property
    def state(self) -> str:
        """How deep the episode is, in words."""
        return f"pilot {self.pilot.state.phase.value}"


SUBJECTS = {"vehicle": VehicleUnderFire, "pilot": PilotUnderFire}
