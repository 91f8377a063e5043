"""The progress bar of a study, with the time left; silent away from a terminal."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from missions.study.points import Point
from missions.study.shards import Block

_PAIRS_OF_NO_TARGETS = 10
_FLIGHT = 200


class StudyBar:
    """Shows how much of a study's work is done, in the measure of `work_of`."""

    def __init__(self, console: Console, *, name: str, runs: int, work: float) -> None:
        self._progress = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.fields[runs]} of {task.fields[all]} runs"),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            console=console,
            disable=not console.is_terminal,
        )
        self._runs = 0
        self._task = self._progress.add_task(name, total=work, runs=0, all=runs)

    def __enter__(self) -> StudyBar:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()

    def landed(self, block: Block) -> None:
        """Count a block that has been flown."""
        self._runs += len(block.seeds)
        self._progress.update(self._task, advance=work_of(block), runs=self._runs)


def work_of(block: Block) -> float:
    """A measure of how long a block takes to fly."""
    return len(block.seeds) * _work_of_a_run(block.point)


def _work_of_a_run(point: Point) -> float:
    mission, values = point.mission, point.values
    m, n = mission.agents.count, values.get("targets", _PAIRS_OF_NO_TARGETS)
    # What is flown with all its wires takes so much longer than what is compiled.
    return float(m * (m + n)) * mission.duration_s / mission.tick_s * (_FLIGHT if mission.faults else 1)
