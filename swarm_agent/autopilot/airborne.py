"""The stages in the air: on the layer, where the agent flies, and taken over by somebody else."""

from __future__ import annotations

from comms.frames import Vec3
from comms.status import Level
from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.ending import Descent, Failed
from swarm_agent.autopilot.intent import Fly, Intent, Land, Return
from swarm_agent.autopilot.setpoint import hold_layer, limit_speed, velocity_setpoint
from swarm_agent.autopilot.stage import OnTheWay, Stage
from swarm_agent.autopilot.state import Phase

POSITION_FRESH_S = 1.5  # holding a layer by an older altitude would climb or sink without end
STILL: Vec3 = (0.0, 0.0, 0.0)


def interruption(cockpit: Cockpit, intent: Intent) -> Stage | None:
    """What ends a guided flight: the agent's wish, motors off, or a flight mode that is not ours."""
    telemetry, flavor = cockpit.telemetry, cockpit.flavor
    if isinstance(intent, Return | Land):
        return Descent(on_the_spot=isinstance(intent, Land))
    if not telemetry.armed:
        # A failsafe may have landed it while the link was down.
        return Descent() if telemetry.custom_mode in flavor.ends_flight else Failed("disarmed in the air")
    if telemetry.custom_mode == flavor.guided.custom_mode:
        return None
    mode = flavor.mode_name(telemetry.custom_mode)
    if telemetry.custom_mode in flavor.ends_flight:
        cockpit.say(Level.WARNING, f"in {mode} without being asked: following it down")
        return Descent(on_the_spot=cockpit.in_mode(flavor.landing))
    cockpit.say(Level.WARNING, f"taken over in {mode}: hands off until it is {flavor.guided.name} again")
    return TakenOver()


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
        stage = interruption(cockpit, intent)
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


class TakenOver(OnTheWay):
    """Somebody else flies: no setpoints. Guided again, it goes on; landed, it is over."""

    phase = Phase.TAKEN_OVER

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Watch, and honor a wish to come down: a person's hand on the mode switch still beats it."""
        telemetry, flavor = cockpit.telemetry, cockpit.flavor
        if not telemetry.armed:
            return Descent()
        if cockpit.in_mode(flavor.guided):
            cockpit.say(Level.INFO, f"{flavor.guided.name} again: going on")
            return OnLayer()
        wants_down = isinstance(intent, Return | Land)
        if wants_down or telemetry.custom_mode in flavor.ends_flight:
            return Descent(on_the_spot=isinstance(intent, Land) or cockpit.in_mode(flavor.landing))
        return self
