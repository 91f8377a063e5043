"""A telemetry log as a recording: where vehicles flew, their modes and words, and every number they sent."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from math import hypot, nan
from pathlib import Path

import numpy as np
import numpy.typing as npt
import rerun as rr
import rerun.blueprint as rrb

from comms.frames import GeoPoint, enu_from_geo
from comms.mavlink import Message, numbers_of
from missions.flightlog import Entry
from missions.problems import OutputError
from missions.recording import palette
from missions.recording.event_view import event_log
from missions.recording.optimize import optimize
from missions.recording.tape import APPLICATION_ID, TIME_LINE
from swarm_agent.autopilot.flavors import ARDUPILOT, FLAVORS

WALL_LINE = "wall_clock"
_GROUND_STATIONS = range(240, 256)  # ids that ground stations take: what they say is kept, and is no vehicle's
_LEVELS = ("CRITICAL", "CRITICAL", "CRITICAL", "ERROR", "WARN", "INFO", "INFO", "DEBUG")  # by MAV_SEVERITY
_COPTERS = frozenset({2, 3, 4, 13, 14, 15, 29})  # MAV_TYPE of all that ArduCopter flies
_ARMED = 128  # MAV_MODE_FLAG_SAFETY_ARMED


@dataclass(frozen=True, slots=True)
class _Chart:
    """What is plotted of one kind of message."""

    title: str
    kind: str
    value_of: Callable[[Message], float]


_CHARTS = (
    _Chart("Altitude above home, m", "GLOBAL_POSITION_INT", lambda said: said.relative_alt * 1e-3),
    _Chart("Ground speed, m/s", "GLOBAL_POSITION_INT", lambda said: hypot(said.vx, said.vy) * 1e-2),
    _Chart(
        "Battery left, %", "SYS_STATUS", lambda said: said.battery_remaining if said.battery_remaining >= 0 else nan
    ),
    _Chart("Throttle, %", "VFR_HUD", lambda said: said.throttle),
)

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class _Told:
    """Messages of one kind of one vehicle, and when: seconds since the log began."""

    times_s: Floats
    messages: Sequence[Message]


class Logbook:
    """Messages by vehicle and kind, being written to one stream."""

    def __init__(self, entries: Sequence[Entry], stream: rr.RecordingStream) -> None:
        self._began_s = min(entry.unix_s for entry in entries)
        self._stream = stream
        gathered: dict[tuple[str, str], list[Entry]] = defaultdict(list)
        for entry in sorted(entries, key=lambda entry: entry.unix_s):
            gathered[_vehicle(entry.message), entry.message.get_type()].append(entry)
        self._told = {
            key: _Told(np.array([entry.unix_s for entry in told]) - self._began_s, [entry.message for entry in told])
            for key, told in gathered.items()
        }
        self.vehicles = sorted({vehicle for vehicle, kind in self._told if kind == "HEARTBEAT" and vehicle[0] == "V"})

    def write(self) -> None:
        """Write everything."""
        for (vehicle, kind), told in self._told.items():
            self._numbers(f"/mavlink/{vehicle}/{kind}", told)
        for place, vehicle in enumerate(self.vehicles):
            color = palette.series_colors(place + 1)[place]
            self._track(vehicle, color)
            self._modes(vehicle)
            self._words(vehicle)
            self._charts(vehicle, color)

    def _send(self, path: str, times_s: Floats, columns: rr.ComponentColumnList) -> None:
        since_1970_ns = np.round((self._began_s + times_s) * 1e9).astype("datetime64[ns]")
        indexes = [
            rr.TimeColumn(TIME_LINE, duration=np.round(times_s * 1e9).astype("timedelta64[ns]")),
            rr.TimeColumn(WALL_LINE, timestamp=since_1970_ns),
        ]
        self._stream.send_columns(path, indexes=indexes, columns=list(columns))

    def _numbers(self, path: str, told: _Told) -> None:
        rows = [numbers_of(message) for message in told.messages]
        if rows[0]:
            self._stream.log(path, rr.SeriesLines(names=list(rows[0])), static=True)
            values = np.array([list(row.values()) for row in rows])
            columns = rr.Scalars.columns(scalars=values.ravel()).partition([values.shape[1]] * len(rows))
            self._send(path, told.times_s, columns)

    def _track(self, vehicle: str, color: int) -> None:
        """Where it flew: on the globe, and in meters about where the first vehicle was first."""
        told = self._told.get((vehicle, "GLOBAL_POSITION_INT"))
        known = None if told is None else np.array([bool(m.lat or m.lon) for m in told.messages])
        if told is None or known is None or not known.any():
            return
        fixes = [message for message, sure in zip(told.messages, known, strict=True) if sure]
        globe = np.array([(message.lat * 1e-7, message.lon * 1e-7) for message in fixes])
        home = self._home()
        places = np.array(
            [
                enu_from_geo(home, GeoPoint(m.lat * 1e-7, m.lon * 1e-7, home.altitude_m + m.relative_alt * 1e-3))
                for m in fixes
            ]
        )
        times_s = told.times_s[known]
        self._stream.log(
            f"/geo/{vehicle}/track", rr.GeoLineStrings(lat_lon=[globe], colors=[color], radii=[-1.5]), static=True
        )
        self._stream.log(
            f"/world/{vehicle}/track", rr.LineStrips3D([places], colors=[color], radii=[-1.2]), static=True
        )
        self._stream.log(f"/geo/{vehicle}", rr.GeoPoints.from_fields(colors=[color], radii=[-5.0]), static=True)
        named = rr.Points3D.from_fields(colors=[color], radii=[-5.0], labels=[vehicle], show_labels=True)
        self._stream.log(f"/world/{vehicle}", named, static=True)
        self._send(f"/geo/{vehicle}", times_s, rr.GeoPoints.columns(positions=globe))
        self._send(f"/world/{vehicle}", times_s, rr.Points3D.columns(positions=places))

    def _home(self) -> GeoPoint:
        for vehicle in self.vehicles:
            told = self._told.get((vehicle, "GLOBAL_POSITION_INT"))
            for message in () if told is None else told.messages:
                if message.lat or message.lon:
                    return GeoPoint(message.lat * 1e-7, message.lon * 1e-7, message.alt * 1e-3)
        return GeoPoint(0.0, 0.0, 0.0)

    def _modes(self, vehicle: str) -> None:
        """A lane of flight modes, recorded when they change."""
        told = self._told[vehicle, "HEARTBEAT"]
        states = [_mode(message) for message in told.messages]
        changed = [row for row, state in enumerate(states) if row == 0 or states[row - 1] != state]
        columns = rr.StateChange.columns(state=[states[row] for row in changed])
        self._send(f"/vehicles/{vehicle}/mode", told.times_s[changed], columns)

    def _words(self, vehicle: str) -> None:
        told = self._told.get((vehicle, "STATUSTEXT"))
        if told is not None:
            texts = [f"{vehicle}  {_text(message)}" for message in told.messages]
            levels = [_LEVELS[min(message.severity, len(_LEVELS) - 1)] for message in told.messages]
            self._send(f"/log/{vehicle}", told.times_s, rr.TextLog.columns(text=texts, level=levels))

    def _charts(self, vehicle: str, color: int) -> None:
        for place, chart in enumerate(_CHARTS):
            told = self._told.get((vehicle, chart.kind))
            if told is not None:
                path = f"/charts/{place}/{vehicle}"
                self._stream.log(path, rr.SeriesLines(names=[vehicle], colors=[color], widths=[1.4]), static=True)
                values = np.array([chart.value_of(message) for message in told.messages], dtype=np.float64)
                self._send(path, told.times_s, rr.Scalars.columns(scalars=values))


def record_log(entries: Sequence[Entry], path: Path, *, name: str) -> list[str]:
    """Write the messages of one or several logs as a recording; returns the vehicles in it.

    Raises:
        OutputError: it cannot be written.
    """
    part = path.with_name(path.name + ".part")
    stream = rr.RecordingStream(APPLICATION_ID, send_properties=False)
    try:
        stream.set_sinks(
            rr.FileSink(part), default_blueprint=_blueprint({entry.message.get_type() for entry in entries})
        )
        stream.send_recording_name(name)
        stream.log("/world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        logbook = Logbook(entries, stream)
        logbook.write()
        stream.flush()
        stream.disconnect()
        optimize(part, path)
    except (OSError, RuntimeError) as error:
        raise OutputError(f"cannot record to {path}: {error}") from error
    finally:
        part.unlink(missing_ok=True)
    return logbook.vehicles


def _vehicle(message: Message) -> str:
    """V7 is the autopilot of system 7, S255 a ground station or a part beside the autopilot."""
    system, component = message.get_srcSystem(), message.get_srcComponent()
    if component == 1 and system not in _GROUND_STATIONS:
        return f"V{system}"
    return f"S{system}-{component}"


def _mode(heartbeat: Message) -> str:
    armed = "armed" if heartbeat.base_mode & _ARMED else "disarmed"
    flavor = FLAVORS.get(heartbeat.autopilot)
    # ArduPilot's planes and rovers number their modes otherwise.
    known = flavor is not None and (flavor is not ARDUPILOT or heartbeat.type in _COPTERS)
    name = flavor.mode_name(heartbeat.custom_mode) if flavor and known else f"mode {heartbeat.custom_mode}"
    return f"{name}, {armed}"


def _text(message: Message) -> str:
    return str(message.text).rstrip("\0")


def _blueprint(kinds: Collection[str]) -> rrb.Blueprint:
    """Charts of the kinds of messages that there are."""
    charts = [
        rrb.TimeSeriesView(origin=f"/charts/{place}", name=chart.title)
        for place, chart in enumerate(_CHARTS)
        if chart.kind in kinds
    ]
    space = rrb.Spatial3DView(origin="/world", name="Where it flew")
    lanes = rrb.StateTimelineView(origin="/vehicles", contents="/vehicles/**", name="Flight modes")
    flight = rrb.Horizontal(
        rrb.Vertical(space, rrb.Grid(*charts, grid_columns=2), row_shares=[3, 2]),
        rrb.Vertical(lanes, event_log("/log", name="What the vehicles said"), row_shares=[1, 1]),
        column_shares=[19, 10],
        name="Flight",
    )
    numbers = rrb.TimeSeriesView(origin="/mavlink", contents=["/mavlink/**"], name="Every number")
    return rrb.Blueprint(
        rrb.Tabs(flight, rrb.MapView(origin="/geo", name="Map"), numbers, active_tab=0),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(state="collapsed", timeline=TIME_LINE),
        auto_layout=False,
        auto_views=False,
    )
