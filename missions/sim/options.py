"""The command line of `swarm sim`, and what it comes to."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from comms.frames import GeoPoint
from comms.signing import KeyFileError, read_key
from comms.transport import FORMS, transport_of
from missions.problems import any_of
from vehicle_sim.vehicle import FLAVOR_NAMES, READY_S, FlavorName

SITL_PORT = 5760
SITL_HOME = "-35.363261,149.165230,584,353"
HIGHEST_SYSTEM_ID = 250
LONGEST_BOOT_S = 600.0
FASTEST = 100.0
_READY = ", ".join(f"{name} {ready_s:g}" for name, ready_s in READY_S.items())

EXAMPLES = """examples:
  swarm sim                                      as ArduCopter SITL: tcp:127.0.0.1:5760, armable after 41 s
  swarm sim --boot 2 --home 47.397742,8.545594,488,0 --sysid 7
  swarm sim --flavour px4 --link udpout:127.0.0.1:14540    as PX4 SITL speaks to a companion
  swarm sim --link udpout:127.0.0.1:14550        announces itself, as QGroundControl expects
  swarm sim --link pty:/tmp/vehicle --param SYSID_MYGCS=252
then, elsewhere: mavproxy.py --master tcp:127.0.0.1:5760

Each link is one of the autopilot's ports, with message rates of its own. It ends with Ctrl-C (exit code 130)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SimOptions:
    """One vehicle and its links.

    Attributes:
        links: what asked for each, and its URL of `comms.transport`. key: what all are signed with, if they are.
        heading_deg: clockwise from north. speed: times real time.
        boot_s: from power-on to armable. parameters: (name, value) to set at power-on.
    """

    links: tuple[tuple[str, str], ...]
    key: bytes | None = None
    flavour: FlavorName
    system_id: int
    home: GeoPoint
    heading_deg: float
    speed: float
    boot_s: float
    seed: int
    parameters: tuple[tuple[str, float], ...]


def add_options(parser: argparse.ArgumentParser) -> None:
    """What `swarm sim` may be told."""
    add = parser.add_argument
    add("--port", type=_port, metavar="P", help=f"listen on tcpin:127.0.0.1:P ({SITL_PORT} unless a --link is given)")
    add("--link", type=link, action="append", default=[], metavar="URL", help=f"{FORMS}; may be repeated")
    add("--signing-key", type=signing_key, metavar="FILE", help="sign, with the key or passphrase in FILE (mode 0600)")
    add("--flavour", type=_flavour, default=FLAVOR_NAMES[0], metavar="NAME", help=f"{any_of(FLAVOR_NAMES)}")
    add(
        "--sysid",
        type=_system_id,
        default=1,
        metavar="N",
        help=f"its MAVLink system id: 1 (default) to {HIGHEST_SYSTEM_ID}",
    )
    add(
        "--home",
        type=_home,
        default=SITL_HOME,
        metavar="LAT,LON,ALT,HEADING",
        help=f"degrees, meters, degrees ({SITL_HOME})",
    )
    add("--speed", type=_speed, default=1.0, metavar="X", help="X times real time (default: 1)")
    add(
        "--boot",
        type=_boot,
        metavar="S",
        help=f"armable after S seconds (as the real one: {_READY})",
    )
    add("--seed", type=_seed, default=0, metavar="N", help="of gusts and sensor noise (default: 0)")
    add(
        "--param",
        type=_parameter,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="set a parameter; may be repeated",
    )


def sim_options(given: argparse.Namespace) -> SimOptions:
    """What the command line comes to."""
    home, heading_deg = given.home
    port = SITL_PORT if given.port is None and not given.link else given.port
    return SimOptions(
        links=(
            *(() if port is None else (("--port", f"tcpin:127.0.0.1:{port}"),)),
            *(("--link", url) for url in given.link),
        ),
        key=given.signing_key,
        flavour=given.flavour,
        system_id=given.sysid,
        home=home,
        heading_deg=heading_deg,
        speed=given.speed,
        boot_s=READY_S[given.flavour] if given.boot is None else given.boot,
        seed=given.seed,
        parameters=tuple(given.param),
    )


def link(text: str) -> str:
    """A URL of a transport, checked."""
    try:
        return transport_of(text).url
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def signing_key(text: str) -> bytes:
    """The key in a file."""
    try:
        return read_key(Path(text))
    except KeyFileError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _flavour(text: str) -> FlavorName:
    for name in FLAVOR_NAMES:
        if text == name:
            return name
    raise argparse.ArgumentTypeError(f'got "{text}"; allowed: {any_of(FLAVOR_NAMES)}')


def _home(text: str) -> tuple[GeoPoint, float]:
    numbers = [_float(part) for part in text.split(",")]
    if len(numbers) == 4:
        latitude, longitude, altitude, heading = numbers
        # Next to a pole there is no east; a NaN compares false.
        if abs(latitude) <= 89.0 and abs(longitude) <= 180.0 and abs(altitude) <= 9000.0 and 0.0 <= heading <= 360.0:
            return GeoPoint(latitude, longitude, altitude), heading
    allowed = "LAT,LON,ALT,HEADING: -89 to 89, -180 to 180, -9000 to 9000 m, 0 to 360"
    raise argparse.ArgumentTypeError(f'got "{text}"; allowed: {allowed}')


def _parameter(text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    if not (name and equals and isfinite(_float(value))):
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: NAME=NUMBER')
    return name.upper(), float(value)


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float("nan")


def _number(text: str, lowest: float, highest: float, what: str) -> float:
    value = _float(text)
    if not lowest <= value <= highest:
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: {what} from {lowest:g} to {highest:g}')
    return value


def _whole(text: str, lowest: int, highest: int) -> int:
    if not (text.isascii() and text.isdigit() and len(text) <= 10 and lowest <= int(text) <= highest):
        raise argparse.ArgumentTypeError(f'got "{text}"; allowed: a whole number from {lowest} to {highest}')
    return int(text)


def _port(text: str) -> int:
    return _whole(text, 0, 65_535)


def _system_id(text: str) -> int:
    return _whole(text, 1, HIGHEST_SYSTEM_ID)


def _seed(text: str) -> int:
    return _whole(text, 0, 2**32 - 1)


def _speed(text: str) -> float:
    return _number(text, 0.01, FASTEST, "a number")


def _boot(text: str) -> float:
    return _number(text, 0.0, LONGEST_BOOT_S, "seconds")
