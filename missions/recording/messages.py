"""What the autopilots said: of each kind of MAVLink message the newest now and then, as numbers under `/mavlink`.

`/mavlink/A4/ATTITUDE` is a vector of numbers, their names beside them; `/mavlink/A4` a page of all that is known of A4.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import isnan

import rerun as rr
from rerun import ComponentColumn

from comms.mavlink import Endpoint, numbers_of
from missions.recording.block import Block
from missions.recording.columns import Rows
from missions.recording.scene import Scene

_READER_ID = 255  # it never speaks: any id will do

# Every vector of every vehicle is a row of its own: a large swarm's come less often.
_STEP_S, _STEP_S_OF_AN_AGENT = 10.0, 0.5
_MARKDOWN = rr.MediaType.MARKDOWN
_HEADER = ("| message | by | numbers |", "|---|---|---|")
_KIND = slice(7, 10)  # of a MAVLink 2 frame: its message id


class Messages:
    """Vectors of the numbers in each message, and a page for each vehicle."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._step_s = max(_STEP_S, _STEP_S_OF_AN_AGENT * scene.n_agents)
        self._reader = Endpoint(system_id=_READER_ID)
        self._newest: dict[tuple[int, bytes], bytes] = {}  # frames by agent and kind
        self._named: set[str] = set()
        self._lines: dict[int, dict[str, str]] = {}  # of each agent's page, by kind

    def tell_anew(self) -> None:
        """Tell next what holds, whether it is new or not."""
        self._named.clear()

    def rows(self, block: Block) -> Iterator[Rows]:
        """The newest message of each kind since the last step, and names for what is told for the first time."""
        for seen in block.observations:
            for status in seen.statuses:
                if status.knowledge is not None:
                    self._newest |= {(status.uid, frame[_KIND]): frame for frame in status.knowledge.mavlink}
            at = Block(self._scene, [seen])
            if len(at.every(self._step_s)):
                yield from self._told(at)

    def _told(self, at: Block) -> Iterator[Rows]:
        names, time_s = self._scene.agent_names, at.observations[0].time_s
        for (uid, _), frame in self._newest.items():
            for message in self._reader.receive(frame):
                kind = message.get_type()
                path = f"/mavlink/{names[uid]}/{kind}"
                if numbers := numbers_of(message):
                    yield Rows(path, at, [*self._names(path, list(numbers)), *_vector(numbers)])
                    self._lines.setdefault(uid, {})[kind] = _line(kind, time_s, numbers)
        for uid in sorted({uid for uid, _ in self._newest}):
            page = "\n".join((f"### {names[uid]}", "", *_HEADER, *sorted(self._lines.get(uid, {}).values())))
            yield Rows(f"/mavlink/{names[uid]}", at, rr.TextDocument.columns(text=[page], media_type=[_MARKDOWN]))
        self._newest.clear()

    def _names(self, path: str, names: list[str]) -> Iterable[ComponentColumn]:
        """With the first row, not beside it: in a file, what is static is a chunk of its own."""
        if path in self._named:
            return ()
        self._named.add(path)
        return rr.SeriesLines.columns(names=names).partition([len(names)])


def _vector(numbers: Mapping[str, float]) -> Iterable[ComponentColumn]:
    return rr.Scalars.columns(scalars=[_known(number) for number in numbers.values()]).partition([len(numbers)])


def _line(kind: str, time_s: float, numbers: Mapping[str, float]) -> str:
    told = ", ".join(
        f"{name} {value:.0f}" if value.is_integer() else f"{name} {value:.5g}"
        for name, value in numbers.items()
        if not isnan(value)  # it says "not given"
    )
    return f"| {kind} | {time_s:.0f} s | {told} |"


def _known(value: float) -> float:
    """A number; 0 for "not given": NaN is not equal to itself, and equal missions shall give equal recordings."""
    return 0.0 if isnan(value) else value
