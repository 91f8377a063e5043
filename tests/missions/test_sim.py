"""`swarm sim`: what it may be told, and a real process that a ground station talks to."""

from __future__ import annotations

import argparse
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from math import pi
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint
from comms.mavlink import Endpoint
from comms.transport import Transport, transport_of
from missions.cli import main
from missions.exit_codes import BAD_INPUT, STOPPED
from missions.sim.options import add_options, sim_options
from missions.sim.session import TOO_LATE_S, SlippingPace, power_on
from tests.patience import PATIENCE_S, until

ARGUMENTS = "import sys; from missions.cli import main; sys.exit(main(sys.argv[1:]))"


@contextmanager
def running(*arguments: str) -> Iterator[tuple[subprocess.Popen[str], list[str]]]:
    """The process of `swarm sim`, once it says where it listens; and the URLs of its links."""
    process = subprocess.Popen(
        [sys.executable, "-c", ARGUMENTS, "sim", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        first = process.stdout.readline()
        assert " on " in first, process.communicate(timeout=PATIENCE_S)
        yield process, first.strip().partition(" on ")[2].split(", ")
    finally:
        process.kill()
        process.communicate(timeout=PATIENCE_S)


def asked_for_attitude(transport: Transport, system_id: int) -> None:
    """The vehicle there is asked for ATTITUDE, and sends it."""
    end, heard = Endpoint(system_id=255, component_id=190), set()

    def seen() -> bool:
        end.send(dialect.MAVLink_command_long_message(system_id, 1, 511, 0, 30, 50_000, 0, 0, 0, 0, 0))
        transport.write(end.take())
        for chunk in transport.read(0.0):
            heard.update((m.get_type(), m.get_srcSystem()) for m in end.receive(chunk))
        return {("HEARTBEAT", system_id), ("ATTITUDE", system_id)} <= heard

    until(seen)


def test_a_vehicle_on_three_links_until_ctrl_c(tmp_path: Path) -> None:
    port = tmp_path / "port"
    links = ["--port", "0", "--link", "udpin:127.0.0.1:0", "--link", f"pty:{port}"]
    with running(*links, "--sysid", "7", "--boot", "0") as (process, (tcp, udp, pty)):
        ends = [tcp.replace("tcpin", "tcp"), udp.replace("udpin", "udpout"), pty.replace("pty", "serial") + ":115200"]
        for url in ends:
            with transport_of(url) as transport:
                asked_for_attitude(transport, 7)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=PATIENCE_S)
        assert (process.returncode, err) == (STOPPED, "")
        assert [line.split(": ")[0] for line in out.splitlines()] == [tcp, udp, pty]
        assert not port.is_symlink()


def test_a_taken_port_is_bad_input(capsys: pytest.CaptureFixture[str]) -> None:
    with transport_of("tcpin:127.0.0.1:0") as taken:
        assert main(["sim", "--port", taken.url.rpartition(":")[2]]) == BAD_INPUT
        assert capsys.readouterr().err == f"--port: {taken.url}: Address already in use\n"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--flavour", "px5"], 'argument --flavour: got "px5"; allowed: ardupilot or px4'),
        (["--sysid", "251"], 'argument --sysid: got "251"; allowed: a whole number from 1 to 250'),
        (["--sysid", "0"], "allowed: a whole number from 1 to 250"),
        (["--home", "1,2,3"], "argument --home: got"),
        (["--home", "91,0,0,0"], "LAT,LON,ALT,HEADING"),
        (["--home", "-91,0,0,0"], "LAT,LON,ALT,HEADING"),
        (["--home", "nan,0,0,0"], "LAT,LON,ALT,HEADING"),
        (["--speed", "0"], "allowed: a number from 0.01 to 100"),
        (["--speed", "max"], "allowed: a number from 0.01 to 100"),
        (["--boot", "-1"], "allowed: seconds from 0 to 600"),
        (["--param", "RTL_ALT"], "allowed: NAME=NUMBER"),
        (["--param", "RTL_ALT=inf"], "allowed: NAME=NUMBER"),
        (["--param", "RTL_ALTI=3"], "did you mean RTL_ALT"),
        (["--flavour", "px4", "--param", "RTL_RETURN_AL=3"], "did you mean RTL_RETURN_ALT"),
        (["--flavour", "px4", "--param", "RTL_ALT=3"], "got RTL_ALT, which it does not have"),
        (["--param", "SYSID_THISMAV=3"], "SYSID_THISMAV is read-only"),
        (["--port", "70000"], "allowed: a whole number from 0 to 65535"),
        (["--link", "udp:1"], "allowed: tcp:HOST:PORT"),
        (["--link", "serial:/dev/no-such-line:57600"], "--link: serial:/dev/no-such-line:57600"),
    ],
)
def test_bad_input_says_what_is_allowed(arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sim", *arguments]) == BAD_INPUT
    printed = capsys.readouterr()
    assert printed.out == ""
    assert told in printed.err


@pytest.mark.parametrize(("flavour", "mode", "boot_s"), [("ardupilot", "STABILIZE", 41.16), ("px4", "HOLD", 10.0)])
def test_each_flavour_boots_as_the_real_one_does(flavour: str, mode: str, boot_s: float) -> None:
    parser = argparse.ArgumentParser()
    add_options(parser)
    options = sim_options(parser.parse_args(["--flavour", flavour]))
    assert (power_on(options).mode_name, options.boot_s) == (mode, boot_s)


def test_parameters_go_by_old_and_new_names() -> None:
    parser = argparse.ArgumentParser()
    add_options(parser)
    given = ["--param", "RTL_ALT_M=20", "--param", "sysid_mygcs=252", "--home", "47.4,8.5,488,90", "--sysid", "9"]
    vehicle = power_on(sim_options(parser.parse_args(given))).autopilot
    assert (vehicle.parameters["RTL_ALT"], vehicle.parameters["SYSID_MYGCS"]) == (2000.0, 252.0)
    assert (vehicle.system_id, vehicle.home) == (9, GeoPoint(47.4, 8.5, 488.0))
    assert vehicle.airframe.yaw_rad == pytest.approx(pi / 2)


@pytest.mark.parametrize(
    ("given", "links"),
    [
        ([], ("tcpin:127.0.0.1:5760",)),
        (["--port", "5770"], ("tcpin:127.0.0.1:5770",)),
        (["--link", "udpout:127.0.0.1:14550"], ("udpout:127.0.0.1:14550",)),
        (["--link", "pty", "--port", "5760"], ("tcpin:127.0.0.1:5760", "pty")),
    ],
)
def test_it_listens_where_sitl_does_unless_told(given: list[str], links: tuple[str, ...]) -> None:
    parser = argparse.ArgumentParser()
    add_options(parser)
    assert [url for _, url in sim_options(parser.parse_args(given)).links] == list(links)


def test_a_clock_that_cannot_keep_up_slips_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    wall_s, told = 0.0, list[str]()
    monkeypatch.setattr(time, "monotonic", lambda: wall_s)
    pace = SlippingPace(speed=2.0, tell=told.append)
    for tick in range(1, 201):  # due every 10 ms, done in 30
        late_s = pace.begin(tick)
        assert late_s <= TOO_LATE_S + 0.03
        wall_s += 0.03
    assert told == ["too slow for 2 times real time: 0.5 s late, the clock slips"]
