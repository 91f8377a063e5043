"""Every session must pass, and fail where a message is withheld: `python -m tests.clients --swarm PYTHON`.

PYTHON is an interpreter that has the mission stack; the clients live in the environment of the one that runs this.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from typing import NamedTuple

from tests.clients.relay import relay
from tests.clients.signed_session import PASSPHRASE

SPEED = "3"
SESSION_S = 240.0
PROGRAM = "import sys; from missions.cli import main; sys.exit(main(sys.argv[1:]))"


class Flight(NamedTuple):
    """One session against `swarm sim`.

    Attributes:
        url: how its client names a TCP port. withheld: (message id, name), if any, that does not get through.
        fails_at: the step that must fail then. passphrase: what the vehicle's link is signed with.
    """

    module: str
    url: str = "tcp:{}"
    flavour: str = "ardupilot"
    boot_s: int = 10
    withheld: tuple[int, str] | None = None
    fails_at: str = ""
    passphrase: str = ""


MAVSDK, MAVUTIL, MAVPROXY = "mavsdk_session", "mavutil_session", "mavproxy_session"
MAVSDK_PX4, MAVUTIL_PX4 = "mavsdk_px4_session", "mavutil_px4_session"
FLIGHTS = (
    Flight(MAVSDK, "tcpout://{}"),
    Flight(MAVSDK, "tcpout://{}", withheld=(242, "HOME_POSITION"), fails_at="health_all_ok"),
    Flight(MAVSDK, "tcpout://{}", withheld=(47, "MISSION_ACK"), fails_at="fence"),
    Flight(MAVSDK_PX4, "tcpout://{}", flavour="px4"),
    Flight(MAVSDK_PX4, "tcpout://{}", flavour="px4", withheld=(51, "MISSION_REQUEST_INT"), fails_at="fence"),
    Flight(MAVSDK_PX4, "tcpout://{}", flavour="px4", withheld=(1, "SYS_STATUS"), fails_at="health_all_ok"),
    Flight(MAVUTIL),
    Flight(MAVUTIL, withheld=(77, "COMMAND_ACK"), fails_at="arm refusal"),
    Flight(MAVUTIL, withheld=(22, "PARAM_VALUE"), fails_at="parameters"),
    Flight(MAVUTIL_PX4, flavour="px4"),
    Flight(MAVUTIL_PX4, flavour="px4", withheld=(77, "COMMAND_ACK"), fails_at="arm refusal"),
    Flight(MAVPROXY, boot_s=60),
    Flight(MAVPROXY, boot_s=60, withheld=(253, "STATUSTEXT"), fails_at="arm refusal"),
    Flight(MAVPROXY, boot_s=60, withheld=(40, "MISSION_REQUEST"), fails_at="mission up"),
    Flight("signed_session", boot_s=0, passphrase=PASSPHRASE),
)


@contextmanager
def simulated(python: str, flight: Flight) -> Iterator[str]:
    """The URL of a vehicle that has just been switched on, in a process of its own."""
    arguments = ["sim", "--flavour", flight.flavour, "--port", "0", "--boot", str(flight.boot_s), "--speed", SPEED]
    key = Path(mkdtemp()) / "key"
    if flight.passphrase:
        key.touch(mode=0o600)
        key.write_text(flight.passphrase)
        arguments += ["--signing-key", str(key)]
    process = subprocess.Popen([python, "-c", PROGRAM, *arguments], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        yield process.stdout.readline().strip().partition(" on ")[2].replace("tcpin", "tcp")
    finally:
        process.terminate()
        process.communicate(timeout=20.0)
        rmtree(key.parent)


def fly(flight: Flight, python: str) -> bool:
    """Whether it went as it must."""
    message_id, name = flight.withheld or (None, "")
    print(f"\n{flight.module}{f' without {name}' if name else ''}", flush=True)
    with simulated(python, flight) as vehicle, relay(vehicle, message_id) as port:
        code, printed = run(flight.module, flight.url.format(port))
    if not flight.withheld:
        return code == 0
    return code == 1 and f"FAILED {flight.fails_at}:" in printed


def run(module: str, argument: str) -> tuple[int, str]:
    """A session's exit code, and what it printed."""
    command = [sys.executable, "-m", f"tests.clients.{module}", argument]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=SESSION_S)
    except subprocess.TimeoutExpired:
        return -1, "too long"
    lines = (done.stdout + done.stderr).splitlines()
    print("\n".join(line for line in lines if "\x1b[" not in line), flush=True)  # MAVSDK's own log has colors
    return done.returncode, done.stdout


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m tests.clients", description="Fly simulated vehicles by real clients."
    )
    parser.add_argument("--swarm", required=True, metavar="PYTHON", help="an interpreter that has the mission stack")
    parser.add_argument("--only", default="", metavar="NAME", help="sessions whose name begins so")
    options = parser.parse_args()
    results = {
        f"{flight.module} {flight.withheld[1] if flight.withheld else ''}": fly(flight, options.swarm)
        for flight in FLIGHTS
        if flight.module.startswith(options.only)
    }
    for module, argument in (("raw_session", ""), ("swarm_session", options.swarm)):
        if module.startswith(options.only):
            print(f"\n{module}", flush=True)
            results[module] = run(module, argument)[0] == 0
    print()
    for name, right in results.items():
        print(f"{'as it must' if right else 'WRONG     '}  {name}")
    return 0 if all(results.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
