"""The command line of the storm: python -m tests.fuzz --frames 1000000 [--seed S] [--jobs N] | --seed S --episode N"""

from __future__ import annotations

import argparse
import resource
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from itertools import count
from typing import NamedTuple

from comms.mavlink import Endpoint
from tests.fuzz.episode import Episode, make_episode
from tests.fuzz.play import Failure, play, shrink

BATCH = 25  # episodes a process plays before it tells
MOST_BYTES = 4 << 30  # of memory: what grows without end fails here, and not the whole machine


class Tally(NamedTuple):
    """What a batch of episodes came to: frames played, ticks by state, and (episode, failure) for each failure."""

    frames: int
    states: Counter[str]
    failures: list[tuple[int, Failure]]


def main(argv: list[str] | None = None) -> int:
    """Exit code 0: every law held. 1: one did not."""
    parser = argparse.ArgumentParser(prog="tests.fuzz", description=__doc__)
    parser.add_argument("--frames", type=int, default=1_000_000, help="how many frames to play (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--episode", type=int, help="play this episode alone, and shrink its failure")
    parser.add_argument("--jobs", type=int, default=1, help="processes (default: %(default)s)")
    arguments = parser.parse_args(argv)
    resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, resource.getrlimit(resource.RLIMIT_AS)[1]))
    if arguments.episode is not None:
        return _one(arguments.seed, arguments.episode)
    return _many(arguments.seed, frames=arguments.frames, jobs=max(1, arguments.jobs))


def _one(seed: int, number: int) -> int:
    episode = make_episode(seed, number)
    failure = play(episode)
    if failure is None:
        print(f"seed {seed}, episode {number}: every law held over {episode.frames} frames")
        return 0
    _tell(*shrink(episode, failure))
    return 1


def play_batch(seed: int, first: int) -> Tally:
    """Episodes `first` to `first` + BATCH - 1."""
    states: Counter[str] = Counter()
    frames, failures = 0, []
    for number in range(first, first + BATCH):
        episode = make_episode(seed, number)
        failure = play(episode, states)
        frames += episode.frames
        if failure is not None:
            failures.append((number, failure))
    return Tally(frames, states, failures)


def _many(seed: int, *, frames: int, jobs: int) -> int:
    began_s = time.perf_counter()
    states: Counter[str] = Counter()
    played, failures, batches = 0, [], count(0, BATCH)
    with ProcessPoolExecutor(jobs) as pool:
        while played < frames:
            waiting = [pool.submit(play_batch, seed, next(batches)) for _ in range(jobs)]
            for tally in [batch.result() for batch in waiting]:
                played += tally.frames
                states += tally.states
                failures += tally.failures
            if sys.stderr.isatty():
                print(f"\r{played:,} frames, {len(failures)} failures", end="", file=sys.stderr)
    print(f"{played:,} frames in {time.perf_counter() - began_s:.0f} s, seed {seed}: {len(failures)} failures")
    for state, ticks in sorted(states.items()):
        print(f"  {ticks:9,} ticks  {state}")
    for what, times in Counter(failure.what for _, failure in failures).most_common():
        number, failure = next(pair for pair in failures if pair[1].what == what)
        print(f"\n{times} times: {what}\n{failure.trace}")
        print(f"first in episode {number}, frame {failure.frame}; again: --seed {seed} --episode {number}")
    return 1 if failures else 0


def _tell(episode: Episode, failure: Failure) -> None:
    """A shrunken episode, message by message."""
    print(f"{failure.trace}\nshrunk to {episode.frames} frames in {len(episode.shots)} ticks:")
    print(f"  {episode.subject}, {episode.flavor}, {episode.kind}, boots in {episode.boot_s} s")
    now_s = 0.0
    for shot in episode.shots:
        now_s += shot.span_s
        reader = Endpoint(system_id=1)
        for wire in shot.wires:
            messages = reader.receive(wire)
            print(f"  {now_s:7.2f} s  {' '.join(map(str, messages)) or wire.hex()}")


if __name__ == "__main__":
    sys.exit(main())
