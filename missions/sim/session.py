"""One vehicle in real time on its links, until Ctrl-C. Clock, signals and terminal are here; the vehicle knows none."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from itertools import count
from math import radians

from comms.clock import Pace, RealTime
from missions.ground_link import GroundLink, open_ground_link
from missions.problems import InputError, did_you_mean
from missions.sim.options import SimOptions
from vehicle_sim.autopilot import SimulatedVehicle
from vehicle_sim.autopilot.parameters import Alias
from vehicle_sim.vehicle import VehicleConfig

STOPPED = 130
TICK_S = 0.02  # of the vehicle's clock: its fastest stream is 50 Hz
TOO_LATE_S = 0.5  # further behind, the vehicle's clock is let slip
TELL_PERIOD_TICKS = round(10.0 / TICK_S)


def simulate(options: SimOptions) -> int:
    """Fly a vehicle until Ctrl-C. Returns the exit code.

    Raises:
        InputError: a link that cannot be opened, or a parameter that the vehicle does not have.
    """
    vehicle = power_on(options)
    with ExitStack() as stack:
        before = signal.signal(signal.SIGTERM, signal.default_int_handler)
        stack.callback(signal.signal, signal.SIGTERM, before)
        links = [
            stack.enter_context(open_ground_link(url, [vehicle], option=option, key=options.key))
            for option, url in options.links
        ]
        _tell(f"{options.flavour} vehicle {options.system_id} on {', '.join(link.url for link in links)}")
        with suppress(KeyboardInterrupt):
            _run(vehicle, links, pace=SlippingPace(speed=options.speed, tell=_tell))
        for link in links:
            _tell(str(link))
    return STOPPED


def power_on(options: SimOptions) -> SimulatedVehicle:
    """The vehicle, at home and just switched on.

    Raises:
        InputError: a parameter that it does not have, or that cannot be set.
    """
    vehicle = SimulatedVehicle(
        config=VehicleConfig(flavor=options.flavour, boot_s=options.boot_s),
        system_id=options.system_id,
        home=options.home,
        heading_rad=radians(options.heading_deg),
        seed=options.seed,
    )
    parameters = vehicle.autopilot.parameters
    catalog = parameters.catalog
    for name, value in options.parameters:
        ours = catalog.aliases.get(name, Alias(name))
        if ours.name not in catalog.index:
            hint = did_you_mean(name, (*catalog.index, *catalog.aliases))
            raise InputError(f"--param: got {name}, which it does not have{hint}")
        if not parameters.store(ours.name, ours.scale * value + ours.offset):
            raise InputError(f"--param: got {name}={value:g}; allowed: another parameter, {name} is read-only")
    return vehicle


class SlippingPace:
    """Real time, `speed` times as fast; a computer that cannot keep up makes the clock slip, and is told so."""

    def __init__(self, *, speed: float, tell: Callable[[str], None]) -> None:
        self._speed = speed
        self._tell = tell
        self._pace = RealTime(tick_s=TICK_S, speed=speed)
        self._silent_until = 0

    def begin(self, tick: int) -> float:
        late_s = self._pace.begin(tick)
        if late_s > TOO_LATE_S:
            self._pace = RealTime(tick_s=TICK_S, speed=self._speed)
            if tick >= self._silent_until:
                self._silent_until = tick + TELL_PERIOD_TICKS
                self._tell(f"too slow for {self._speed:g} times real time: {late_s:.1f} s late, the clock slips")
        return late_s


def _run(vehicle: SimulatedVehicle, links: Sequence[GroundLink], *, pace: Pace) -> None:
    for tick in count(1):
        pace.begin(tick)
        for link in links:
            link.hear()
        vehicle.tick(tick * TICK_S)
        for link in links:
            link.say()


def _tell(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()
