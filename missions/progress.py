"""How a flight goes, while it goes: a live panel on a terminal, a line now and then elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic
from types import TracebackType
from typing import Protocol

from rich.console import Console
from rich.live import Live

from missions.metrics import Metrics
from missions.observation import Observation, Observer, Phase
from missions.panel import Vitals, line_of, panel_of

_REDRAWN_EVERY_S = 0.2  # of wall time
_LINES = 8  # in a mission, where there is no terminal
_SLICES = 40  # of the mission, whose coverage is shown


class Progress(Observer, Protocol):
    """Shows a flight from within a `with`."""

    def __enter__(self) -> Progress: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


def progress_on(console: Console, *, title: str, duration_s: float, tick_s: float, metrics: Metrics) -> Progress:
    """What fits this console.

    Args:
        metrics: the mission's, which have seen every tick before this is told of it.
    """
    pulse = Pulse(title=title, duration_s=duration_s, tick_s=tick_s, metrics=metrics)
    return LivePanel(console, pulse) if console.is_terminal else Lines(console, pulse)


class Pulse:
    """Keeps what a panel shows beyond the last tick: coverage so far, and how fast it goes.

    Attributes:
        done_s, duration_s: of MISSION.
    """

    def __init__(
        self,
        *,
        title: str,
        duration_s: float,
        tick_s: float,
        metrics: Metrics,
        wall_s: Callable[[], float] = monotonic,
    ) -> None:
        self.duration_s = duration_s
        self._title, self._tick_s, self._metrics, self._wall_s = title, tick_s, metrics, wall_s
        self._began_wall_s = wall_s()
        self._mission_began: tuple[float, float] | None = None  # mission clock, wall clock
        self._slices: list[tuple[int, int]] = []  # targets seen and present, summed
        self.done_s = 0.0
        self._mean: float | None = None

    def observe(self, observation: Observation) -> None:
        """Take in one tick."""
        if observation.mission_tick is None:
            return
        if self._mission_began is None:
            self._mission_began = observation.time_s, self._wall_s()
        self.done_s = (observation.mission_tick + 1) * self._tick_s
        self._mean = observation.coverage_mean
        place = min(_SLICES - 1, int(_SLICES * observation.mission_tick * self._tick_s / self.duration_s))
        self._slices += [(0, 0)] * (place + 1 - len(self._slices))
        seen, present = self._slices[place]
        self._slices[place] = seen + _seen(observation), present + _present(observation)

    def vitals(self, observation: Observation) -> Vitals:
        """What to show of this tick."""
        wall_s = self._wall_s() - self._began_wall_s
        return Vitals(
            title=self._title,
            phase=observation.phase,
            done_s=self.done_s,
            duration_s=self.duration_s,
            activities=[status.activity for status in observation.statuses],
            seen=_seen(observation),
            present=_present(observation),
            coverage=self._mean,
            history=[seen / present if present else None for seen, present in self._slices],
            losses=self._metrics.events.target_loss,
            calls=len({call.target for status in observation.statuses for call in status.calls}),
            helpers=sum(status.helping is not None for status in observation.statuses),
            faults=len(self._metrics.faults),
            realtime_factor=observation.time_s / wall_s if wall_s > 0 else None,
            left_s=self._left_s(observation),
            late_s=observation.tick_late_s,
        )

    def _left_s(self, observation: Observation) -> float | None:
        """Wall time until the end of MISSION, at the pace it has had so far."""
        if observation.phase is not Phase.MISSION or self._mission_began is None:
            return None
        began_s, began_wall_s = self._mission_began
        flown_s, took_s = observation.time_s - began_s, self._wall_s() - began_wall_s
        return (self.duration_s - self.done_s) * took_s / flown_s if flown_s > 0 else None


class LivePanel:
    """A panel that is drawn anew several times a second, and stays as it was at the end."""

    def __init__(self, console: Console, pulse: Pulse) -> None:
        self._live = Live(console=console, auto_refresh=False)
        self._pulse = pulse
        self._last: Observation | None = None
        self._drawn_wall_s = 0.0

    def __enter__(self) -> LivePanel:
        self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._last is not None:
            self._draw(self._last)
        self._live.stop()

    def observe(self, observation: Observation) -> None:
        """Draw one tick, unless another was drawn just now."""
        self._pulse.observe(observation)
        self._last = observation
        if monotonic() - self._drawn_wall_s >= _REDRAWN_EVERY_S:
            self._draw(observation)

    def _draw(self, observation: Observation) -> None:
        self._drawn_wall_s = monotonic()
        self._live.update(panel_of(self._pulse.vitals(observation)), refresh=True)


class Lines:
    """A line when a phase begins, and some in the course of a mission."""

    def __init__(self, console: Console, pulse: Pulse) -> None:
        self._console = console
        self._pulse = pulse
        self._phase: Phase | None = None
        self._told = 0

    def __enter__(self) -> Lines:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def observe(self, observation: Observation) -> None:
        """Print one tick, if it is time to."""
        self._pulse.observe(observation)
        part = int(_LINES * self._pulse.done_s / self._pulse.duration_s)
        if observation.phase is not self._phase or part > self._told:
            self._phase, self._told = observation.phase, part
            line = line_of(self._pulse.vitals(observation))
            self._console.print(line, markup=False, highlight=False, soft_wrap=True)


def _seen(observation: Observation) -> int:
    return sum(target.seen for target in observation.targets)


def _present(observation: Observation) -> int:
    return sum(target.present for target in observation.targets)
