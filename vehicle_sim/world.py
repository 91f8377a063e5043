"""The world: targets on the ground, and what each agent's sensor sees of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from comms.cells import Cells
from comms.messages import Sighting
from vehicle_sim.herd import Herd, Place
from vehicle_sim.sensing import ALL_AROUND, facing, reported, sees


class World:
    """Ground truth. It knows every target; what leaves it is only what some agent senses.

    By uid: `sensing_ranges_m`, and `headings`, unit vectors along which agents look at first. `cos_half_opening` is
    that of half the angle they look into.

    Attributes:
        seen: per target, whether any sensor saw it at the last `sense`, under whatever name.
    """

    def __init__(
        self,
        *,
        herd: Herd,
        sensing_ranges_m: Sequence[float],
        headings: Sequence[Place],
        cos_half_opening: float = ALL_AROUND,
        identity_error: float = 0.0,
        seed: int = 0,
    ) -> None:
        self.herd = herd
        self._ranges_m = tuple(sensing_ranges_m)
        self._farthest_m = max(sensing_ranges_m)
        self._facing = list(headings)
        self._cos_half_opening = cos_half_opening
        self._identity_error = identity_error
        self._seed = seed
        self.seen = [False] * len(herd.places)

    @property
    def places(self) -> Sequence[Place | None]:
        """Where every target is, ENU meters; None while it is not in the world."""
        return self.herd.places

    def sense(
        self,
        tick: int,
        agents: Sequence[Place | None],
        velocities_m_s: Sequence[Place],
        identity_errors: Mapping[int, float] = MappingProxyType({}),
    ) -> list[list[Sighting]]:
        """What each agent at its true (x, y) sees in state `tick`, by uid; one on the ground (None) sees nothing.

        Sightings are in the order of the targets seen, whose names may be mistaken: two may bear the same one.
        `identity_errors`, by uid, are those of agents that mistake targets more often than usual.
        """
        seen = [False] * len(self.herd.places)
        self._facing = [facing(*was, *velocity) for was, velocity in zip(self._facing, velocities_m_s, strict=True)]
        sightings: list[list[Sighting]] = [[] for _ in agents]
        cells = Cells(agents, range_m=self._farthest_m)
        for target, place in enumerate(self.herd.places):
            if place is None:
                continue
            x, y = place
            for uid in cells.near(x, y):
                agent = agents[uid]
                if agent is not None and self._sees(uid, x - agent[0], y - agent[1]):
                    error = identity_errors.get(uid, self._identity_error)
                    name = reported(target, len(seen), error, uid, self._seed, tick)
                    sightings[uid].append(Sighting(name, x, y))
                    seen[target] = True
        self.seen = seen
        return sightings

    def _sees(self, uid: int, dx_m: float, dy_m: float) -> bool:
        facing_x, facing_y = self._facing[uid]
        return sees(dx_m, dy_m, self._ranges_m[uid], facing_x, facing_y, self._cos_half_opening)

    def advance(self, tick: int, agents: Sequence[Place | None]) -> None:
        """Targets decide from state `tick` and move to `tick` + 1; they notice agents in the air alone."""
        aloft = [agent for agent in agents if agent is not None]
        self.herd.advance(tick, [x for x, _ in aloft], [y for _, y in aloft])
