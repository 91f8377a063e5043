"""The progress bar of a flight, for people at a terminal; elsewhere it is silent."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from comms.status import Activity
from missions.observation import Observation, Phase

_SHOWN_EVERY_TICKS = 10


class ProgressBar:
    """An observer that shows the phase, how far the mission is, and what is seen."""

    def __init__(self, console: Console, *, duration_s: float, tick_s: float) -> None:
        self._progress = Progress(
            TextColumn("{task.description:<9}"),
            BarColumn(),
            TextColumn("{task.fields[state]}"),
            TimeRemainingColumn(),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._progress.add_task("prepare", total=duration_s, state="")
        self._tick_s = tick_s
        self._returning = False

    def __enter__(self) -> ProgressBar:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()

    def observe(self, observation: Observation) -> None:
        """Show one tick in ten."""
        if observation.tick % _SHOWN_EVERY_TICKS or self._progress.disable:
            return
        if observation.mission_tick is not None:
            done_s = (observation.mission_tick + 1) * self._tick_s
            self._progress.update(
                self._task, description="mission", completed=done_s, state=f"{done_s:5.0f} s  {_seen(observation)}"
            )
        else:
            if observation.phase is Phase.RETURN and not self._returning:
                self._returning = True
                self._progress.reset(self._task, total=None)  # nobody knows how long it takes
            self._progress.update(self._task, description=observation.phase.value, state=_waiting_for(observation))


def _seen(observation: Observation) -> str:
    seen = sum(target.seen for target in observation.targets)
    present = sum(target.present for target in observation.targets)
    mean = observation.coverage_mean
    return f"{seen}/{present} seen" + ("" if mean is None else f", {mean:.1%} so far")


def _waiting_for(observation: Observation) -> str:
    landed = sum(status.activity is Activity.LANDED for status in observation.statuses)
    if observation.phase is Phase.RETURN:
        return f"{landed}/{len(observation.statuses)} landed"
    up = sum(truth.position_m[2] > 1.0 for truth in observation.truths)
    return f"{up}/{len(observation.truths)} off the ground"
