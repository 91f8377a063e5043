"""Flies what is left of a study, block after block, here or on a cluster."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from typing import Any

from missions.problems import InputError
from missions.study.flown import Flown, FlyPoint, fly_point
from missions.study.shards import Block

Landed = Generator[tuple[Block, Flown], None, None]
Flyer = Callable[[Sequence[Block]], Landed]
"""Flies blocks, and gives each as soon as it is done."""


def here(fly: FlyPoint = fly_point) -> Flyer:
    """Fly on this computer, block after block, every block on all its cores."""

    def landed(blocks: Sequence[Block]) -> Landed:
        for block in blocks:
            yield block, fly(block.point.mission, block.seeds)

    return landed


def on_cluster(address: str, fly: FlyPoint = fly_point, *, connect_s: float = 10.0) -> Flyer:
    """Fly on a Dask cluster whose workers have this package installed; every block is one task.

    Raises (when flown):
        InputError: dask.distributed is not installed, or nothing answers at `address`.
    """

    def landed(blocks: Sequence[Block]) -> Landed:
        try:
            from distributed import Client, as_completed
        except ModuleNotFoundError as error:
            raise InputError(f"--dask: {error}; install the extra: pip install 'swarm-mission-stack[dask]'") from error
        try:
            client = Client(address, timeout=connect_s, set_as_default=False)
        except (OSError, ValueError) as error:
            allowed = "the address of a Dask scheduler that answers, such as tcp://10.0.0.5:8786"
            raise InputError(f'--dask: got "{address}" ({error}); allowed: {allowed}') from error
        with client:
            waiting: dict[Any, Block] = {
                client.submit(fly, block.point.mission, block.seeds, pure=False): block for block in blocks
            }
            for future, flown in _results(as_completed(list(waiting), loop=client.loop, with_results=True)):
                yield waiting[future], flown

    return landed


def _results(completed: Iterable[tuple[Any, Any]]) -> Iterator[tuple[Any, Flown]]:
    for future, flown in completed:
        yield future, flown
        future.release()
