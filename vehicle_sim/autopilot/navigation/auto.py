"""AUTO: fly the mission, one leg after the other, and do beside it what lies between the legs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import atan2, copysign, radians

from comms.frames import Vec3
from vehicle_sim.autopilot.mission import Mission
from vehicle_sim.autopilot.navigation.legs import BeginLeg, Leg, WaypointLeg
from vehicle_sim.autopilot.navigation.navigator import Navigator
from vehicle_sim.autopilot.plans import commands
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.steering import Steering
from vehicle_sim.flight import Demand, wrap_pi

TURNED_RAD = radians(2.0)

Done = Callable[[float], bool]


class Auto(Navigator):
    """One stay in AUTO.

    Args:
        legs: what begins to fly each way.

    Attributes:
        lands: what is flown ends on the ground.
    """

    def __init__(self, steering: Steering, now_s: float, mission: Mission, *, legs: Mapping[int, BeginLeg]) -> None:
        super().__init__(steering, now_s)
        self._mission = mission
        self._legs = legs
        self._leg: Leg | None = None
        self._side: Done | None = None
        self._side_index = 0
        self._yaw_rad: float | None = None  # what CONDITION_YAW asked for
        self._interest_ned_m: Vec3 | None = None  # what the nose looks at
        self._paused_ned_m: Vec3 | None = None
        self._stay_ned_m: Vec3 | None = None  # at the end of the mission
        mission.begin(restarts=steering.parameters["MIS_RESTART"] == 1.0)

    @property
    def leg(self) -> Leg | None:
        """What is flown now."""
        return self._leg

    @property
    def landing(self) -> bool:  # type: ignore[override]
        return self._leg is not None and self._leg.landing

    @property
    def taking_off(self) -> bool:  # type: ignore[override]
        return self._leg is not None and self._leg.taking_off

    @property
    def lands(self) -> bool:  # type: ignore[override]
        return self._mission.complete or (self._leg is not None and self._leg.lands)

    def spooled(self, now_s: float) -> bool:
        return self._leg is not None and self._leg.spooled(now_s)

    def pause(self, paused: bool) -> bool:
        """Stop on the way to a waypoint; go on from there."""
        if paused and not (isinstance(self._leg, WaypointLeg) and not self._leg.there):
            return False
        self._paused_ned_m = self.steering.stopping_ned_m() if paused else None
        return True

    def turn(self, yaw_rad: float) -> None:
        self._yaw_rad = yaw_rad

    def leave(self, now_s: float) -> None:
        self._mission.stop()

    def demand(self, now_s: float) -> Demand | None:
        if self._paused_ned_m is not None:
            return self.steering.towards(self._paused_ned_m)
        self._go_on(now_s)
        self._do_beside(now_s)
        if self._leg is None:
            self._stay_ned_m = self._stay_ned_m or self.steering.stopping_ned_m()
            return self.steering.towards(self._stay_ned_m)
        demand = self._leg.demand(now_s)
        return None if demand is None else demand._replace(yaw_rate_rad_s=self.steering.turn_rad_s(self._nose_rad()))

    def _go_on(self, now_s: float) -> None:
        """Begin the way that is current; on to the next when it is done."""
        mission, leg = self._mission, self._leg
        if leg is not None and not mission.fresh and leg.done(now_s):
            mission.reach(leg.index)
            mission.advance()
        if mission.complete:
            self._leg = None
        elif mission.fresh:
            mission.fresh = False
            self._side = None
            item = mission.items[mission.current]
            self._yaw_rad = None if item.command == commands.WAYPOINT else self._yaw_rad
            self._stay_ned_m = None
            self._leg = self._legs[item.command](self.steering, now_s, item, mission)

    def _do_beside(self, now_s: float) -> None:
        """Begin and finish, in order, what is to be done beside this leg."""
        mission = self._mission
        if self._side is not None and self._side(now_s):
            self._side = None
            mission.reach(self._side_index)
        if self._side is None and mission.sides and self._leg is not None:
            self._side_index = mission.sides.pop(0)
            mission.tell(self._side_index)
            self._side = self._begin_beside(mission.items[self._side_index], now_s)

    def _begin_beside(self, item: Item, now_s: float) -> Done:
        """Do it; what comes back says when it is done."""
        steering = self.steering
        if item.command == commands.CONDITION_DELAY:
            return lambda later_s: later_s - now_s >= item.param1
        if item.command == commands.CONDITION_DISTANCE:
            return lambda later_s: self._leg is None or steering.distance_m(self._leg.goal_ned_m) < item.param1
        if item.command == commands.CONDITION_YAW:
            self._yaw_rad = yaw_of(item.params, nose_rad=steering.airframe.yaw_rad)
            wanted_rad = self._yaw_rad
            return lambda later_s: abs(wrap_pi(wanted_rad - steering.airframe.yaw_rad)) < TURNED_RAD
        if item.command == commands.CHANGE_SPEED:
            steering.change_speed(int(item.param1), item.param2)
        elif item.command == commands.SET_HOME:
            steering.home_ned_m = steering.place_ned_m if item.param1 == 1.0 else steering.ned_from_item(item)
        elif item.command == commands.FENCE_ENABLE:
            steering.parameters.store("FENCE_ENABLE", float(item.param1 == 1.0))
        elif item.command in (commands.ROI, commands.ROI_LOCATION):
            self._interest_ned_m = steering.ned_from_item(item) if item.x or item.y else None
        elif item.command == commands.ROI_NONE:
            self._interest_ned_m = None
        return lambda later_s: True

    def _nose_rad(self) -> float | None:
        if self._interest_ned_m is not None:
            north_m, east_m, _ = self.steering.place_ned_m
            return atan2(self._interest_ned_m[1] - east_m, self._interest_ned_m[0] - north_m)
        if self._yaw_rad is not None or self._leg is None:
            return self._yaw_rad
        return self._leg.yaw_rad


def yaw_of(params: tuple[float, ...], *, nose_rad: float) -> float:
    """CONDITION_YAW: parameter 1 degrees from north, or (parameter 4) from the nose, in the sense of parameter 3."""
    degrees, _, sense, relative = params[:4]
    if relative == 1.0:
        return wrap_pi(nose_rad + radians(degrees) * copysign(1.0, sense or 1.0))
    return wrap_pi(radians(degrees))
