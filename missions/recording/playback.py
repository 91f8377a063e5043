"""A recording read back: what was flown, and what was observed, tick by tick.

    with play_back(Path("flight.rrd")) as playback:
        for observation in playback.observations():
            metrics.observe(observation)    # counts what it counted in flight

One file of the recording is in memory at a time, compact as it lies there, and what was observed one tick at a time.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa
from rerun.chunk import RrdReader

from missions.mission.agents import MOST_AGENTS
from missions.observation import Observation
from missions.problems import InputError
from missions.recording import ledger
from missions.recording.reel import PATHS, Reel
from missions.recording.scene import agent_names
from missions.recording.table import MISSION, Table
from missions.recording.whole import whole
from missions.report import PACKAGES, Facts

_OURS = "a recording that swarm launch --record wrote"
_LACKS = "{path}: got a recording without {what}; allowed: " + _OURS + ", of this version"


@dataclass(slots=True, kw_only=True)
class Playback:
    """A recording, open to be read.

    Attributes:
        facts: what flew. mission_yaml: the whole mission, every key written out.
        unfinished: it was never finished; a repaired copy is read.
        damaged: how much of it was left out because it cannot be read, or makes no sense; as far as it was read.
        ticks_missing: ticks that are not there, before the last that was read.
    """

    path: Path
    facts: Facts
    mission_yaml: str
    unfinished: bool
    damaged: int
    ticks_missing: int = 0
    _files: Sequence[Path]

    def observations(self) -> Iterator[Observation]:
        """What was observed, in the order of ticks.

        Raises:
            InputError: there is not a single tick.
        """
        reel, count, tick = Reel(self.facts), 0, -1
        lost = self.damaged
        for file in self._files:
            for seen in reel.play(_table(self.path, file, PATHS)):
                count, tick = count + 1, seen.tick
                self.ticks_missing = tick + 1 - count
                yield seen
            self.damaged = lost + reel.damaged
        if not count:
            raise InputError(_LACKS.format(path=self.path, what="a single tick"))

    def page(self, uid: int, tick: int) -> tuple[int, str] | None:
        """What the agent told of its mind last by that tick: when, and what it knew, wanted and why, as Markdown."""
        path, latest = f"/knowledge/{agent_names(self.facts.agents)[uid]}", None
        for file in self._files:
            table = _table(self.path, file, [path])
            for told_at, (texts,) in table.rows(path, {"TextDocument:text": pa.string()}):
                if told_at > tick:
                    return latest
                latest = (told_at, texts[0]) if texts else latest
        return latest


@contextmanager
def play_back(path: Path) -> Iterator[Playback]:
    """Open a recording, all parts of it, or a `.rrd.part` of one whose recorder was killed.

    Raises:
        InputError: there is no such file, or it is no recording of a mission.
    """
    with whole(path) as found:
        facts, mission_yaml, doubts = _what_flew(path, found.files)
        yield Playback(
            path=path,
            facts=facts,
            mission_yaml=mission_yaml,
            unfinished=found.unfinished,
            damaged=found.damaged + doubts,
            _files=found.files,
        )


def _table(path: Path, file: Path, paths: Sequence[str]) -> Table:
    try:
        return Table(RrdReader(file), paths)
    except (RuntimeError, ValueError) as error:
        what = (str(error).splitlines() or [""])[0]
        raise InputError(f"{path}: got no recording ({what}); allowed: {_OURS}") from error


def _what_flew(path: Path, files: Sequence[Path]) -> tuple[Facts, str, int]:
    """What flew, its mission file, and how many of its numbers are damaged.

    Every file says it; the first one in which it can be read is believed. How many flew is what its rows have: a wrong
    number would leave all of them out, and a large one take hours and all memory.
    """
    lack = "a mission"
    for file in files:
        table = _table(path, file, ["/__properties/**", ledger.DUTIES, ledger.TARGETS])
        mission, versions = table.statics(MISSION), table.statics("/__properties/versions")
        try:
            agents = _how_many(table, ledger.DUTIES, "helping", said=mission["agents"])
            targets = _how_many(table, ledger.TARGETS, "seen", said=mission["targets"])
            facts = Facts(
                mission=mission["name"],
                policy=mission["policy"],
                seed=mission["seed"],
                agents=agents,
                targets=targets,
                tick_s=mission["tick_s"],
                coverage_floor=mission.get("coverage_floor"),
                versions={name: versions[name] for name in ("python", *PACKAGES) if name in versions},
            )
            return facts, mission["yaml"], (agents != mission["agents"]) + (targets != mission["targets"])
        except KeyError as missing:
            lack = str(missing)
    raise InputError(_LACKS.format(path=path, what=lack))


def _how_many(table: Table, path: str, component: str, *, said: int) -> int:
    """How many entries most rows of an entity have; what is said, as far as so many can fly, counts as one more row."""
    rows = [len(row) for _, (row,) in table.rows(path, {component: pa.int64()})]
    return Counter([*rows, max(1, min(said, MOST_AGENTS))]).most_common(1)[0][0]
