"""A simulated vehicle on a MAVLink link: bytes in, time, bytes out."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from comms.frames import GeoPoint
from comms.mavlink import Endpoint
from comms.signing import Signing
from vehicle_sim.autopilot.channel import Channel
from vehicle_sim.autopilot.core import Autopilot
from vehicle_sim.autopilot.flavors import FLAVORS
from vehicle_sim.autopilot.plans.desk import ROUTES, Desk
from vehicle_sim.autopilot.request import Request
from vehicle_sim.autopilot.streams import ALL_GROUPS, Streams
from vehicle_sim.autopilot.texts import Texts
from vehicle_sim.vehicle import VehicleConfig, VehicleTruth

HEARTBEAT_ID, MISSION_CURRENT_ID, HOME_ID, ORIGIN_ID = 0, 42, 242, 49
UNSUPPORTED = 3  # MAV_RESULT


class SimulatedVehicle:
    """A multirotor with its autopilot, in process and on the mission's clock.

        vehicle = SimulatedVehicle(config=VehicleConfig(), system_id=1, home=GeoPoint(47.4, 8.5, 488.0))
        wire_out = vehicle.tick(0.1, wire_in)

    Args:
        home: where it stands at power-on; its local north-east-down frame starts here.
        heading_rad: where its nose points, clockwise from north.
        seed: of the gusts. started_at_s: power-on, on the mission clock.
    """

    def __init__(
        self,
        *,
        config: VehicleConfig,
        system_id: int,
        home: GeoPoint,
        heading_rad: float = 0.0,
        seed: int = 0,
        started_at_s: float = 0.0,
    ) -> None:
        self._flavor = FLAVORS[config.flavor]
        self.autopilot: Autopilot = self._flavor.autopilot(
            config=config,
            system_id=system_id,
            home=home,
            heading_rad=heading_rad,
            seed=seed,
            started_at_s=started_at_s,
        )
        self.desk = Desk(self.autopilot.plans, go=self.autopilot.fly_item)
        self.channels: list[Channel] = []
        self._texts = Texts()
        self._here = self.open_channel()  # where the message came from that is being handled; the first otherwise
        self.autopilot.parameters.on_change(("SR0_",), self._follow_stream_parameters)
        self._handlers: dict[int, Callable[[Any], None]] = {
            dialect.MAVLINK_MSG_ID_SET_MODE: self._on_set_mode,
            dialect.MAVLINK_MSG_ID_REQUEST_DATA_STREAM: self._on_data_stream,
            dialect.MAVLINK_MSG_ID_COMMAND_INT: self._on_command_int,
            dialect.MAVLINK_MSG_ID_COMMAND_LONG: self._on_command_long,
            dialect.MAVLINK_MSG_ID_MISSION_SET_CURRENT: self._on_mission_set_current,
        }
        self._handlers |= dict.fromkeys(ROUTES, self._on_plan)
        flavor = self._flavor
        self._handlers |= {number: partial(take_in, self.autopilot) for number, take_in in flavor.hearing.items()}
        self._handlers |= {number: partial(self._on_question, answer) for number, answer in flavor.answers.items()}

    def tick(self, now_s: float, wire_in: bytes = b"") -> bytes:
        """Take `wire_in` at the time of the last tick, live until `now_s`, and return what it said meanwhile.

        Both on the first channel; the others' bytes wait in them.
        """
        first = self.channels[0]
        first.hear(wire_in)
        for channel in self.channels:
            self._here = channel
            for message in channel.messages():
                self._receive(message)
        self._here = first
        self.autopilot.advance(now_s)
        self.desk.watch(self.autopilot.now_s)
        self._speak()
        builders = self._flavor.builders
        for channel in self.channels:
            for message_id in channel.streams.due(self.autopilot.now_s):
                report = builders[message_id](self.autopilot)
                if report is not None:
                    channel.endpoint.send(report)
        return first.take()

    def lose_power(self) -> None:
        """The autopilot goes out for a moment: its motors stop wherever it is, and it boots again."""
        self.autopilot.disarm(forced=True)
        self.autopilot.reboot()
        self._begin_anew()

    def open_channel(self, *, signing: Signing | None = None) -> Channel:
        """One more link to this vehicle, beside those it has; with `signing` it hears only whom it can believe."""
        channel = Channel(system_id=self.autopilot.system_id, streams=self._new_streams(), signing=signing)
        self.channels.append(channel)
        return channel

    @property
    def endpoint(self) -> Endpoint:
        """Where answers go: the endpoint of the link on which it is being asked."""
        return self._here.endpoint

    @property
    def streams(self) -> Streams:
        """The rates of the link on which it is being asked."""
        return self._here.streams

    @property
    def truth(self) -> VehicleTruth:
        """Where it really is."""
        frame = self.autopilot.airframe
        roll, pitch = frame.attitude_rad
        return VehicleTruth(
            position_ned_m=(frame.north_m, frame.east_m, frame.down_m),
            velocity_ned_m_s=(frame.north_m_s, frame.east_m_s, frame.down_m_s),
            roll_rad=roll,
            pitch_rad=pitch,
            yaw_rad=frame.yaw_rad,
            on_ground=frame.on_ground,
            armed=self.autopilot.armed,
        )

    @property
    def mode_name(self) -> str:
        return self.autopilot.mode.name

    def _receive(self, message: Any) -> None:
        """Handle what it knows and what is for it."""
        handler = self._handlers.get(message.get_msgId())
        if handler is None or not self._flavor.addressed(message, self.autopilot.system_id):
            return
        handler(message)
        self._speak()

    def _speak(self) -> None:
        """Say on every link the texts that wait, home if it is new, and a heartbeat when mode or arming changed."""
        pilot = self.autopilot
        news = [piece for severity, text in pilot.texts for piece in self._texts.messages(severity, text)]
        pilot.texts.clear()
        if pilot.home_news:
            pilot.home_news = False
            news += [report for report in (self._report(ORIGIN_ID), self._report(HOME_ID)) if report is not None]
        if pilot.announce:
            pilot.announce = False
            news.append(self._report(HEARTBEAT_ID))
        news += [dialect.MAVLink_mission_item_reached_message(index) for index in pilot.mission.reached]
        pilot.mission.reached.clear()
        for message in news:
            for channel in self.channels:
                channel.endpoint.send(message)

    def _command(self, message: Any, params: tuple[float, ...], frame: int | None = None) -> None:
        replies: list[Any] = []
        request = Request(pilot=self.autopilot, streams=self.streams, params=params, frame=frame, replies=replies)
        handler = self._flavor.commands.get(message.command)
        result = UNSUPPORTED if handler is None else handler(request)
        self._acknowledge(message, message.command, int(result))
        for reply in replies:
            self.endpoint.send(reply)
        self._begin_anew()

    def _begin_anew(self) -> None:
        """After a reboot every link forgets what it was asked for, and uploads are over."""
        if self.autopilot.restarted:
            self.autopilot.restarted = False
            self.desk.forget()
            for channel in self.channels:
                channel.streams = self._new_streams()
            self._follow_stream_parameters()

    def _acknowledge(self, message: Any, command: int, result: int) -> None:
        self.endpoint.send(
            dialect.MAVLink_command_ack_message(
                command, result, 0, 0, message.get_srcSystem(), message.get_srcComponent()
            )
        )

    def _on_command_long(self, message: Any) -> None:
        p = message
        self._command(p, (p.param1, p.param2, p.param3, p.param4, p.param5, p.param6, p.param7))

    def _on_command_int(self, message: Any) -> None:
        p = message
        self._command(p, (p.param1, p.param2, p.param3, p.param4, float(p.x), float(p.y), p.z), p.frame)

    def _on_set_mode(self, message: Any) -> None:
        result = self._flavor.set_mode(self.autopilot, message.base_mode, message.custom_mode)
        self._acknowledge(message, self._flavor.set_mode_ack, int(result))

    def _on_plan(self, message: Any) -> None:
        self.desk.handle(message, self.endpoint.send, self.autopilot.now_s)

    def _on_mission_set_current(self, message: Any) -> None:
        if self.autopilot.mission.select(message.seq):
            self.endpoint.send(self._report(MISSION_CURRENT_ID))

    def _on_data_stream(self, message: Any) -> None:
        rate_hz = message.req_message_rate if message.start_stop else 0
        groups = self._flavor.groups
        everything = tuple(groups) if message.req_stream_id == ALL_GROUPS else (message.req_stream_id,)
        for number in everything:
            if number in groups:
                self.streams.set_group(groups[number], rate_hz, self._flavor.builders, self.autopilot.now_s)

    def _follow_stream_parameters(self) -> None:
        """The rates of the first channel are parameters, too."""
        flavor, pilot = self._flavor, self.autopilot
        self.channels[0].streams.follow(flavor.groups.values(), pilot.parameters, flavor.builders, pilot.now_s)

    def _new_streams(self) -> Streams:
        return Streams(started_at_s=self.autopilot.now_s, unasked_s=self._flavor.unasked_s)

    def _report(self, message_id: int) -> Any:
        return self._flavor.builders[message_id](self.autopilot)

    def _on_question(self, answer: Callable[[Autopilot, Any], Iterable[Any]], message: Any) -> None:
        """Answer while there is room: a thousand requests for all parameters cost no more than a few."""
        for reply in answer(self.autopilot, message):
            self.endpoint.send(reply)
            if self.endpoint.full:
                break
