"""What is left of a flight, however it ends: its report."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from missions.metrics import Metrics
from missions.report import make_report, publish
from missions.sides.world import WorldSide

if TYPE_CHECKING:
    from rich.console import Console


@contextmanager
def reported(
    side: WorldSide, metrics: Metrics, *, to: str | None, console: Console, recording: Callable[[], Path | None]
) -> Iterator[None]:
    """Fly within: the report is published at the end, if the flight has begun, and says so if it was broken off.

    Args:
        to: see `publish`. recording: where it lies when the flight has ended.
    """
    began_s = time.monotonic()
    try:
        yield
    except BaseException as error:
        why = "at once, in the air or not" if isinstance(error, KeyboardInterrupt) else repr(error)
        metrics.fault(side.clock_s, None, f"the flight was broken off: {why}")
        raise
    finally:
        if side.tick > 0:
            report = make_report(side, metrics, wall_s=time.monotonic() - began_s, recording=recording())
            publish(report, to=to, console=console)
