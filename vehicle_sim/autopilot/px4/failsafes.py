"""What a PX4 does when something fails: a table of watches, and one action out of all that they ask for.

As its failsafe framework does it: the gravest action wins; one that a person may avert waits for COM_FAIL_ACT_T in
HOLD; what cannot be flown falls back to the next graver; a person who changes the mode takes over.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import NamedTuple

from vehicle_sim.autopilot.px4.battery import BATTERY_LEVELS, Level
from vehicle_sim.autopilot.px4.checks import can_run
from vehicle_sim.autopilot.px4.modes import Mode
from vehicle_sim.autopilot.px4.watched import Watched
from vehicle_sim.autopilot.severity import CRITICAL
from vehicle_sim.autopilot.steering import TIME_SLACK_S


class Action(IntEnum):
    """What to do, the graver the higher."""

    NONE = 0
    WARN = 1
    POSITION = 2
    ALTITUDE = 3
    STABILIZED = 4
    HOLD = 5
    RTL = 6
    LAND = 7
    DISARM = 8
    TERMINATE = 9


ACTION_MODES: dict[Action, Mode] = {
    Action.POSITION: Mode.POSCTL,
    Action.ALTITUDE: Mode.ALTCTL,
    Action.STABILIZED: Mode.STABILIZED,
    Action.HOLD: Mode.HOLD,
    Action.RTL: Mode.RTL,
    Action.LAND: Mode.LAND,
}
NEEDS_STICKS = (Action.POSITION, Action.ALTITUDE, Action.STABILIZED)
STOPS_MOTORS = (Action.DISARM, Action.TERMINATE)

# Parameter values -> action. Other values do nothing, or what is named for them.
LINK_ACTIONS = {1: Action.HOLD, 2: Action.RTL, 3: Action.LAND, 5: Action.TERMINATE, 6: Action.DISARM}
GEOFENCE_ACTIONS = {0: Action.NONE, 2: Action.HOLD, 3: Action.RTL, 4: Action.TERMINATE, 5: Action.LAND}
OFFBOARD_ACTIONS = {
    0: Action.POSITION, 1: Action.ALTITUDE, 2: Action.STABILIZED, 3: Action.RTL, 4: Action.LAND, 5: Action.HOLD,
    6: Action.TERMINATE, 7: Action.DISARM,
}  # fmt: skip


# (COM_LOW_BAT_ACT, level) -> action; everything else warns.
BATTERY_ACTIONS = {
    (2, Level.CRITICAL): Action.LAND,
    (2, Level.EMERGENCY): Action.LAND,
    (3, Level.CRITICAL): Action.RTL,
    (3, Level.EMERGENCY): Action.LAND,
}

# COM_RCL_EXCEPT: bits of the modes that fly on without a pilot.
STICK_EXCEPTIONS = {Mode.MISSION: 1, Mode.HOLD: 2, Mode.TAKEOFF: 2, Mode.LAND: 2, Mode.RTL: 2, Mode.OFFBOARD: 4}


def _gcs_lost(pilot: Watched) -> Action:
    """From the parameter NAV_DLL_ACT. A landing just goes on."""
    if pilot.hears_gcs or pilot.intended is Mode.LAND:
        return Action.NONE
    return LINK_ACTIONS.get(int(pilot.parameters["NAV_DLL_ACT"]), Action.NONE)


def _sticks_lost(pilot: Watched) -> Action:
    """A pilot who was never there while armed is not missed."""
    excepted = int(pilot.parameters["COM_RCL_EXCEPT"]) & STICK_EXCEPTIONS.get(pilot.intended, 0)
    if pilot.has_sticks or not pilot.had_sticks or excepted:
        return Action.NONE
    return LINK_ACTIONS.get(int(pilot.parameters["NAV_RCL_ACT"]), Action.NONE)


def _geofence(pilot: Watched) -> Action:
    if not pilot.geofence.breached:
        return Action.NONE
    return GEOFENCE_ACTIONS.get(int(pilot.parameters["GF_ACTION"]), Action.WARN)


def _battery(pilot: Watched) -> Action:
    if pilot.battery is Level.FINE:
        return Action.NONE
    return BATTERY_ACTIONS.get((int(pilot.parameters["COM_LOW_BAT_ACT"]), pilot.battery), Action.WARN)


def _mode(pilot: Watched) -> Action:
    """The mode that somebody wants cannot be flown."""
    if can_run(pilot, pilot.intended):
        return Action.NONE
    action = Action.RTL
    if pilot.intended is Mode.OFFBOARD and not pilot.hears_setpoints:
        action = OFFBOARD_ACTIONS.get(int(pilot.parameters["COM_OBL_RC_ACT"]), Action.POSITION)
    elif pilot.has_sticks:
        action = Action.ALTITUDE
    if action in NEEDS_STICKS and not pilot.has_sticks:
        action = LINK_ACTIONS.get(int(pilot.parameters["NAV_RCL_ACT"]), Action.RTL)
    return action


class Watch(NamedTuple):
    """One thing that can fail.

    Attributes:
        lasts: it stays failed until the mode changes or the vehicle disarms. waits: a person has time to avert it.
    """

    action: Callable[[Watched], Action]
    lasts: bool
    waits: bool


WATCHES: tuple[Watch, ...] = (
    Watch(_sticks_lost, lasts=True, waits=True),
    Watch(_gcs_lost, lasts=True, waits=True),
    Watch(_geofence, lasts=True, waits=True),
    Watch(_battery, lasts=False, waits=True),
    Watch(_mode, lasts=False, waits=False),
)


class Failsafes:
    """All that watches over one vehicle.

    Attributes:
        action: what is done now.
    """

    def __init__(self) -> None:
        self.action = Action.NONE
        self._asked: dict[Watch, Action] = {}
        self._failing: set[Watch] = set()
        self._holds_until_s = 0.0
        self._taken_over = False

    @property
    def active(self) -> bool:
        """Whether HEARTBEAT.system_status is CRITICAL."""
        return self.action > Action.WARN

    def rest(self) -> None:
        """Disarmed: nothing is done."""
        self.action = Action.NONE
        self._asked.clear()
        self._failing.clear()
        self._holds_until_s, self._taken_over = 0.0, False

    def take_over(self) -> None:
        """Somebody chose a mode: what has failed and is over is over; what still fails is left to that person."""
        self._asked = {watch: action for watch, action in self._asked.items() if watch in self._failing}
        self._taken_over = self.active
        self._holds_until_s = 0.0

    def watch(self, pilot: Watched) -> None:
        """Look at everything once, and do the one thing that is to be done."""
        if not pilot.armed:
            self.rest()
            return
        self._watch_battery(pilot)
        for watch in WATCHES:
            self._ask(pilot, watch)
        if not self._asked:
            self._taken_over = False
        action = self._possible(pilot, self._chosen(pilot))
        if action is not self.action:
            before, self.action = self.action, action
            pilot.announce = True
            if self.active and not (before is Action.HOLD and self._holds_until_s > 0.0):
                self._tell(pilot)
            if action is not Action.HOLD:
                self._holds_until_s = 0.0
        if action in STOPS_MOTORS:
            pilot.stop_motors()
        else:
            pilot.fly_mode(ACTION_MODES.get(action, pilot.intended))

    def _watch_battery(self, pilot: Watched) -> None:
        for level, (threshold, severity, text) in BATTERY_LEVELS.items():
            if level <= pilot.battery:
                break
            if pilot.charge_share < pilot.parameters[threshold]:
                pilot.battery = level
                pilot.say(severity, text)
                break

    def _ask(self, pilot: Watched, watch: Watch) -> None:
        action = watch.action(pilot)
        if action is Action.NONE:
            self._failing.discard(watch)
            if not watch.lasts:
                self._asked.pop(watch, None)
            return
        news = watch not in self._asked
        self._failing.add(watch)
        self._asked[watch] = action
        if news and action >= Action.HOLD:
            self._taken_over = False
        delay_s = pilot.parameters["COM_FAIL_ACT_T"]
        if news and watch.waits and action > Action.WARN and delay_s > 0.1 and not self.active:
            self._holds_until_s = pilot.now_s + delay_s

    def _chosen(self, pilot: Watched) -> Action:
        action = max(self._asked.values(), default=Action.NONE)
        if self._taken_over and action not in STOPS_MOTORS:
            return max(Action.WARN, _mode(pilot))
        waits = pilot.now_s < self._holds_until_s - TIME_SLACK_S
        if waits and action not in (Action.NONE, Action.WARN, *STOPS_MOTORS):
            return Action.HOLD
        return action

    def _possible(self, pilot: Watched, action: Action) -> Action:
        """The gravest of what is asked for, or the next graver that can be flown; nothing that is being done anyway."""
        while action in ACTION_MODES and not can_run(pilot, ACTION_MODES[action]):
            action = Action(action + 1)
        lands, returns = pilot.intended is Mode.LAND, pilot.intended is Mode.RTL and can_run(pilot, Mode.RTL)
        if Action.WARN < action <= Action.RTL and (lands or returns):
            return Action.WARN
        return Action.WARN if action is Action.LAND and lands else action

    def _tell(self, pilot: Watched) -> None:
        left_s = self._holds_until_s - pilot.now_s
        if self.action is Action.HOLD and left_s > 0.0:
            pilot.say(CRITICAL, f"Failsafe activated: entering Hold for {left_s:.0f} seconds")
        else:
            pilot.say(CRITICAL, "Failsafe activated")
