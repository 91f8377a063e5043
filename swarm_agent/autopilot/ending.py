"""The last stages: the way down, landed, and given up."""

from __future__ import annotations

from comms.status import Level
from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.errand import Errand, Progress
from swarm_agent.autopilot.flavors import Mode
from swarm_agent.autopilot.intent import Intent, Land
from swarm_agent.autopilot.requests import disarm, set_mode
from swarm_agent.autopilot.stage import OnTheWay, Stage
from swarm_agent.autopilot.state import Phase

HOMING_LIMIT_S = 10.0  # a return that is refused for so long becomes a landing
TOUCHDOWN_S = 15.0  # a vehicle that stands with its motors on for so long is disarmed; ArduPilot does it in 2 to 10
FALL_S = 5.0  # disarmed, but not reported landed, for so long: it did not come down as intended


class Done(OnTheWay):
    """Landed, disarmed, nothing left to do."""

    phase = Phase.DONE

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Stay."""
        return self


class Failed(OnTheWay):
    """Given up. With `bring_down`, a vehicle that is still in the air is asked to land, again and again."""

    phase = Phase.FAILED

    def __init__(self, reason: str, *, bring_down: bool = False) -> None:
        self.failure = reason
        self._bring_down = bring_down
        self._landing: Errand | None = None

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """Stay, whatever the agent wants; bring down what is up."""
        telemetry, flavor = cockpit.telemetry, cockpit.flavor
        airborne = telemetry.armed and not telemetry.landed
        if self._bring_down and airborne and telemetry.custom_mode not in flavor.ends_flight:
            if self._landing is None:
                self._landing = Errand(set_mode(flavor.landing), limit_s=cockpit.config.refusal_limit_s)
            if self._landing.tick(cockpit, now_s) is not Progress.OPEN:
                self._landing = None
        return self


class Descent(OnTheWay):
    """Down: home and land (or land on the spot), disarm. Also follows a vehicle that comes down on its own account."""

    def __init__(self, *, on_the_spot: bool = False) -> None:
        self._on_the_spot = on_the_spot
        self._turning: Errand | None = None
        self._disarming: Errand | None = None
        self._under_way_since_s: float | None = None
        self._interfered = False
        self._landed_since_s: float | None = None
        self._disarmed_since_s: float | None = None

    @property
    def phase(self) -> Phase:
        """LAND where it lands on the spot, else RETURN."""
        return Phase.LAND if self._on_the_spot else Phase.RETURN

    def tick(self, cockpit: Cockpit, now_s: float, intent: Intent) -> Stage:
        """One step of the way down."""
        telemetry = cockpit.telemetry
        if not telemetry.armed:
            return self._disarmed(cockpit, now_s)
        self._disarmed_since_s = None
        if isinstance(intent, Land) and not self._on_the_spot:
            return Descent(on_the_spot=True)
        if telemetry.landed:
            return self._on_ground(cockpit, now_s)
        self._landed_since_s = None
        return self._in_air(cockpit, now_s)

    def _disarmed(self, cockpit: Cockpit, now_s: float) -> Stage:
        if cockpit.telemetry.landed:
            cockpit.say(Level.INFO, "landed and disarmed")
            return Done()
        if self._disarmed_since_s is None:
            self._disarmed_since_s = now_s
        return Failed("disarmed in the air") if now_s - self._disarmed_since_s > FALL_S else self

    def _on_ground(self, cockpit: Cockpit, now_s: float) -> Stage:
        """Standing with the motors on: never flown, so disarm at once; else leave that to the autopilot for a while."""
        if self._landed_since_s is None:
            self._landed_since_s = now_s
            self._disarming = None
        patience_s = TOUCHDOWN_S if self._under_way_since_s is not None else 0.0
        if now_s - self._landed_since_s < patience_s:
            return self
        if self._disarming is None:
            limit_s = cockpit.config.refusal_limit_s
            self._disarming = Errand(disarm(), limit_s=limit_s, done=lambda telemetry: not telemetry.armed)
        if self._disarming.tick(cockpit, now_s) is Progress.GIVEN_UP:
            return Failed(self._disarming.reason)
        return self

    def _in_air(self, cockpit: Cockpit, now_s: float) -> Stage:
        if self._coming_down(cockpit):
            if self._under_way_since_s is None:
                self._under_way_since_s = now_s
            self._interfered = False
            if not self._on_the_spot and now_s - self._under_way_since_s > cockpit.config.return_limit_s:
                cockpit.say(Level.ERROR, f"not home after {cockpit.config.return_limit_s:g} s: landing on the spot")
                return Descent(on_the_spot=True)
            return self
        if self._under_way_since_s is not None:
            self._say_interfered(cockpit)
            return self
        if self._turning is None:
            limit_s = cockpit.config.refusal_limit_s if self._on_the_spot else HOMING_LIMIT_S
            self._turning = Errand(
                set_mode(self._mode(cockpit)), limit_s=limit_s, done=lambda _: self._coming_down(cockpit)
            )
        if self._turning.tick(cockpit, now_s) is not Progress.GIVEN_UP:
            return self
        if self._on_the_spot:
            return Failed(self._turning.reason, bring_down=True)
        cockpit.say(Level.ERROR, "cannot return: landing on the spot")
        return Descent(on_the_spot=True)

    def _mode(self, cockpit: Cockpit) -> Mode:
        return cockpit.flavor.landing if self._on_the_spot else cockpit.flavor.homing

    def _coming_down(self, cockpit: Cockpit) -> bool:
        if self._on_the_spot:
            return cockpit.in_mode(cockpit.flavor.landing)
        return cockpit.telemetry.custom_mode in cockpit.flavor.ends_flight

    def _say_interfered(self, cockpit: Cockpit) -> None:
        """Somebody else took the vehicle out of its descent: their flight now, we watch it to its end."""
        if not self._interfered:
            self._interfered = True
            mode = cockpit.flavor.mode_name(cockpit.telemetry.custom_mode)
            cockpit.say(Level.WARNING, f"taken out of its descent into {mode}: leaving it to whoever did that")
