"""An agent that people speak to: what they told it stands between the mission's cues and its side."""

from __future__ import annotations

from time import monotonic

from comms.status import Activity
from missions.daemons.orders import Answer, Orders, Watch
from missions.sides.agent import AgentSide
from missions.sides.exchange import Cue, Done


class Attended:
    """Agent `uid`, whose tick is its side's under the orders that stand.

    Args:
        orders: what it was told before it was switched on, if it was.

    Attributes:
        last: its last done. orders: what people told it.
    """

    def __init__(self, side: AgentSide, *, tick_s: float, orders: Orders | None = None) -> None:
        self.side = side
        self.last = side.hello()
        self.orders = Orders() if orders is None else orders
        self._watch = Watch()
        self._tick_s = tick_s

    @property
    def uid(self) -> int:
        """Its number."""
        return self.side.uid

    @property
    def activity(self) -> Activity:
        """What it does."""
        return self.last.status.activity

    def tick(self, cue: Cue) -> Done:
        """One tick of its side.

        Raises:
            RuntimeError: the inbox is not what was sent to it.
        """
        began_s = monotonic()
        done = self.orders.confirm(self.side.tick(self.orders.amend(cue)))
        self._watch.see(done, time_s=cue.tick * self._tick_s, late_s=cue.late_s, busy_s=monotonic() - began_s)
        self.last = done
        return done

    def obey(self, word: str) -> Answer:
        """Take an order, or a question; what is to be said to it."""
        obeyed, text = self.orders.take(word, self.activity)
        report = self._watch.report(self.last, time_s=max(0, self.last.tick) * self._tick_s)
        return Answer(obeyed=obeyed, text=text, report=report)
