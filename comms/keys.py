"""The table of topics: every key expression of a mission is built and parsed here, and nowhere else.

    swarm/@v1/<mission>/tx/<uid>             agent -> air: one frame per tick; in the field -> every mate
    swarm/@v1/<mission>/rx/<uid>             air -> that agent alone: what got through, one bundle per tick
    swarm/@v1/<mission>/sight/<uid>          detector on board -> agent without a world: what is in sight
    swarm/@v1/<mission>/alive/<who>          liveliness token: of an agent (its uid), of the world
    swarm/@v1/<mission>/alive/recorder/<life>
                                             liveliness token of a recorder, of which there may be several
    swarm/@v1/<mission>/alive/flight         liveliness token of a mission whose agents all fly in one process
    swarm/@v1/<mission>/alive/crew<n>        liveliness token of a world or flight: so many agents belong to its mission
    swarm/@v1/<mission>/cmd/<uid>/<verb>     queryable of an agent: what people tell it, with a result
    swarm/@v1/<mission>/@sim/cue/<uid>       world -> that agent alone: a tick begins, and what its sensor sees
    swarm/@v1/<mission>/@sim/done/<uid>      agent -> world: the tick is done, and where its vehicle truly is
    swarm/@v1/<mission>/@sim/truth           world -> recorder: every tick whole
    swarm/@v1/<mission>/@sim/kept            recorder -> world: how far it has got

`@v1` and `@sim` seal their trees: a plain `**` of somebody else does not match them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

WORLD, RECORDER, FLIGHT = "world", "recorder", "flight"
_ROOT = "swarm/@v1"
_ALIVE = re.compile(rf"{_ROOT}/(?P<mission>[A-Za-z0-9][A-Za-z0-9_.-]{{0,63}})/alive/(?P<who>[a-z0-9]+)")
_CREW = re.compile(r"crew(?P<size>[0-9]{1,5})")
_MISSION = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")


@dataclass(frozen=True, slots=True)
class Keys:
    """The keys of one mission.

    Raises:
        ValueError: if the mission's name cannot be one chunk of a key (letters, digits, `_`, `.`, `-`; at most 64).
    """

    mission: str

    def __post_init__(self) -> None:
        if not _MISSION.fullmatch(self.mission):
            raise ValueError(
                f"mission name {self.mission!r} is not usable in a key: letters, digits, _ . - (at most 64)"
            )

    def tx(self, uid: int) -> str:
        """Where agent `uid` sends."""
        return f"{_ROOT}/{self.mission}/tx/{uid}"

    @property
    def every_tx(self) -> str:
        """What the air subscribes to."""
        return f"{_ROOT}/{self.mission}/tx/*"

    def rx(self, uid: int) -> str:
        """Where agent `uid` hears the others: its own receiver and nobody else's."""
        return f"{_ROOT}/{self.mission}/rx/{uid}"

    def sight(self, uid: int) -> str:
        """Where a detector on board tells agent `uid` what is in sight."""
        return f"{_ROOT}/{self.mission}/sight/{uid}"

    def alive(self, who: int | str) -> str:
        """The token that says `who` is there: an agent's uid, WORLD or FLIGHT."""
        return f"{_ROOT}/{self.mission}/alive/{who}"

    def recorder(self, life: int) -> str:
        """The token that says this one of the recorders is there."""
        return f"{self.alive(RECORDER)}/{life}"

    @property
    def every_recorder(self) -> str:
        """The tokens of all recorders."""
        return f"{self.alive(RECORDER)}/*"

    def crew(self, n_agents: int) -> str:
        """The token that says how many agents the mission has, there or not."""
        return self.alive(f"crew{n_agents}")

    @property
    def every_alive(self) -> str:
        """Everybody's token."""
        return f"{_ROOT}/{self.mission}/alive/*"

    def command(self, who: int | str, verb: str) -> str:
        """Where agent `who`, or the WORLD, takes a command from people."""
        return f"{_ROOT}/{self.mission}/cmd/{who}/{verb}"

    def every_command(self, who: int | str) -> str:
        """What it listens to."""
        return f"{_ROOT}/{self.mission}/cmd/{who}/*"

    @property
    def every_order(self) -> str:
        """Where everybody takes commands."""
        return f"{_ROOT}/{self.mission}/cmd/*/*"

    def cue(self, uid: int) -> str:
        """Where the world tells agent `uid` that a tick begins."""
        return f"{_ROOT}/{self.mission}/@sim/cue/{uid}"

    def done(self, uid: int) -> str:
        """Where agent `uid` tells the world that a tick is done."""
        return f"{_ROOT}/{self.mission}/@sim/done/{uid}"

    @property
    def every_done(self) -> str:
        """What the world subscribes to."""
        return f"{_ROOT}/{self.mission}/@sim/done/*"

    @property
    def truth(self) -> str:
        """Where the world tells the recorder everything."""
        return f"{_ROOT}/{self.mission}/@sim/truth"

    @property
    def kept(self) -> str:
        """Where the recorder tells the world how far it has got."""
        return f"{_ROOT}/{self.mission}/@sim/kept"


EVERYBODY_OF_ANY_MISSION = f"{_ROOT}/*/alive/*"


def somebody(key: str) -> tuple[Keys, str] | None:
    """Whom an `alive` key names: the keys of its mission, and who; None if it is another key."""
    found = _ALIVE.fullmatch(key)
    return None if found is None else (Keys(found["mission"]), found["who"])


def crew_size(who: str) -> int | None:
    """How many agents there are, if an `alive` key names that and nobody."""
    found = _CREW.fullmatch(who)
    return None if found is None else int(found["size"])


def verb_of(key: str) -> str:
    """The last chunk of a command's key."""
    return key.rpartition("/")[2]


def sender(key: str) -> int | None:
    """Whom a `tx`, `done` or `alive` key names: its last chunk; None if that is not a number."""
    chunk = key.rpartition("/")[2]
    return int(chunk) if chunk.isascii() and chunk.isdigit() and len(chunk) <= 9 else None
