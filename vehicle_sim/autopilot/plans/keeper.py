"""A vehicle's three plans, the course through its mission, and what the rest should know when one changes."""

from __future__ import annotations

from collections.abc import Callable

from comms.frames import GeoPoint
from vehicle_sim.autopilot.mission import Mission, State
from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.autopilot.plans.item import Item
from vehicle_sim.autopilot.plans.rules import PlanRules
from vehicle_sim.autopilot.plans.store import Store


class Keeper:
    """Owner of the plans.

    Attributes:
        missions, fences, rallies: the plans as they were uploaded. mission: the course through the first.
        say: a text (severity, words) for the ground. home: where home is now.
    """

    def __init__(
        self,
        rules: PlanRules,
        *,
        parameters: Parameters,
        say: Callable[[int, str], None],
        home: Callable[[], GeoPoint],
    ) -> None:
        self.rules = rules
        self.stores = tuple(Store(kind) for kind in rules.kinds)
        self.missions, self.fences, self.rallies = self.stores
        self.mission = Mission(self.missions, first=rules.first, say=say if rules.talks else _silence)
        self.say = say
        self.home = home
        self._parameters = parameters

    def may_clear(self, store: Store) -> bool:
        """Not the mission that is being flown."""
        return store is not self.missions or self.mission.state is not State.ACTIVE

    def flies_item(self, store: Store, seq: int) -> bool:
        return store is self.missions and seq == self.mission.current

    def replace(self, store: Store, items: tuple[Item, ...]) -> None:
        """A plan has come, or was cleared."""
        store.put(items)
        if store.kind.total:
            self._parameters.tell(store.kind.total, len(items))
        if store is not self.missions:
            return
        if self.rules.starts_over and self.mission.state is not State.ACTIVE:
            self.mission.reset()
        self.mission.changed()


def _silence(severity: int, text: str) -> None:
    """What a mission has to say, where nobody says it."""
