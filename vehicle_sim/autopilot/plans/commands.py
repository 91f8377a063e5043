"""What a mission may hold: each command with the word ArduCopter has for it in "Mission: 3 WP".

Commands from 96 on are done beside the way or are conditions for what is; those below are ways.
"""

from __future__ import annotations

from typing import NamedTuple

LAST_WAY = 95  # MAV_CMD_NAV_LAST

WAYPOINT, LOITER_UNLIMITED, LOITER_TURNS, LOITER_TIME = 16, 17, 18, 19
RETURN, LAND, TAKEOFF, LOITER_TO_ALTITUDE = 20, 21, 22, 31
SPLINE, DELAY = 82, 93
CONDITION_DELAY, CONDITION_DISTANCE, CONDITION_YAW = 112, 114, 115
JUMP, CHANGE_SPEED, SET_HOME, LAND_START = 177, 178, 179, 189
ROI_LOCATION, ROI_NONE, ROI, FENCE_ENABLE = 195, 197, 201, 207


class Row(NamedTuple):
    """What a command of a mission is like.

    Attributes:
        word: as the text says it. place: its x and y are a latitude and a longitude.
        any_yaw: its parameter 4 may be NaN. acts: False for what this vehicle has no hardware for: kept and passed by.
    """

    word: str
    place: bool = False
    any_yaw: bool = False
    acts: bool = True


COMMANDS: dict[int, Row] = {
    WAYPOINT: Row("WP", place=True, any_yaw=True),
    LOITER_UNLIMITED: Row("LoitUnlim", place=True, any_yaw=True),
    LOITER_TURNS: Row("LoitTurns", place=True, any_yaw=True),
    LOITER_TIME: Row("LoitTime", place=True, any_yaw=True),
    RETURN: Row("RTL"),
    LAND: Row("Land", place=True, any_yaw=True),
    TAKEOFF: Row("Takeoff", place=True, any_yaw=True),
    LOITER_TO_ALTITUDE: Row("LoitAltitude", place=True, any_yaw=True),
    SPLINE: Row("SplineWP", place=True, any_yaw=True),
    DELAY: Row("Delay"),
    CONDITION_DELAY: Row("CondDelay"),
    CONDITION_DISTANCE: Row("CondDist"),
    CONDITION_YAW: Row("CondYaw"),
    JUMP: Row("Jump"),
    CHANGE_SPEED: Row("ChangeSpeed"),
    181: Row("SetRelay", acts=False),
    183: Row("SetServo", acts=False),
    SET_HOME: Row("SetHome", place=True),
    LAND_START: Row("LandStart", place=True),
    ROI_LOCATION: Row("SetROI", place=True),
    ROI_NONE: Row("SetROI", place=True),
    ROI: Row("SetROI", place=True),
    202: Row("DigiCamCfg", acts=False),
    203: Row("DigiCamCtrl", acts=False),
    205: Row("MountControl", acts=False),
    206: Row("SetCamTrigDst", acts=False),
    FENCE_ENABLE: Row("FenceEnable"),
    211: Row("Gripper", acts=False),
    1000: Row("GimbalPitchYaw", any_yaw=True, acts=False),
    2000: Row("ImageStartCapture", acts=False),
    2001: Row("ImageStopCapture", acts=False),
    2500: Row("VideoStartCapture", acts=False),
    2501: Row("VideoStopCapture", acts=False),
}


def is_way(command: int) -> bool:
    """Whether it is a way to fly, which the next one waits for."""
    return command <= LAST_WAY
