"""What the world does for its recorder, and for how long, over a bus without a network."""

from __future__ import annotations

import threading
from collections.abc import Callable
from time import monotonic

import msgspec
import pytest

from comms.keys import Keys
from comms.radio import ANYBODY
from comms.status import Activity, AgentStatus
from missions.daemons import feed
from missions.daemons.crew import CrewError
from missions.daemons.feed import UNAWAITED, WINDOW_TICKS, Feed, Kept
from missions.daemons.wire import OVER, STRANGE, decode_observation
from missions.observation import AgentTruth, Observation, Phase
from tests.missions.daemons.fake_bus import FakeBus

KEYS = Keys("toy")
PRINT = "the mission's"
LONG_S = 30.0


def no() -> bool:
    return False


def yes() -> bool:
    return True


def observation(tick: int) -> Observation:
    return Observation(
        tick=tick,
        time_s=tick / 10,
        phase=Phase.PREPARE,
        statuses=(AgentStatus(uid=0, activity=Activity.PREPARING),),
        truths=(AgentTruth((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0),),
        targets=(),
    )


class Mission:
    """A feed, what is told of its recorder, and recorders that say how far they are."""

    def __init__(self, *, lockstep: bool = True, back_s: float = 0.0) -> None:
        self.bus = FakeBus()
        self.told: list[str] = []
        self.begun = 0
        self.feed = Feed(
            self.bus,
            keys=KEYS,
            lockstep=lockstep,
            fingerprint=PRINT,
            back_s=back_s,
            begin=self._begin,
            tell=lambda event: self.told.append(event.text),
        )

    def say(self, tick: int = -1, *, life: int = 1, fingerprint: str = PRINT, **more: object) -> None:
        kept = {"tick": tick, "recording": f"{life}.rrd", "fingerprint": fingerprint, "life": life, **more}
        self.bus.publish(KEYS.kept, msgspec.msgpack.encode(msgspec.convert(kept, Kept)))

    def appear(self, *, life: int = 1, is_there: bool = True) -> None:
        self.bus.appear(KEYS.recorder(life), is_there=is_there)

    def observe(self, ticks: range) -> None:
        for tick in ticks:
            self.feed.observe(observation(tick))

    @property
    def passed_on(self) -> list[int]:
        seen = [
            decode_observation(payload, ANYBODY)
            for key, payload in self.bus.said
            if key == KEYS.truth and payload != OVER
        ]
        return [shown.tick for shown in seen if shown is not None]

    def _begin(self) -> None:
        self.begun += 1


def in_time(do: Callable[[], None]) -> None:
    """Nothing of this waits for what does not come."""
    began_s = monotonic()
    do()
    assert monotonic() - began_s < LONG_S / 2


def test_nothing_is_said_before_there_is_a_recorder_and_all_after() -> None:
    mission = Mission()
    mission.observe(range(5))
    assert mission.passed_on == []
    mission.appear()
    mission.say()
    mission.feed.await_recorder(0.0, stop=no)
    mission.observe(range(5, 9))
    assert mission.passed_on == [5, 6, 7, 8]
    assert mission.begun == 1
    mission.say(8, closed=True)
    mission.feed.close(stop=no)
    assert mission.feed.failures == []
    assert mission.bus.said[-1] == (KEYS.truth, OVER)


def test_in_lockstep_it_waits_for_a_recorder_that_is_behind() -> None:
    mission = Mission()
    mission.appear()
    mission.say()
    mission.observe(range(WINDOW_TICKS))
    got_on = threading.Event()

    def get_on() -> None:
        got_on.set()
        mission.say(0)

    progress = threading.Timer(0.05, get_on)
    progress.start()
    in_time(lambda: mission.observe(range(WINDOW_TICKS, WINDOW_TICKS + 1)))
    assert got_on.is_set()
    progress.join()
    assert mission.feed.failures == []
    assert mission.passed_on == list(range(WINDOW_TICKS + 1))


def test_one_that_does_not_get_on_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(feed, "LOST_S", 0.05)
    mission = Mission()
    mission.appear()
    mission.say()
    mission.observe(range(3 * WINDOW_TICKS))
    assert mission.feed.failures == ["the recorder does not get on: nothing is recorded from 10.0 s"]
    assert len(mission.passed_on) == WINDOW_TICKS + 1


@pytest.mark.parametrize("back_s", [0.0, LONG_S], ids=["here", "over a link that may be cut"])
def test_one_that_has_gone_is_given_up_unless_it_may_be_back(back_s: float) -> None:
    mission = Mission(lockstep=False, back_s=back_s)
    mission.appear()
    mission.say()
    mission.appear(is_there=False)
    mission.observe(range(3))
    assert bool(mission.feed.failures) is (back_s == 0.0)
    assert mission.passed_on == ([] if back_s == 0.0 else [0, 1, 2])
    assert mission.told == mission.feed.failures


def test_why_it_failed_is_what_it_said() -> None:
    mission = Mission()
    mission.appear()
    mission.say()
    mission.say(failure="no space left on device")
    in_time(lambda: mission.feed.close(stop=no))
    assert mission.feed.failures == ["no space left on device"]


def test_ticks_that_are_missing_are_told() -> None:
    mission = Mission(lockstep=False)
    mission.appear()
    mission.say()
    mission.say(closed=True, dropped=7)
    mission.feed.close(stop=no)
    assert mission.feed.failures == ["the recorder was too slow, or its link was cut: 7 ticks are missing"]


def test_a_stranger_records_nothing_and_is_told_of_once() -> None:
    mission = Mission()
    mission.appear()
    for _ in range(3):
        mission.say(fingerprint="another mission's")
    mission.observe(range(3))
    assert mission.passed_on == []
    assert mission.told == [STRANGE]
    assert mission.begun == 0
    with pytest.raises(CrewError, match="no sign of the recorder"):
        mission.feed.await_recorder(0.0, stop=no)


def test_a_second_one_looks_on_and_nothing_that_it_says_counts() -> None:
    mission = Mission()
    mission.appear()
    mission.say()
    mission.say(life=2, closed=True)
    mission.say(life=2, failure="no space left on device")
    mission.observe(range(3))
    mission.say(2, closed=True)
    mission.feed.close(stop=no)
    assert mission.passed_on == [0, 1, 2]
    assert mission.feed.failures == []
    assert mission.begun == 1
    assert str(mission.feed.recording) == "1.rrd"


@pytest.mark.parametrize("gone", [1, 2])
def test_who_looks_on_neither_hides_that_the_recorder_goes_nor_stands_for_it(gone: int) -> None:
    mission = Mission()
    for life in (1, 2):
        mission.appear(life=life)
        mission.say(life=life)
    mission.appear(life=gone, is_there=False)
    mission.observe(range(3))
    assert bool(mission.feed.failures) is (gone == 1)
    assert mission.passed_on == ([] if gone == 1 else [0, 1, 2])


def test_who_is_asked_to_end_waits_for_no_recorder() -> None:
    mission = Mission()
    with pytest.raises(CrewError, match="asked to end before the recorder was there"):
        in_time(lambda: mission.feed.await_recorder(LONG_S, stop=yes))
    mission.appear()
    mission.say()
    in_time(lambda: mission.feed.close(stop=yes))
    assert mission.feed.failures == [UNAWAITED]


def test_rubbish_is_not_heard() -> None:
    mission = Mission()
    for wire in (b"", b"\xc1", b"\x00", msgspec.msgpack.encode({"tick": "soon"})):
        mission.bus.publish(KEYS.kept, wire)
    mission.observe(range(3))
    assert mission.passed_on == []
