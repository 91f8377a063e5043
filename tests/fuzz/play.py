"""Play an episode, and make one that fails as small as it gets."""

from __future__ import annotations

import signal
import traceback
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from tests.fuzz.episode import Episode, Shot
from tests.fuzz.subjects import SUBJECTS

LONGEST_SHOT_S = 10.0  # of the wall clock, on a busy machine; usually a tenth of a millisecond


class Failure(NamedTuple):
    """What went wrong: in which shot, after how many frames, the kind of error and where it came from."""

    shot: int
    frame: int
    what: str
    trace: str


def play(episode: Episode, states: Counter[str] | None = None) -> Failure | None:
    """Play it to its end or its failure. `states` counts the ticks in each state."""
    subject = SUBJECTS[episode.subject](episode)
    frames = 0
    for number, shot in enumerate(episode.shots):
        frames += len(shot.wires)
        try:
            with _patience():
                subject.take(shot)
                if number == len(episode.shots) - 1:
                    subject.finish()
        except Exception as error:  # any exception is a finding
            return Failure(number, frames, _name(error), "".join(traceback.format_exception(error)))
        if states is not None:
            states[subject.state] += 1
    return None


def shrink(episode: Episode, failure: Failure) -> tuple[Episode, Failure]:
    """The same failure with fewer frames, then with fewer shots: halves, quarters and so on are left out in turn."""
    smallest, last = episode._replace(shots=episode.shots[: failure.shot + 1]), failure
    for count, without in ((_frames, _without_frames), (_shots, _without_shots)):
        size = count(smallest) // 2
        while size:
            start = 0
            while start < count(smallest):
                candidate = without(smallest, start, start + size)
                again = play(candidate)
                if again is not None and again.what == failure.what:
                    smallest, last = candidate, again
                else:
                    start += size
            size //= 2
    return smallest, last


def _frames(episode: Episode) -> int:
    return episode.frames


def _shots(episode: Episode) -> int:
    return len(episode.shots)


def _without_frames(episode: Episode, start: int, stop: int) -> Episode:
    shots: list[Shot] = []
    number = 0
    for shot in episode.shots:
        kept = tuple(wire for k, wire in enumerate(shot.wires, number) if not start <= k < stop)
        number += len(shot.wires)
        shots.append(shot._replace(wires=kept))
    return episode._replace(shots=tuple(shots))


def _without_shots(episode: Episode, start: int, stop: int) -> Episode:
    return episode._replace(shots=episode.shots[:start] + episode.shots[stop:])


@contextmanager
def _patience() -> Iterator[None]:
    """A shot that does not end is a failure as well."""

    def give_up(number: int, frame: Any) -> None:
        raise TimeoutError(f"not done with one shot after {LONGEST_SHOT_S:g} s")

    before = signal.signal(signal.SIGALRM, give_up)
    signal.setitimer(signal.ITIMER_REAL, LONGEST_SHOT_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def _name(error: Exception) -> str:
    """The kind of a failure, by which a smaller one counts as the same: its type and the line that raised it."""
    if isinstance(error, TimeoutError | MemoryError):
        return type(error).__name__  # the line is where patience or memory happened to end
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__} in {last.name}, line {last.lineno} of {last.filename.rpartition('/')[2]}"
