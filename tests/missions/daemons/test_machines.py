"""A mission on two computers whose cable is cut: who holds still, who is soon back, and that nothing old counts."""

from __future__ import annotations

import re
from pathlib import Path
from time import monotonic, sleep

import pytest

from tests.missions.daemons.machines import DRONE, GROUND, GROUND_ADDRESS, Cut, two_machines, why_not
from tests.missions.daemons.swarm import SMALL
from tests.missions.daemons.test_processes import report_of

pytestmark = [
    pytest.mark.slow,
    pytest.mark.xdist_group("real time"),
    pytest.mark.skipif(bool(why_not()), reason=why_not()),
]

RESUME_S = 0.5
ENDPOINT = f"tcp/{GROUND_ADDRESS}:7447"


@pytest.mark.parametrize("cut", Cut)
def test_a_mission_goes_on_as_soon_as_the_cable_is_mended(tmp_path: Path, cut: Cut) -> None:
    file = tmp_path / "report.json"
    mission = ("quickstart", *SMALL, "--speed", "1", "--duration", "36", "--set", "agents.may_lose=1")
    with (
        two_machines() as machines,
        machines.swarm(GROUND, "world", *mission, "--listen", ENDPOINT, "--insecure", "--report", str(file)) as world,
        machines.swarm(GROUND, "agent", *mission, "--connect", ENDPOINT, "--id", "0-1") as others,
        machines.swarm(DRONE, "agent", *mission, "--connect", ENDPOINT, "--id", "2") as drone,
    ):
        world.wait_for("the mission begins")
        for cut_s in (3.0, 13.0):
            sleep(2.0)
            del world.said[:], drone.said[:]
            with machines.cut(cut):
                began_s = monotonic()
                world.wait_for('who=agent-2 text="its process has died, or its link is cut"')
                drone.wait_for("holds still")
                sleep(max(0.0, began_s + cut_s - monotonic()))
                mended_s = monotonic()
            world.wait_for('who=agent-2 text="its process is back"')
            assert monotonic() - mended_s < RESUME_S
            drone.wait_for("the world is back")
            # Had it taken a cue of before for one of now, the time without would have been shorter, or in pieces.
            [without_s] = map(float, re.findall(r"the world is back, after ([\d.]+) s without", drone.output))
            assert cut_s - 0.2 < without_s < cut_s + 1.0
        assert [world.wait(), others.wait(), drone.wait()] == [0, 0, 0], world.output + drone.output
    report = report_of(file)
    assert report["duration_s"] == 36.0
