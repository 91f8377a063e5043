"""What a process does with its vehicle when the world, which has cued it so far, lets it in no longer."""

from __future__ import annotations

from contextlib import nullcontext
from math import inf

import pytest

from comms.clock import Lockstep
from comms.keys import Keys
from comms.radio import ANYBODY
from missions.daemons import agent as daemon
from missions.daemons.agent import HOME_FIRST, LEFT_TO_OTHER, agent
from missions.daemons.options import DaemonOptions
from missions.daemons.wire import STRANGE, TAKEN, decode_done, encode
from missions.exit_codes import BAD_INPUT
from missions.mission import Mission
from missions.sides.exchange import HELLO_TICK, Cue, Done
from tests.missions.daemons.fake_bus import FakeBus
from tests.missions.test_linked_vehicles import Pipe, mission_of

UID = 0
LONG_TICKS = 3000


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
    mission = mission_of() if is_linked else mission_of("vehicle={kind: simulated, links: [], boot_s: 0.5}")
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
