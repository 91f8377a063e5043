"""How an agent goes home while the mission goes on: it lets its targets go, and calls for each until a mate has it.

    farewell = Farewell(table)             # of an agent on duty; its tags are calls from now on
    farewell.tick(table, params, now_s)    # once a tick, after hearing and seeing
    farewell.over                          # mates have them, or what it knows of them is too old to help anybody

The rules of the algorithm are not asked: who must go does not weigh anything any more.
"""

from __future__ import annotations

from comms.status import Event, Level
from swarm_agent.bcmommt.belief import Table, owned_by_mate
from swarm_agent.bcmommt.params import Params

WORTH_S = 10.0  # a target is looked for where it was for so long, if the mission does not remember it for longer


class Farewell:
    """What an agent that goes home still says.

    Attributes:
        targets: those that it calls for.
    """

    def __init__(self, table: Table) -> None:
        self.targets = {j for j in table.known if table.tagged[j] or table.calling[j]}
        self._left = [f"T{j}" for j in table.known if table.tagged[j]]

    @property
    def over(self) -> bool:
        """Whether there is nothing more to say."""
        return not self.targets

    def tick(self, table: Table, params: Params, now_s: float) -> None:
        """Call for what nobody has taken over. Fills the columns tagged and calling."""
        worth_s = max(params.memory_s, WORTH_S)
        self.targets = {
            j
            for j in self.targets
            if not owned_by_mate(table, params, j, now_s) and now_s - table.known_at_s[j] <= worth_s
        }
        for j in table.known:
            table.tagged[j] = False
            table.calling[j] = j in self.targets

    def take_events(self) -> tuple[Event, ...]:
        """What it has left, once."""
        left, self._left = self._left, []
        if not left:
            return ()
        return (Event(Level.WARNING, f"leaves {', '.join(left)}, and calls until a mate follows"),)
