"""The stages in the air: on the layer, where the agent flies, and taken over by somebody else."""

from __future__ import annotations

from comms.frames import Vec3
from comms.status import Level
from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.ending import Descent, Failed
from swarm_agent.autopilot.errand import Errand, Progress
from swarm_agent.autopilot.intent import Fly, Intent, Land, Return
from swarm_agent.autopilot.requests import set_mode
from swarm_agent.autopilot.setpoint import hold_layer, limit_speed, velocity_setpoint
from swarm_agent.autopilot.stage import OnTheWay, Stage
from swarm_agent.autopilot.state import Phase

POSITION_FRESH_S = 1.5  # holding a layer by an older altitude would climb or sink without end
GAP_S = 2.0  # between heartbeats, which come once a second: the link was lost meanwhile
LEAD_S = 1.0  # of setpoints before the mode that needs them; PX4 wants them at more than 2 Hz for a while
STILL: Vec3 = (0.0, 0.0, 0.0)


def on_layer(cockpit: Cockpit) -> Stage:
    """The stage of a vehicle whose climb is over."""
    return OnLayer() if cockpit.in_mode(cockpit.flavor.guided) else Engage()


def interruption(cockpit: Cockpit, now_s: float, intent: Intent, *, ours: frozenset[int] | None = None) -> Stage | None:
    """What ends a guided flight: the agent's wish, motors off, or a flight mode that is not `ours` (None: guided)."""
    telemetry, flavor = cockpit.telemetry, cockpit.flavor
    if isinstance(intent, Return | Land):
        return Descent(on_the_spot=isinstance(intent, Land))
    if not telemetry.armed:
        return _disarmed(cockpit, now_s)
    if telemetry.custom_mode in (ours or {flavor.guided.custom_mode}):
        return None
    mode, why = flavor.mode_name(telemetry.custom_mode), cockpit.reason(now_s)
    if telemetry.custom_mode in flavor.ends_flight:
        cockpit.say(Level.ERROR, f"in {mode} without being asked{why}: following it down")
    else:
        cockpit.say(Level.WARNING, f"taken over in {mode}{why}: hands off until it is {flavor.guided.name} again")
    return TakenOver(cockpit)


class OnLayer:
    """Up: the layer is held, and once it has been reached the agent's velocity is flown. One setpoint each tick."""

    failure = ""

    def __init__(self) -> None:
        self.phase = Phase.ON_STATION
        self.ready = False
        self._blind = False
        self._nonsense = False
        self._setpoint_at_s: float | None = None

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Send the setpoint, unless the flight has ended."""
        stage = interruption(cockpit, now_s, intent)
        if stage is not None:
            return stage
        flying = self.ready and isinstance(intent, Fly)
        self.phase = Phase.FLYING if flying else Phase.ON_STATION
        velocity_m_s = self._velocity(cockpit, now_s, intent)
        cockpit.send(velocity_setpoint(velocity_m_s, system_id=cockpit.target, now_s=now_s))
        self._watch_gap(cockpit, now_s)
        return self

    def _velocity(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Vec3:
        telemetry, config = cockpit.telemetry, cockpit.config
        position_m, at_s = telemetry.position_m, telemetry.position_at_s
        if position_m is None or at_s is None or now_s - at_s > POSITION_FRESH_S:
            self._say_blind(cockpit, blind=True)
            return STILL
        self._say_blind(cockpit, blind=False)
        up_m = position_m[2]
        climb_m_s = hold_layer(up_m, layer_m=config.altitude_m, max_climb_m_s=config.max_climb_m_s)
        self.ready = self.ready or abs(up_m - config.altitude_m) <= config.layer_tolerance_m
        if not (self.ready and isinstance(intent, Fly)):
            return (0.0, 0.0, climb_m_s)
        wish = limit_speed(intent.velocity_enu_m_s, max_speed_m_s=config.max_speed_m_s)
        if wish is None:
            self._say_nonsense(cockpit, intent)
            return (0.0, 0.0, climb_m_s)
        self._nonsense = False
        return (wish[0], wish[1], climb_m_s)

    def _say_blind(self, cockpit: Cockpit, *, blind: bool) -> None:
        if blind != self._blind:
            self._blind = blind
            text = f"no position for {POSITION_FRESH_S:g} s: holding still" if blind else "the position is back"
            cockpit.say(Level.WARNING if blind else Level.INFO, text)

    def _say_nonsense(self, cockpit: Cockpit, intent: Fly) -> None:
        if not self._nonsense:
            self._nonsense = True
            cockpit.say(Level.ERROR, f"asked to fly {intent.velocity_enu_m_s}: holding still")

    def _watch_gap(self, cockpit: Cockpit, now_s: float) -> None:
        """A setpoint that comes later than the vehicle remembers the last one has let it stop."""
        memory_s, last_s = cockpit.flavor.setpoint_memory_s, self._setpoint_at_s
        if last_s is not None and now_s - last_s > memory_s:
            cockpit.say(
                Level.WARNING, f"no setpoint for {now_s - last_s:.1f} s: the vehicle stops after {memory_s:g} s"
            )
        self._setpoint_at_s = now_s


class Engage(OnTheWay):
    """On the layer, but not yet guided: setpoints first, then the mode that needs them."""

    phase = Phase.TAKEOFF

    def __init__(self) -> None:
        self._since_s: float | None = None
        self._errand: Errand | None = None

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Hold by setpoints, and ask for the mode once they have been coming for a while."""
        stage = interruption(cockpit, now_s, intent, ours=cockpit.flavor.climbs_in)
        if stage is not None:
            return stage
        guided = cockpit.flavor.guided
        if cockpit.in_mode(guided):
            return OnLayer()
        cockpit.send(velocity_setpoint(STILL, system_id=cockpit.target, now_s=now_s))
        if self._since_s is None:
            self._since_s = now_s
        if now_s - self._since_s < LEAD_S:
            return self
        if self._errand is None:
            limit_s = cockpit.config.refusal_limit_s
            self._errand = Errand(set_mode(guided), limit_s=limit_s, done=lambda _: cockpit.in_mode(guided))
        if self._errand.tick(cockpit, now_s) is Progress.GIVEN_UP:
            return Failed(self._errand.reason, bring_down=True)
        return self


class TakenOver(OnTheWay):
    """Somebody else flies, a person or a failsafe: hands off. Guided again, it goes on; landed, it is over.

    A person always wins, at the end of the mission too. Only where the link was lost and the vehicle merely waits in
    the air is it asked back.
    """

    def __init__(self, cockpit: Cockpit) -> None:
        self.phase = _phase(cockpit)
        self._lapsed = cockpit.telemetry.heartbeat_gap_s > GAP_S  # it came about while nobody was heard
        self._errand: Errand | None = None
        self._said_over = False

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Watch."""
        telemetry, flavor = cockpit.telemetry, cockpit.flavor
        came_down = self.phase is not Phase.TAKEN_OVER  # until now: a PX4 leaves that mode as it disarms
        self.phase = _phase(cockpit)
        if not telemetry.armed:
            return Descent() if came_down else _disarmed(cockpit, now_s)
        if cockpit.in_mode(flavor.guided):
            cockpit.say(Level.INFO, f"{flavor.guided.name} again: going on")
            return OnLayer()
        if isinstance(intent, Return | Land) and self.phase is Phase.TAKEN_OVER and not self._said_over:
            self._said_over = True
            cockpit.say(Level.WARNING, f"should come down: who flies it may land it, or choose {flavor.guided.name}")
        if flavor.guided_needs_setpoints:  # or nobody could give control back
            cockpit.send(velocity_setpoint(STILL, system_id=cockpit.target, now_s=now_s))
        if self._lapsed and telemetry.custom_mode in flavor.lapses_into:
            self._ask_back(cockpit, now_s)
        else:
            self._lapsed = False
        return self

    def _ask_back(self, cockpit: Cockpit, now_s: float) -> None:
        guided = cockpit.flavor.guided
        if self._errand is None:
            cockpit.say(Level.INFO, f"the link was lost and is back: asking for {guided.name}")
            limit_s = cockpit.config.refusal_limit_s
            self._errand = Errand(set_mode(guided), limit_s=limit_s, done=lambda _: cockpit.in_mode(guided))
        if self._errand.tick(cockpit, now_s) is Progress.GIVEN_UP:
            self._lapsed = False


class MotorsOff(OnTheWay):
    """Disarmed in flight: fallen, or restarted, which the pilot sees to. Which one shows when telemetry flows again."""

    phase = Phase.PREFLIGHT

    def __init__(self, since_s: float) -> None:
        self._since_s = since_s

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Wait for news of the vehicle."""
        telemetry, config = cockpit.telemetry, cockpit.config
        if isinstance(intent, Return | Land):
            return Descent()
        if telemetry.attitude_at_s is not None and telemetry.attitude_at_s > self._since_s:
            return Failed("disarmed in the air")
        if now_s - self._since_s > config.preflight_limit_s:
            return Failed(f"disarmed, and silent for {config.preflight_limit_s:g} s")
        return self


def _disarmed(cockpit: Cockpit, now_s: float) -> Stage:
    """A failsafe or a person may have landed it, perhaps while the link was down; otherwise something is wrong."""
    if cockpit.telemetry.custom_mode in cockpit.flavor.ends_flight:
        return Descent()
    cockpit.say(Level.ERROR, "the motors are off in flight")
    return MotorsOff(now_s)


def _phase(cockpit: Cockpit) -> Phase:
    """What somebody else's flight mode means for the agent."""
    if cockpit.telemetry.custom_mode not in cockpit.flavor.ends_flight:
        return Phase.TAKEN_OVER
    return Phase.LAND if cockpit.in_mode(cockpit.flavor.landing) else Phase.RETURN
