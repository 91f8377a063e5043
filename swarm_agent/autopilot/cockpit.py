"""The cockpit: all that a phase of flight sees, and all it can do."""

from __future__ import annotations

from comms.mavlink import Endpoint, Message
from comms.status import Event, Level
from swarm_agent.autopilot.config import PilotConfig
from swarm_agent.autopilot.flavors import ARDUPILOT, Mode
from swarm_agent.autopilot.telemetry import Telemetry
from swarm_agent.autopilot.texts import TextAssembler

MAX_EVENTS = 200  # of one tick; a vehicle that says more is not heard out
REASON_S = 3.0  # a text and the heartbeat that shows its effect are this close


class Cockpit:
    """One vehicle's instruments and its microphone.

    Attributes:
        replies: this tick's messages that may answer a request. warnings: this tick's serious texts of the vehicle.
        flavor: assumed until the first heartbeat tells.
        system_id: the vehicle's; None until it is known.
        rates_asked: the vehicle has been asked for all the messages we need.
        last_warning: the newest of the vehicle's serious texts, to explain why it is not ready.
    """

    def __init__(self, config: PilotConfig, endpoint: Endpoint) -> None:
        self.config = config
        self.system_id = config.system_id
        self.endpoint = endpoint
        self.telemetry = Telemetry(config.home)
        self.flavor = ARDUPILOT
        self.replies: list[Message] = []
        self.warnings: list[str] = []
        self.last_warning = ""
        self.rates_asked = False
        self._warned_at_s = float("-inf")
        self._texts = TextAssembler()
        self._events: list[Event] = []

    def begin_tick(self) -> None:
        """What was heard in the last tick is over."""
        self.replies.clear()
        self.warnings.clear()

    def send(self, message: Message) -> None:
        """Queue a message for the vehicle."""
        self.endpoint.send(message)

    @property
    def target(self) -> int:
        """The system id for messages to the vehicle; nothing is sent to one before it is known."""
        assert self.system_id is not None, "a message to a vehicle that has not been heard"
        return self.system_id

    def say(self, level: Level, text: str) -> None:
        """Add a line to the event log."""
        if len(self._events) < MAX_EVENTS:
            self._events.append(Event(level, text))

    def take_events(self) -> tuple[Event, ...]:
        """The events since the last call."""
        events = tuple(self._events)
        self._events.clear()
        return events

    def hear_text(self, message: Message, now_s: float) -> None:
        """Log what the autopilot says; its warnings may explain a refusal."""
        event = self._texts.hear(message)
        if event is None:
            return
        self.say(event.level, event.text)
        if event.level is not Level.INFO:
            self.warnings.append(event.text)
            self.last_warning = event.text
            self._warned_at_s = now_s

    def reason(self, now_s: float) -> str:
        """What the vehicle has just complained about, in brackets, to explain what it does; or nothing."""
        return f" ({self.last_warning})" if now_s - self._warned_at_s < REASON_S else ""

    def in_mode(self, mode: Mode) -> bool:
        """The vehicle says it flies in this mode."""
        return self.telemetry.custom_mode == mode.custom_mode

    @property
    def mode_name(self) -> str:
        """The vehicle's flight mode in its own words; empty before the first heartbeat."""
        telemetry = self.telemetry
        return "" if telemetry.autopilot is None else self.flavor.mode_name(telemetry.custom_mode)
