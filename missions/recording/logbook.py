"""A telemetry log as a recording: where vehicles flew, their modes and words, and every number they sent."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from math import hypot, nan

import numpy as np
import numpy.typing as npt
import rerun as rr
import rerun.blueprint as rrb

from comms.frames import GeoPoint, enu_from_geo
from comms.mavlink import Message, ardupilot_mode, numbers_of
from missions.flightlog import Entry
from missions.recording import palette
from missions.recording.event_view import event_log
from missions.recording.tape import TIME_LINE
from missions.recording.texts import Said, Texts
from swarm_agent.autopilot.flavors import ARDUPILOT, FLAVORS

WALL_LINE = "wall_clock"
_GROUND_STATION = 255  # what it says is kept, and is no vehicle's; vehicles of large swarms go up to 250
_LEVELS = ("CRITICAL", "CRITICAL", "CRITICAL", "ERROR", "WARN", "INFO", "INFO", "DEBUG")  # by MAV_SEVERITY
_NO_AUTOPILOT = 8  # MAV_AUTOPILOT_INVALID
_VEHICLE = "V"
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
    """Messages of one kind of one sender in a stretch of the log, and when: seconds since the log began."""

    times_s: Floats
    messages: Sequence[Message]


class Logbook:
    """Writes messages to one stream, stretch by stretch: between two of them it keeps the tracks alone.

    Attributes:
        vehicles: who has sent a heartbeat. kinds: of messages, so far.
    """

    def __init__(self, stream: rr.RecordingStream, *, began_s: float) -> None:
        self._stream, self._began_s = stream, began_s
        self._home: GeoPoint | None = None
        self._styled: set[str] = set()
        # Of each vehicle, stretch by stretch: (P, 2) degrees, (P, 3) meters.
        self._tracks: dict[str, list[tuple[Floats, Floats]]] = defaultdict(list)
        self._modes: dict[str, str] = {}
        self._texts: dict[str, Texts] = defaultdict(Texts)
        self.vehicles: set[str] = set()
        self.kinds: set[str] = set()

    def write(self, entries: Iterable[Entry]) -> None:
        """Write a stretch."""
        gathered: dict[tuple[str, str], list[Entry]] = defaultdict(list)
        for entry in entries:
            gathered[sender_of(entry.message), entry.message.get_type()].append(entry)
        for (sender, kind), some in gathered.items():
            times_s = np.array([entry.unix_s for entry in some]) - self._began_s
            told = _Told(times_s, [entry.message for entry in some])
            self.kinds.add(kind)
            self._numbers(f"/mavlink/{sender}/{kind}", told)
            if is_vehicle(sender):
                self._vehicle(sender, kind, told)

    def finish(self) -> None:
        """Write what is known at the end alone: whole tracks, texts that never ended, and how all of it is shown."""
        for vehicle, texts in self._texts.items():
            self._say(vehicle, texts.end())
        for vehicle, pieces in self._tracks.items():
            color = _color(vehicle)
            globe, places = (np.concatenate(each) for each in zip(*pieces, strict=True))
            line = rr.GeoLineStrings(lat_lon=[globe], colors=[color], radii=[-1.5])
            self._stream.log(f"/geo/{vehicle}/track", line, static=True)
            flown = rr.LineStrips3D([places], colors=[color], radii=[-1.2])
            self._stream.log(f"/world/{vehicle}/track", flown, static=True)
        self._stream.send_blueprint(_blueprint(self.kinds))

    def _vehicle(self, vehicle: str, kind: str, told: _Told) -> None:
        if kind == "HEARTBEAT":
            self._lane(vehicle, told)
        elif kind == "STATUSTEXT":
            self._words(vehicle, told)
        elif kind == "GLOBAL_POSITION_INT":
            self._track(vehicle, told)
        self._charts(vehicle, kind, told)

    def _send(self, path: str, times_s: Floats, columns: rr.ComponentColumnList) -> None:
        since_1970_ns = np.round((self._began_s + times_s) * 1e9).astype("datetime64[ns]")
        indexes = [
            rr.TimeColumn(TIME_LINE, duration=np.round(times_s * 1e9).astype("timedelta64[ns]")),
            rr.TimeColumn(WALL_LINE, timestamp=since_1970_ns),
        ]
        self._stream.send_columns(path, indexes=indexes, columns=list(columns))

    def _style(self, path: str, look: rr.AsComponents) -> None:
        """Say once how an entity looks."""
        if path not in self._styled:
            self._styled.add(path)
            self._stream.log(path, look, static=True)

    def _numbers(self, path: str, told: _Told) -> None:
        rows = [numbers_of(message) for message in told.messages]
        if rows[0]:
            self._style(path, rr.SeriesLines(names=list(rows[0])))
            values = np.array([list(row.values()) for row in rows])
            columns = rr.Scalars.columns(scalars=values.ravel()).partition([values.shape[1]] * len(rows))
            self._send(path, told.times_s, columns)

    def _track(self, vehicle: str, told: _Told) -> None:
        """Where it flew: on the globe, and in meters about the first place that any vehicle told."""
        known = np.array([bool(m.lat or m.lon) for m in told.messages])
        if not known.any():
            return
        fixes = [message for message, sure in zip(told.messages, known, strict=True) if sure]
        globe = np.array([(m.lat * 1e-7, m.lon * 1e-7) for m in fixes])
        if self._home is None:
            self._home = GeoPoint(globe[0, 0], globe[0, 1], fixes[0].alt * 1e-3)
        home = self._home
        points = [GeoPoint(m.lat * 1e-7, m.lon * 1e-7, home.altitude_m + m.relative_alt * 1e-3) for m in fixes]
        places = np.array([enu_from_geo(home, point) for point in points])
        self._tracks[vehicle].append((globe, places))
        color, times_s = _color(vehicle), told.times_s[known]
        self._style(f"/geo/{vehicle}", rr.GeoPoints.from_fields(colors=[color], radii=[-5.0]))
        named = rr.Points3D.from_fields(colors=[color], radii=[-5.0], labels=[vehicle], show_labels=True)
        self._style(f"/world/{vehicle}", named)
        self._send(f"/geo/{vehicle}", times_s, rr.GeoPoints.columns(positions=globe))
        self._send(f"/world/{vehicle}", times_s, rr.Points3D.columns(positions=places))

    def _lane(self, vehicle: str, told: _Told) -> None:
        """A lane of flight modes, recorded when they change. A ground station's heartbeat has none."""
        changed, states = [], []
        for row, message in enumerate(told.messages):
            if message.autopilot == _NO_AUTOPILOT:
                continue
            self.vehicles.add(vehicle)
            state = _mode(message)
            if self._modes.get(vehicle) != state:
                self._modes[vehicle] = state
                changed.append(row)
                states.append(state)
        if changed:
            self._send(f"/vehicles/{vehicle}/mode", told.times_s[changed], rr.StateChange.columns(state=states))

    def _words(self, vehicle: str, told: _Told) -> None:
        texts, heard = self._texts[vehicle], zip(told.times_s.tolist(), told.messages, strict=True)
        self._say(vehicle, [said for time_s, message in heard for said in texts.hear(time_s, message)])

    def _say(self, vehicle: str, told: Sequence[Said]) -> None:
        if told:
            texts = [f"{vehicle}  {said.text}" for said in told]
            levels = [_LEVELS[min(said.severity, len(_LEVELS) - 1)] for said in told]
            times_s = np.array([said.time_s for said in told])
            self._send(f"/log/{vehicle}", times_s, rr.TextLog.columns(text=texts, level=levels))

    def _charts(self, vehicle: str, kind: str, told: _Told) -> None:
        for place, chart in enumerate(_CHARTS):
            if chart.kind == kind:
                path = f"/charts/{place}/{vehicle}"
                self._style(path, rr.SeriesLines(names=[vehicle], colors=[_color(vehicle)], widths=[1.4]))
                values = np.array([chart.value_of(message) for message in told.messages], dtype=np.float64)
                self._send(path, told.times_s, rr.Scalars.columns(scalars=values))


def is_vehicle(sender: str) -> bool:
    """Whether it is a vehicle, not a ground station or a part."""
    return sender.startswith(_VEHICLE)


def sender_of(message: Message) -> str:
    """V7 is the autopilot of system 7, S255-190 a ground station or a part beside the autopilot."""
    system, component = message.get_srcSystem(), message.get_srcComponent()
    return f"{_VEHICLE}{system}" if component == 1 and system != _GROUND_STATION else f"S{system}-{component}"


def _color(vehicle: str) -> int:
    return palette.series_colors(max(1, int(vehicle.removeprefix(_VEHICLE))))[-1]


def _mode(heartbeat: Message) -> str:
    """The mode in the autopilot's own words, and whether its motors may turn."""
    armed = "armed" if heartbeat.base_mode & _ARMED else "disarmed"
    flavor, number = FLAVORS.get(heartbeat.autopilot), heartbeat.custom_mode
    if flavor is ARDUPILOT:
        name = ardupilot_mode(heartbeat.type, number)
    else:
        name = flavor.mode_names.get(number) if flavor else None
    return f"{name or f'mode {number}'}, {armed}"


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
