"""A recorder that is killed, whenever it is, leaves a file that can be read up to about the last second."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pyarrow as pa
import pytest

from comms.chance import draw

rr = pytest.importorskip("rerun")
from rerun.chunk import RrdReader  # noqa: E402

from missions.recording.whole import whole  # noqa: E402

MOMENTS = 10
# Observes some hundred ticks, ten times as fast as real time, and says of each when it is observed.
CHILD = """
import sys, time
from missions.recording import Recorder
from tests.missions.toy_observations import toy_observations, toy_scene
scene = toy_scene()
with Recorder(sys.argv[1], scene=scene, lossless=False) as recorder:
    for observation in toy_observations(scene, ticks=400):
        recorder.observe(observation)
        print(observation.tick, flush=True)
        time.sleep(0.01)
"""
# A second is lost that was not flushed yet; and, at ten times real time, what lies in the queue on a busy computer.
SECOND_TICKS, QUEUED_TICKS = 10, 50


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs SIGKILL")
@pytest.mark.parametrize("moment", range(MOMENTS))
def test_killed_at_any_moment_it_leaves_a_readable_file(tmp_path: Path, moment: int) -> None:
    path = tmp_path / "killed.rrd"
    last_tick = 60 + int(300 * draw(1, moment, 0, 999))
    command = [sys.executable, "-c", CHILD, str(path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ, "RERUN_STRICT": "1"}) as child:
        assert child.stdout is not None
        for line in child.stdout:
            if int(line) == last_tick:
                child.kill()
                break
    assert child.returncode == -signal.SIGKILL
    with whole(path.with_name("killed.rrd.part")) as found:
        assert found.unfinished
        (repaired,) = found.files
        ticks = _ticks(repaired)
    assert ticks == list(range(len(ticks)))
    assert last_tick - ticks[-1] <= SECOND_TICKS + QUEUED_TICKS


def _ticks(path: Path) -> list[int]:
    chunks = RrdReader(path).stream().filter(content="/world/agents/body", has_timeline="tick").to_chunks()
    batches = [pa.record_batch(chunk.to_record_batch()) for chunk in chunks]
    return sorted(tick for batch in batches for tick in batch.column("tick").to_pylist())
