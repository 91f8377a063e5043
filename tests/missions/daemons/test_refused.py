"""What a process does with its vehicle when the world lets it in no longer, is another one, or does not answer."""

from __future__ import annotations

from contextlib import nullcontext
from math import inf
from pathlib import Path

import pytest

from comms.clock import Lockstep
from comms.credentials import Credentials
from comms.keys import WORLD, Keys
from comms.radio import ANYBODY
from missions.daemons import agent as daemon
from missions.daemons import seat
from missions.daemons.agent import HOME_FIRST, LEFT_TO_OTHER, agent
from missions.daemons.options import DaemonOptions
from missions.daemons.wire import FOREIGN, OVER, STRANGE, TAKEN, decode_done, encode
from missions.exit_codes import BAD_INPUT, DONE, FAILED
from missions.mission import Mission
from missions.sides.exchange import HELLO_TICK, Cue, Done
from tests.missions.daemons.fake_bus import FakeBus
from tests.missions.test_linked_vehicles import Pipe, mission_of

UID = 0
LONG_TICKS = 3000
FIRST, NEXT = 11, 22  # lives of worlds
SIMULATED = "vehicle={kind: simulated, links: [], boot_s: 0.5}"


class World:
    """A world in which one agent takes off, and is refused as soon as it is in the air.

    Attributes:
        refused_at: tick; None while it is on the ground.
    """

    def __init__(self, bus: FakeBus, mission: Mission, why: str) -> None:
        keys = Keys(mission.name)
        self.refused_at: int | None = None
        self._put = bus.publisher(keys.cue(UID))
        self._why = why
        bus.subscribe(keys.done(UID), lambda key, payload: self._answer(decode_done(payload, UID, ANYBODY)))

    def _answer(self, done: Done | None) -> None:
        assert done is not None
        assert done.tick < LONG_TICKS, "never in the air"
        if done.on_ground or done.tick == HELLO_TICK:
            self._put(encode(Cue(tick=done.tick + 1, life=done.life)))
        else:
            self.refused_at = done.tick
            self._put(encode(Cue(tick=done.tick, life=done.life, refused=self._why)))


@pytest.mark.parametrize(
    ("why", "is_linked", "is_left"), [(TAKEN, True, True), (TAKEN, False, False), (STRANGE, True, False)]
)
def test_it_brings_it_down_unless_another_process_flies_it(
    why: str, is_linked: bool, is_left: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    mission = mission_of() if is_linked else mission_of(SIMULATED)
    bus, pipe = FakeBus(), Pipe(1, 0.0, mission)
    world = World(bus, mission, why)
    monkeypatch.setattr(daemon, "open_world", lambda *words, **named: nullcontext(bus))
    monkeypatch.setattr(daemon, "open_airwaves", lambda *words: nullcontext(bus))
    monkeypatch.setattr(daemon, "open_transports", lambda *words: nullcontext({UID: pipe} if is_linked else {}))
    monkeypatch.setattr(daemon, "RealTime", lambda **words: Lockstep())
    assert agent(mission, [UID], DaemonOptions(speed=inf)) == BAD_INPUT
    assert world.refused_at is not None
    said = capsys.readouterr().err
    assert (why in said, LEFT_TO_OTHER in said, HOME_FIRST in said) == (True, is_left, not is_left)
    assert ("landed and disarmed" in said) is not is_left
    if is_linked:
        assert pipe.vehicle.truth.on_ground is not is_left


class TwoWorlds:
    """A world in which one agent takes off and that dies then, or at once; and the next one, which cues it unasked.

    Attributes:
        heard: the worlds that the agent named, without repetitions. n_heeded: cues of the next one that it obeyed.
    """

    def __init__(self, bus: FakeBus, mission: Mission, *, flies: bool) -> None:
        keys = Keys(mission.name)
        self.heard: list[int] = []
        self.n_heeded = 0
        self._is_new = False
        self._flies = flies
        self._put = bus.publisher(keys.cue(UID))
        bus.subscribe(keys.done(UID), lambda key, payload: self._answer(decode_done(payload, UID, ANYBODY)))

    def _answer(self, done: Done | None) -> None:
        assert done is not None
        assert done.tick < LONG_TICKS, "never in the air"
        self.heard += [done.world] if done.world not in self.heard[-1:] else []
        is_up = not done.on_ground or not self._flies
        if done.tick != HELLO_TICK and self._is_new:
            self.n_heeded += 1
        elif done.tick != HELLO_TICK and is_up:
            self._is_new = True
            self._put(encode(Cue(tick=done.tick + 1, life=done.life, world=NEXT)))
        elif self._is_new:
            self._put(encode(Cue(tick=0, life=done.life, world=NEXT, refused=FOREIGN)))
        else:
            self._put(encode(Cue(tick=done.tick + 1, life=done.life, world=FIRST)))


def fly_on(bus: FakeBus, mission: Mission, options: DaemonOptions, monkeypatch: pytest.MonkeyPatch) -> int:
    """Run a daemon of a simulated vehicle on this bus; its exit code."""
    monkeypatch.setattr(daemon, "open_world", lambda *words, **named: nullcontext(bus))
    monkeypatch.setattr(daemon, "open_airwaves", lambda *words: nullcontext(bus))
    monkeypatch.setattr(seat, "FORGOTTEN_S", 0.0)
    return agent(mission, [UID], options)


@pytest.mark.parametrize("flies", [True, False])
def test_it_obeys_no_other_world_and_comes_home_from_the_first(
    flies: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    bus, mission = FakeBus(), mission_of(SIMULATED)
    worlds = TwoWorlds(bus, mission, flies=flies)
    assert fly_on(bus, mission, DaemonOptions(speed=inf), monkeypatch) == FAILED
    assert (worlds.heard, worlds.n_heeded) == ([0, FIRST], 0)
    said = capsys.readouterr().err
    assert (FOREIGN in said, HOME_FIRST in said, "landed and disarmed" in said) == (True, flies, flies)


@pytest.mark.parametrize("is_secured", [True, False])
def test_it_says_once_that_a_world_that_is_there_does_not_answer(
    is_secured: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    bus, mission = FakeBus(), mission_of(SIMULATED)
    keys, n_hellos = Keys(mission.name), 0

    def on_hello(key: str, payload: bytes) -> None:
        nonlocal n_hellos
        n_hellos += 1
        if n_hellos == 1:
            bus.appear(keys.alive(WORLD))
        elif n_hellos == 5:
            bus.publish(keys.cue(UID), OVER)

    bus.subscribe(keys.done(UID), on_hello)
    monkeypatch.setattr(daemon, "UNANSWERED_S", 0.0)
    monkeypatch.setattr(daemon, "HELLO_EVERY_S", 0.0)
    credentials = Credentials(Path("keys"), "agent-7") if is_secured else None
    assert fly_on(bus, mission, DaemonOptions(speed=inf, credentials=credentials), monkeypatch) == DONE
    said = capsys.readouterr().err
    assert said.count("level=warning") == said.count("has not answered our hello") == is_secured
    assert ("agent-7.pem is not what its name says" in said) is is_secured
