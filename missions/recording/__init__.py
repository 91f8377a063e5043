"""What a mission looks like: every observation becomes a rerun recording, in a file and, if wanted, in a live viewer.

    scene = Scene(mission_name="quickstart", mission_yaml=text, seed=1, policy="bcmommt", versions={"rerun": "0.41"},
                  tick_s=0.1, arena=disc(250.0), n_agents=10, n_targets=10, sensing_ranges_m=(60.0,) * 10,
                  home=GeoPoint(47.4, 8.5, 400.0))
    with Recorder("flight.rrd", scene=scene) as recorder:
        recorder.observe(observation)   # every tick; one queue entry, drawn by the recorder's own thread
    print(recorder.path, recorder.dropped)

This package alone imports rerun and numpy, so import it late: an agent's computer has neither.
"""

from __future__ import annotations

try:
    import numpy as _numpy  # noqa: F401
    import rerun as _rerun  # noqa: F401
except ModuleNotFoundError as missing:
    raise ModuleNotFoundError(
        f"recording needs {missing.name}, which the `ground` extra installs: pip install '.[ground]'",
        name=missing.name,
    ) from missing

from missions.recording.optimize import optimize
from missions.recording.recorder import Recorder, RecordingError
from missions.recording.scene import Scene

__all__ = ["Recorder", "RecordingError", "Scene", "optimize"]
