"""MAVProxy watches a swarm of five through one port while it flies: `python -m tests.clients.swarm_session PYTHON`.

PYTHON is an interpreter that has the mission stack.
"""

from __future__ import annotations

import json
import socket
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.clients.mavproxy_session import Terminal, mavproxy
from tests.clients.steps import expect, step

N_AGENTS = 5
DURATION_S = 20


def free_port() -> int:
    """A UDP port that is free now."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def watch(terminal: Terminal) -> None:
    """Everybody is there, arms, and takes off; the one asked answers."""
    step("five systems", lambda: terminal.printed(*(f"Detected vehicle {n}:1 " for n in range(1, N_AGENTS + 1))))
    step("they arm", lambda: terminal.printed("ARMED", timeout_s=60.0))
    step("vehicle 3 chosen", lambda: terminal.type("vehicle 3"))
    step(
        "vehicle 3 answers",
        lambda: terminal.ask("long 31999 0 0 0 0 0 0 0", "COMMAND_ACK {command : 31999, result : 3"),
    )


def main(python: str) -> None:
    with TemporaryDirectory() as name:
        folder, port = Path(name), free_port()
        report = folder / "report.json"
        program = "import sys; from missions.cli import main; sys.exit(main(sys.argv[1:]))"
        arguments = [
            "launch", "quickstart", "--set", f"agents.count={N_AGENTS}", "--duration", str(DURATION_S),
            "--speed", "1", "--gcs", f"udpout:127.0.0.1:{port}", "--report", str(report),
        ]  # fmt: skip
        with mavproxy(f"udpin:127.0.0.1:{port}", folder) as terminal:
            process = subprocess.Popen([python, "-c", program, *arguments], stdout=subprocess.DEVNULL)
            try:
                watch(terminal)
                step("the mission ends well", lambda: done(process, report))
            finally:
                process.kill()
                process.wait(timeout=10.0)


def done(process: subprocess.Popen[Any], report: Path) -> str:
    expect(process.wait(timeout=150.0) == 0, "swarm launch failed")
    said = json.loads(report.read_text())
    expect(said["faults"] == [], f"faults: {said['faults']}")
    return f"coverage {said['coverage']:.2f}, latest tick {said['timing']['tick_late_s_max']:.3f} s late"


if __name__ == "__main__":
    main(sys.argv[1])
