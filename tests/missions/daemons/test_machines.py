"""A mission on two computers whose cable is cut: who holds still, who is soon back, and that nothing old counts."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from time import monotonic, sleep

import pytest

from tests.missions.daemons.machines import DRONE, GROUND, GROUND_ADDRESS, Cut, two_machines, why_not
from tests.missions.daemons.swarm import COMMAND, ROOT, SMALL
from tests.missions.daemons.test_processes import report_of

pytestmark = [
    pytest.mark.slow,
    pytest.mark.xdist_group("real time"),
    pytest.mark.skipif(bool(why_not()), reason=why_not()),
]

RESUME_S = 0.5
CUT = 'who=agent-2 text="its process has died, or its link is cut"'
BACK = 'who=agent-2 text="its process is back"'
ENDPOINT = f"tcp/{GROUND_ADDRESS}:7447"
LISTEN = ("--listen", ENDPOINT)


@pytest.mark.parametrize("cut", Cut)
def test_a_mission_goes_on_as_soon_as_the_cable_is_mended(tmp_path: Path, cut: Cut) -> None:
    """Two drones are cut off, the third is not; once everybody proves who it is, and once nobody does."""
    file, network = tmp_path / "report.json", _network(tmp_path, secured=cut is Cut.SILENT)
    mission = ("quickstart", *SMALL, "--speed", "1", "--duration", "36", "--set", "agents.may_lose=2")
    connect = (*mission, "--connect", ENDPOINT, *network)
    insecure = () if network else ("--insecure",)
    with (
        two_machines() as machines,
        machines.swarm(GROUND, "world", *mission, *network, *insecure, *LISTEN, "--report", str(file)) as world,
        machines.swarm(GROUND, "agent", *connect, "--id", "0") as near,
        machines.swarm(DRONE, "agent", *connect, "--id", "1") as other,
        machines.swarm(DRONE, "agent", *connect, "--id", "2") as drone,
    ):
        world.wait_for("the mission begins")
        for cut_s in (3.0, 13.0):
            sleep(2.0)
            del world.said[:], drone.said[:]
            with machines.cut(cut):
                began_s = monotonic()
                world.wait_for(CUT)
                drone.wait_for("holds still")
                sleep(max(0.0, began_s + cut_s - monotonic()))
                mended_s = monotonic()
            world.wait_for(BACK)
            assert monotonic() - mended_s < RESUME_S
            drone.wait_for("the world is back")
            # Had it taken a cue of before for one of now, the time without would have been shorter, or in pieces.
            [without_s] = map(float, re.findall(r"the world is back, after ([\d.]+) s without", drone.output))
            assert cut_s - 0.2 < without_s < cut_s + 1.0
        codes = [process.wait() for process in (world, near, other, drone)]
        assert codes == [0, 0, 0, 0], world.output + drone.output
    report = report_of(file)
    assert report["duration_s"] == 36.0
    assert {fault["agent"] for fault in report["faults"]} == {1, 2}


def _network(folder: Path, *, secured: bool) -> tuple[str, ...]:
    """What every process is told of the network."""
    if not secured:
        return ()
    pytest.importorskip("cryptography")
    keys = str(folder / "keys")
    subprocess.run((*COMMAND, "keys", keys, "--agents", "3"), check=True, cwd=ROOT, capture_output=True)
    return ("--keys", keys)


def test_who_is_alone_for_too_long_flies_home_and_the_others_go_on(tmp_path: Path) -> None:
    mission = ("quickstart", *SMALL, "--speed", "2", "--duration", "60", "--set", "agents.may_lose=1")
    mission = (*mission, "--set", "agents.world_timeout_s=3")
    with (
        two_machines() as machines,
        machines.swarm(GROUND, "world", *mission, *LISTEN, "--insecure") as world,
        machines.swarm(GROUND, "agent", *mission, "--connect", ENDPOINT, "--id", "0-1") as others,
        machines.swarm(DRONE, "agent", *mission, "--connect", ENDPOINT, "--id", "2") as drone,
    ):
        world.wait_for("the mission begins")
        with machines.cut(Cut.SILENT):
            assert drone.wait() == 1, drone.output
            assert "no word from the world: flying home" in drone.output
            assert "landed and disarmed" in drone.output
        assert [world.wait(), others.wait()] == [0, 0], world.output


@pytest.mark.parametrize("speed", ["2", "max"])
def test_a_mission_whose_agents_are_all_cut_off_waits_for_them(tmp_path: Path, speed: str) -> None:
    file = tmp_path / "report.json"
    mission = ("quickstart", *SMALL, "--speed", speed, "--duration", "400" if speed == "max" else "20")
    mission = (*mission, "--set", "agents.may_lose=3")
    with (
        two_machines() as machines,
        machines.swarm(GROUND, "world", *mission, *LISTEN, "--insecure", "--report", str(file)) as world,
        machines.swarm(DRONE, "agent", *mission, "--connect", ENDPOINT, "--id", "0-2") as drones,
    ):
        world.wait_for("the mission begins")
        with machines.cut(Cut.SILENT):
            world.wait_for(CUT)
            sleep(2.0)
        world.wait_for(BACK)
        assert [world.wait(), drones.wait()] == [0, 0], world.output + drones.output
    assert drones.output.count("landed and disarmed") == 3


def test_in_lockstep_the_world_goes_on_and_time_stands_still_for_who_is_cut_off() -> None:
    mission = ("quickstart", *SMALL, "--duration", "100000", "--set", "agents.may_lose=1")
    with (
        two_machines() as machines,
        machines.swarm(GROUND, "world", *mission, *LISTEN, "--insecure") as world,
        machines.swarm(GROUND, "agent", *mission, "--connect", ENDPOINT, "--id", "0-1") as others,
        machines.swarm(DRONE, "agent", *mission, "--connect", ENDPOINT, "--id", "2") as drone,
    ):
        world.wait_for("the mission begins")
        with machines.cut(Cut.SILENT):
            world.wait_for(CUT)
            sleep(2.0)
        world.wait_for(BACK)
        drone.wait_for("the world is back")
        world.process.terminate()
        assert [world.wait(), others.wait(), drone.wait()] == [0, 0, 0], world.output + drone.output
    assert "landed and disarmed" in drone.output


def test_a_recording_goes_on_and_tells_what_is_missing(tmp_path: Path) -> None:
    pytest.importorskip("rerun")
    file = tmp_path / "cut.rrd"
    mission = ("quickstart", *SMALL, "--speed", "2", "--duration", "20")
    with (
        two_machines() as machines,
        machines.swarm(GROUND, "world", *mission, *LISTEN, "--insecure", "--recorded") as world,
        machines.swarm(GROUND, "agent", *mission, "--connect", ENDPOINT, "--id", "0-2") as agents,
        machines.swarm(DRONE, "record", *mission, "--connect", ENDPOINT, "--record", str(file)) as recorder,
    ):
        world.wait_for("the mission begins")
        with machines.cut(Cut.UNPLUGGED):
            sleep(3.0)
        assert [world.wait(), agents.wait(), recorder.wait()] == [1, 0, 1], world.output + recorder.output
    [missing] = map(int, re.findall(r"its link was cut: (\d+) ticks are missing", recorder.output))
    assert 50 < missing < 90
    assert file.exists()
