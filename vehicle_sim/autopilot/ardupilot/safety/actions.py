"""What a failsafe or a fence flies: a table from the action to the modes that do it."""

from __future__ import annotations

from enum import IntEnum

from vehicle_sim.autopilot.ardupilot.modes import Mode
from vehicle_sim.autopilot.ardupilot.watched import Watched
from vehicle_sim.autopilot.navigation.landing import Land
from vehicle_sim.autopilot.severity import WARNING

LANDING_GOES_ON = 8  # FS_OPTIONS


class Action(IntEnum):
    """What to do, numbered as BATT_FS_LOW_ACT counts."""

    NONE = 0
    LAND = 1
    RTL = 2
    SMART_RTL_OR_RTL = 3
    SMART_RTL_OR_LAND = 4
    TERMINATE = 5
    BRAKE_OR_LAND = 7


# The modes to try, in order. TERMINATE stops the motors wherever it is.
ACTION_MODES: dict[Action, tuple[Mode, ...]] = {
    Action.NONE: (),
    Action.LAND: (Mode.LAND,),
    Action.RTL: (Mode.RTL, Mode.LAND),
    Action.SMART_RTL_OR_RTL: (Mode.SMART_RTL, Mode.RTL, Mode.LAND),
    Action.SMART_RTL_OR_LAND: (Mode.SMART_RTL, Mode.LAND),
    Action.TERMINATE: (),
    Action.BRAKE_OR_LAND: (Mode.BRAKE, Mode.LAND),
}


def act(pilot: Watched, action: Action) -> None:
    """Fly what `action` asks for: the first of its modes that can be entered."""
    if action is Action.TERMINATE:
        pilot.disarm(forced=True)
    enter_first(pilot, ACTION_MODES[action])


def enter_first(pilot: Watched, modes: tuple[Mode, ...]) -> None:
    """Change to the first of `modes` that can be entered."""
    for mode in modes:
        if pilot.set_mode(mode):
            return


def pause_landing(pilot: Watched) -> None:
    """If it lands now: not at once, as every landing that a failsafe began (recorded; a fence's does not wait)."""
    if isinstance(pilot.guidance.navigator, Land):
        pilot.guidance.navigator.linger()


def fail(pilot: Watched, what: str, action: Action) -> None:
    """Say that `what` failed and do something about it: on the ground, disarm; in a landing, perhaps just go on."""
    landing = pilot.guidance.landing and int(pilot.parameters["FS_OPTIONS"]) & LANDING_GOES_ON
    if not pilot.armed:
        pilot.say(WARNING, f"{what} Failsafe")
    elif not pilot.flying:
        pilot.say(WARNING, f"{what} Failsafe - Disarming")
        pilot.disarm(forced=True)
    elif landing and action is not Action.NONE:
        pilot.say(WARNING, f"{what} Failsafe - Continuing Landing")
    else:
        pilot.say(WARNING, f"{what} Failsafe")
        act(pilot, action)
        pause_landing(pilot)


def action_of(number: float, otherwise: Action) -> Action:
    """The action that a parameter names."""
    return Action(int(number)) if int(number) in Action.__members__.values() else otherwise
