"""Units and container file: systemd takes them, and what they start is a mission."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest

import missions.deploy
from tests.missions.daemons.swarm import SMALL, free_endpoint, swarm

FOLDER = Path(missions.deploy.__file__).parent
INSTALLED = "/opt/swarm/bin/swarm"
UNITS = {"swarm-world.service": "", "swarm-agent@.service": "2", "swarm-recorder.service": ""}


def settings(text: str) -> dict[str, str]:
    return dict(line.split("=", 1) for line in text.splitlines() if "=" in line and not line.startswith("#"))


def command(unit: str, variables: dict[str, str]) -> list[str]:
    """The words that systemd would run: `${NAME}` is one word, `$NAME` as many as are in it."""
    [line] = re.findall(r"^ExecStart=(.*)$", (FOLDER / unit).read_text(), re.MULTILINE)
    line = line.replace("%i", UNITS[unit]).replace("%S/swarm", variables["%S/swarm"])
    words: list[str] = []
    for word in line.split():
        if word.startswith("$") and not word.startswith("${"):
            words += shlex.split(variables[word[1:]])
        else:
            words.append(re.sub(r"\$\{(\w+)\}", lambda name: variables[name[1]], word))
    assert words[0] == INSTALLED
    return words[1:]


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="needs systemd-analyze")
def test_systemd_takes_the_units(tmp_path: Path) -> None:
    names = []
    for file in FOLDER.glob("swarm*.*"):
        name = file.name.replace("@.", "@3.")
        (tmp_path / name).write_text(file.read_text().replace(INSTALLED, sys.executable))
        names += [f"./{name}"] if file.suffix != ".env" else []
    assert len(names) == 4
    verify = ["systemd-analyze", "verify", "--man=no", *names]
    verdict = subprocess.run(verify, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (verdict.returncode, verdict.stderr) == (0, "")


@pytest.mark.parametrize("unit", UNITS)
def test_a_stop_leaves_time_to_land(unit: str) -> None:
    said = settings((FOLDER / unit).read_text())
    assert said["KillSignal"] == "SIGTERM"
    assert said["KillMode"] == "mixed"  # a second SIGTERM would end it in the air
    assert float(said["TimeoutStopSec"]) >= 120.0
    assert said["PartOf"] == said["WantedBy"] == "swarm.target"


def test_a_world_that_ends_does_not_begin_again() -> None:
    assert settings((FOLDER / "swarm-world.service").read_text())["Restart"] == "no"


def test_the_recorder_is_stopped_after_the_world() -> None:
    recorder = settings((FOLDER / "swarm-recorder.service").read_text())
    assert recorder["Before"] == "swarm-world.service"
    assert "swarm-world" not in recorder["After"]


def test_what_the_units_start_is_a_mission(tmp_path: Path) -> None:
    pytest.importorskip("rerun")
    variables = settings((FOLDER / "swarm.env").read_text())
    assert re.fullmatch(r"--keys \S+ --speed 1 --join-timeout 86400", variables["SWARM_OPTIONS"])
    endpoint = free_endpoint()
    changes = shlex.join([*SMALL, "--duration", "5", "--speed", "max"])
    variables |= {"SWARM_MISSION": "quickstart", "SWARM_LISTEN": endpoint, "SWARM_WORLD": endpoint}
    variables |= {"SWARM_OPTIONS": changes, "INVOCATION_ID": "42", "%S/swarm": str(tmp_path)}
    with ExitStack() as stack:
        processes = [stack.enter_context(swarm(*command(unit, variables))) for unit in UNITS]
        others = stack.enter_context(
            swarm("agent", "quickstart", "--connect", endpoint, "--id", "0-1", *changes.split())
        )
        for process in (*processes, others):
            assert process.wait() == 0, process.output
    assert (tmp_path / "42.json").exists()
    assert (tmp_path / "42.rrd").exists()


def test_the_container_flies_and_nothing_else() -> None:
    text = (FOLDER / "Containerfile").read_text()
    assert re.search(r"^RUN .*pip install --no-cache-dir \.$", text, re.MULTILINE)  # without extras
    assert "\nSTOPSIGNAL SIGTERM\n" in text
    assert text.index("\nUSER swarm\n") < text.index('\nENTRYPOINT ["swarm"]\n')
    root = FOLDER.parents[1]
    copied = [word for line in re.findall(r"^COPY (?!--)(.*) \S+$", text, re.MULTILINE) for word in line.split()]
    assert {"comms", "swarm_agent", "vehicle_sim", "missions", "pyproject.toml"} <= set(copied)
    assert all((root / name).exists() for name in copied)
