"""Flight logs become recordings: what is in a log is in the recording, whatever else is in the file."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa
import pytest
import rerun as rr
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as dialect
from rerun.chunk import RrdReader

from missions.cli import main
from missions.flightlog import Entry, FlightLog
from missions.recording import imported
from missions.recording.texts import Texts

BEGAN_US = 1_700_000_000_000_000
HEARTBEAT = dialect.MAVLink_heartbeat_message(2, 3, 81, 4, 3, 3)
PLACE = dialect.MAVLink_global_position_int_message(1000, 473977000, 85456000, 500_000, 12_500, 300, -400, 0, 9000)


def _entry(message: object, *, after_s: float = 0.0, system: int = 1, version: int = 2) -> bytes:
    codec = dialect.MAVLink(None, srcSystem=system, srcComponent=1)
    frame = message.pack(codec, force_mavlink1=version == 1)  # type: ignore[attr-defined]
    return struct.pack(">Q", BEGAN_US + round(after_s * 1e6)) + frame


def _read(data: bytes) -> tuple[FlightLog, list[Entry]]:
    log = FlightLog(data)
    return log, list(log)


def _kinds(entries: Sequence[Entry]) -> list[str]:
    return [entry.message.get_type() for entry in entries]


@pytest.mark.parametrize("version", [1, 2])
def test_messages_and_times_come_back(version: int) -> None:
    data = _entry(HEARTBEAT, version=version) + _entry(PLACE, after_s=1.5, version=version)
    log, entries = _read(data)
    assert _kinds(entries) == ["HEARTBEAT", "GLOBAL_POSITION_INT"]
    assert [entry.unix_s - BEGAN_US / 1e6 for entry in entries] == pytest.approx([0.0, 1.5])
    assert log.skipped_bytes == 0


@pytest.mark.parametrize("cut", [1, 8, 9, 15, 20])
def test_a_torn_end_costs_what_is_torn(cut: int) -> None:
    whole, torn = _entry(HEARTBEAT), _entry(PLACE)
    log, entries = _read(whole + torn[:cut])
    assert len(entries) == log.messages == 1
    assert log.skipped_bytes == cut


@given(before=st.binary(max_size=400), after=st.binary(max_size=400))
def test_rubbish_hides_no_message_and_never_raises(before: bytes, after: bytes) -> None:
    _read(before)
    _, entries = _read(_entry(HEARTBEAT) + before + _entry(PLACE) + after)
    assert _kinds(entries) == ["HEARTBEAT", "GLOBAL_POSITION_INT"]


def test_a_flipped_bit_costs_one_message() -> None:
    data = bytearray(_entry(HEARTBEAT) + _entry(PLACE) + _entry(HEARTBEAT))
    data[len(_entry(HEARTBEAT)) + 8 + 12] ^= 0x10
    assert _kinds(_read(bytes(data))[1]) == ["HEARTBEAT", "HEARTBEAT"]


def _column(path: Path, entity: str, component: str) -> list[object]:
    values: list[object] = []
    for chunk in RrdReader(path).stream().filter(content=entity, components=component, is_static=False).to_chunks():
        values += pa.record_batch(chunk.to_record_batch()).column(component).to_pylist()
    return values


def test_a_flight_is_in_the_recording(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rr.set_strict_mode(True)
    text = dialect.MAVLink_statustext_message(4, b"EKF variance")
    landed = dialect.MAVLink_heartbeat_message(2, 3, 209, 9, 3, 3)
    plane = dialect.MAVLink_heartbeat_message(1, 3, 81, 4, 3, 3)
    first = [_entry(HEARTBEAT), _entry(PLACE, after_s=1), _entry(text, after_s=2), _entry(landed, after_s=3)]
    (tmp_path / "a.tlog").write_bytes(b"".join(first))
    (tmp_path / "b.tlog").write_bytes(_entry(plane, system=9) + _entry(HEARTBEAT, system=255))
    out = tmp_path / "out.rrd"
    assert main(["import", str(tmp_path / "a.tlog"), str(tmp_path / "b.tlog"), "--to", str(out)]) == 0
    assert capsys.readouterr().out.strip() == f"{out}: V1, V9, 6 messages in 0:03.0"
    assert _column(out, "/vehicles/V1/mode", "StateChange:state") == [["GUIDED, disarmed"], ["LAND, armed"]]
    assert _column(out, "/vehicles/V9/mode", "StateChange:state") == [["ACRO, disarmed"]]
    assert _column(out, "/log/V1", "TextLog:text") == [["V1  EKF variance"]]
    assert _column(out, "/charts/0/V1", "Scalars:scalars") == [[12.5]]
    assert _column(out, "/charts/1/V1", "Scalars:scalars") == [[5.0]]
    assert _column(out, "/geo/V1", "GeoPoints:positions") == [[pytest.approx([47.3977, 8.5456])]]
    assert not out.with_name("out.rrd.part").exists()


@pytest.mark.parametrize(("second_s", "is_told"), [(4.0, False), (2.5, False), (0.0, True)])
def test_a_log_whose_time_goes_back_is_told_of(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], second_s: float, is_told: bool
) -> None:
    lives = (_entry(PLACE, after_s=after_s) for after_s in (1.0, 3.0, second_s, second_s + 1.0))
    (tmp_path / "a.tlog").write_bytes(b"".join(lives))
    assert main(["import", str(tmp_path / "a.tlog"), "--to", str(tmp_path / "out.rrd")]) == 0
    assert ("its time goes back, by up to 3.0 s" in capsys.readouterr().out) is is_told


# HEARTBEAT's type, autopilot and custom_mode, and the mode as ArduPilot's and PX4's ground stations show it.
@pytest.mark.parametrize(
    ("vehicle_type", "autopilot", "number", "name"),
    [
        (2, 3, 5, "LOITER"),
        (1, 3, 5, "FLY_BY_WIRE_A"),
        (20, 3, 21, "QRTL"),
        (10, 3, 4, "HOLD"),
        (11, 3, 12, "SMART_RTL"),
        (12, 3, 9, "SURFACE"),
        (1, 3, 27, "mode 27"),  # where the dialect's enum ends
        (26, 3, 0, "mode 0"),
        (2, 99, 7, "mode 7"),
    ],
)
def test_modes_have_the_names_of_their_vehicle(
    tmp_path: Path, vehicle_type: int, autopilot: int, number: int, name: str
) -> None:
    heartbeat = dialect.MAVLink_heartbeat_message(vehicle_type, autopilot, 81, number, 3, 3)
    (tmp_path / "a.tlog").write_bytes(_entry(heartbeat))
    out = tmp_path / "out.rrd"
    assert main(["import", str(tmp_path / "a.tlog"), "--to", str(out)]) == 0
    assert _column(out, "/vehicles/V1/mode", "StateChange:state") == [[f"{name}, disarmed"]]


@pytest.mark.parametrize(
    ("system", "autopilot", "who"), [(1, 3, "V1"), (245, 3, "V245"), (245, 8, "no vehicle"), (255, 8, "no vehicle")]
)
def test_a_vehicle_is_who_has_an_autopilot(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], system: int, autopilot: int, who: str
) -> None:
    heartbeat = dialect.MAVLink_heartbeat_message(6 if autopilot == 8 else 2, autopilot, 81, 4, 3, 3)
    (tmp_path / "a.tlog").write_bytes(_entry(heartbeat, system=system))
    assert main(["import", str(tmp_path / "a.tlog"), "--to", str(tmp_path / "out.rrd")]) == 0
    assert f"out.rrd: {who}, 1 messages" in capsys.readouterr().out


@pytest.mark.parametrize("to", ["a.tlog", "b.tlog", "out.png"])
def test_a_log_is_never_replaced_by_its_recording(tmp_path: Path, capsys: pytest.CaptureFixture[str], to: str) -> None:
    log = tmp_path / "a.tlog"
    log.write_bytes(_entry(HEARTBEAT))
    assert main(["import", str(log), "--to", str(tmp_path / to)]) == 2
    assert "a file that ends with .rrd, and is none of the logs" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["a.tlog"]
    assert log.read_bytes() == _entry(HEARTBEAT)


A, B, C = "a" * 50, "b" * 50, "c" * 20


@pytest.mark.parametrize(
    ("pieces", "texts"),
    [
        ([(1, 0, A), (1, 1, B), (1, 2, C)], [A + B + C]),
        ([(1, 0, A), (0, 0, "short"), (1, 1, C)], ["short", A + C]),
        ([(1, 0, A), (1, 2, C)], [A + "…" + C]),  # the second piece is not in the log
        ([(1, 1, C)], ["…" + C]),
        ([(1, 0, A), (2, 0, C)], [A, C]),  # another text begins
        ([(1, 0, A)], [A]),  # the log ends
        ([(1, 0, C), (1, 0, C)], [C, C]),  # a number may be used again
    ],
)
def test_a_long_text_is_one_text(pieces: Sequence[tuple[int, int, str]], texts: Sequence[str]) -> None:
    joined = Texts()
    messages = [
        dialect.MAVLink_statustext_message(4, text.encode(), id=number, chunk_seq=place)
        for number, place, text in pieces
    ]
    decoded = [entry.message for entry in FlightLog(b"".join(map(_entry, messages)))]
    said = [said for at, message in enumerate(decoded) for said in joined.hear(at, message)] + [*joined.end()]
    assert [one.text for one in said] == texts


def test_what_is_read_in_stretches_is_what_is_read_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    modes = [dialect.MAVLink_heartbeat_message(2, 3, 81, 4 + second // 10, 3, 3) for second in range(30)]
    log = tmp_path / "a.tlog"
    log.write_bytes(
        b"".join(_entry(mode, after_s=second) + _entry(PLACE, after_s=second) for second, mode in enumerate(modes))
    )
    at_once, piecemeal = tmp_path / "at_once.rrd", tmp_path / "piecemeal.rrd"
    assert main(["import", str(log), "--to", str(at_once)]) == 0
    monkeypatch.setattr(imported, "_STRETCH", 7)
    assert main(["import", str(log), "--to", str(piecemeal)]) == 0
    for entity, component, rows in (
        ("/vehicles/V1/mode", "StateChange:state", 3),
        ("/geo/V1", "GeoPoints:positions", 30),
        ("/mavlink/V1/HEARTBEAT", "Scalars:scalars", 30),
    ):
        found = _column(at_once, entity, component)
        assert _column(piecemeal, entity, component) == found
        assert len(found) == rows


def test_what_a_launch_kept_is_read_back(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    launch = ["launch", "narrow", "--duration", "5", "--set", "agents.count=2", "--tlog", str(tmp_path / "logs")]
    assert main(launch) == 0
    logs = sorted(map(str, (tmp_path / "logs").iterdir()))
    capsys.readouterr()
    assert main(["import", *logs, "--to", str(tmp_path / "out.rrd")]) == 0
    told = capsys.readouterr().out
    assert "V1, V2," in told
    assert "left out" not in told


def test_what_is_no_log_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    odd, out = tmp_path / "odd.tlog", tmp_path / "out.rrd"
    odd.write_bytes(bytes(1000))
    assert main(["import", str(odd), "--to", str(out)]) == 2
    assert "got no MAVLink; allowed: a .tlog" in capsys.readouterr().err
    assert main(["import", str(tmp_path / "missing.tlog"), "--to", str(out)]) == 2
    assert not out.exists()


def test_vehicles_of_one_system_id_in_two_logs_are_told_apart_by_time_or_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def log(name: str, *times_s: float) -> str:
        path = tmp_path / name
        path.write_bytes(b"".join(_entry(HEARTBEAT, after_s=time_s) for time_s in times_s))
        return str(path)

    before, after = log("before.tlog", 0.0, 1.0), log("after.tlog", 2.0, 3.0)
    meanwhile = log("meanwhile.tlog", 0.5, 1.5)
    to = str(tmp_path / "both.rrd")
    assert main(["import", before, after, "--to", to]) == 0
    assert "V1, 4 messages" in capsys.readouterr().out
    assert main(["import", before, meanwhile, "--to", to]) == 2
    told = capsys.readouterr().err
    assert f"{before} and {meanwhile}: got vehicles of one system id (V1) at the same time" in told
