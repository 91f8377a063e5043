"""The mission protocol, sans-io: one plan goes up (we ask for item after item) or down (we are asked).

An upload takes items with float and with integer places, asks again, gives up in the end, and belongs to who began it;
`rules` has what it asks with and when. A plan is replaced as a whole when its last item has come, unlike in ArduCopter:
an upload that breaks off leaves the old plan.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.plans.item import Item, as_float, as_int, home_item, received
from vehicle_sim.autopilot.plans.keeper import Keeper
from vehicle_sim.autopilot.plans.store import FENCE, Answer, Store, polygons_closed
from vehicle_sim.autopilot.severity import INFO, WARNING

Send = Callable[[Any], None]
Address = tuple[int, int]  # system and component


@dataclass(slots=True)
class Upload:
    """One upload under way: from whom, on which link, what has come, which item is asked for."""

    source: Address
    send: Send
    items: list[Item]
    next_seq: int
    last_seq: int
    heard_at_s: float
    asked_at_s: float


class Transfer:
    """The protocol of one plan, for all links."""

    def __init__(self, store: Store, keeper: Keeper) -> None:
        self.store = store
        self._keeper = keeper
        self._rules = keeper.rules
        self._upload: Upload | None = None

    # Down.

    def request_list(self, message: Any, send: Send, now_s: float) -> None:
        """MISSION_REQUEST_LIST: how many there are."""
        source = _source(message)
        if self._upload is not None:
            self._acknowledge(send, source, Answer.DENIED)
        else:
            self._count(send, source)

    def request_int(self, message: Any, send: Send, now_s: float) -> None:
        self._give(message, send, as_int)

    def request(self, message: Any, send: Send, now_s: float) -> None:
        self._give(message, send, as_float)

    # Up.

    def count(self, message: Any, send: Send, now_s: float) -> None:
        """MISSION_COUNT: an upload of so many items begins; by the same station, begins again."""
        source = _source(message)
        if self._upload is not None and self._upload.source != source:
            self._acknowledge(send, source, Answer.DENIED)
        elif message.count > self.store.kind.most:
            self._acknowledge(send, source, Answer.NO_SPACE)
            self._keeper.say(WARNING, f"Only {self.store.kind.most} items are supported")
        elif message.count == 0:
            self._complete(send, source, ())
        else:
            self._begin(source, send, [], 0, message.count - 1, now_s)

    def write_partial(self, message: Any, send: Send, now_s: float) -> None:
        """MISSION_WRITE_PARTIAL_LIST: some items are replaced, or added at the end."""
        first, last, total = message.start_index, message.end_index, len(self.store.items)
        source = _source(message)
        if self._upload is not None:
            self._acknowledge(send, source, Answer.DENIED)
        elif not 0 <= first <= last <= total or last >= self.store.kind.most:
            self._keeper.say(WARNING, "Flight plan update rejected")
            self._acknowledge(send, source, Answer.ERROR)
        else:
            self._begin(source, send, list(self.store.items), first, last, now_s)

    def item(self, message: Any, send: Send, now_s: float) -> None:
        """MISSION_ITEM and MISSION_ITEM_INT: taken if it is the one that was asked for."""
        upload, source = self._upload, _source(message)
        if upload is None:
            self._acknowledge(send, source, Answer.ERROR)
        elif message.seq != upload.next_seq:
            if self._rules.strict:
                self._acknowledge(send, source, Answer.INVALID_SEQUENCE)
        elif source != upload.source:
            self._acknowledge(send, source, Answer.DENIED)
        else:
            self._take(upload, received(message), now_s)

    def clear(self, message: Any, send: Send, now_s: float) -> None:
        """MISSION_CLEAR_ALL."""
        self._acknowledge(send, _source(message), self.cleared())

    def cleared(self) -> Answer:
        """Forget the plan, unless an upload or the flight needs it."""
        if self._upload is not None or not self._keeper.may_clear(self.store):
            return Answer.ERROR
        self._keeper.replace(self.store, ())
        return Answer.ACCEPTED

    def forget(self) -> None:
        """Drop the upload that is under way, without a word."""
        self._upload = None

    def watch(self, now_s: float) -> None:
        """Ask again for what has not come; give up on who is gone."""
        upload = self._upload
        if upload is None:
            return
        if now_s - upload.heard_at_s > self._rules.give_up_s:
            self._keeper.say(WARNING, f"{self.store.kind.name} upload timeout")
            self._end(upload, Answer.CANCELLED)
        elif now_s - upload.asked_at_s > self._rules.ask_again_s:
            self._ask(upload, now_s)

    def _begin(self, source: Address, send: Send, items: list[Item], first: int, last: int, now_s: float) -> None:
        self._upload = Upload(source, send, items, first, last, heard_at_s=now_s, asked_at_s=now_s)
        self._ask(self._upload, now_s)

    def _ask(self, upload: Upload, now_s: float) -> None:
        upload.asked_at_s = now_s
        upload.send(self._rules.ask(*upload.source, upload.next_seq, self.store.kind.number))

    def _take(self, upload: Upload, item: Item, now_s: float) -> None:
        count = max(len(upload.items), upload.last_seq + 1)
        result = self.store.kind.accepts(item, count)
        if result is not Answer.ACCEPTED:
            self._end(upload, result)
            return
        upload.items[upload.next_seq : upload.next_seq + 1] = [item]
        upload.heard_at_s = now_s
        upload.next_seq += 1
        if upload.next_seq <= upload.last_seq:
            self._ask(upload, now_s)
        else:
            self._upload = None
            self._complete(upload.send, upload.source, tuple(upload.items))

    def _end(self, upload: Upload, result: Answer) -> None:
        self._upload = None
        self._acknowledge(upload.send, upload.source, result)

    def _complete(self, send: Send, source: Address, items: tuple[Item, ...]) -> None:
        self._upload = None
        if self.store.kind.number == FENCE.number and not polygons_closed(items):
            self._acknowledge(send, source, Answer.ERROR)
            return
        self._keeper.replace(self.store, items)
        if self.store.kind.received:
            self._keeper.say(INFO, self.store.kind.received)
        self._acknowledge(send, source, Answer.ACCEPTED)

    def _give(self, message: Any, send: Send, form: Callable[..., Any]) -> None:
        source, seq, kind = _source(message), message.seq, self.store.kind
        if self._upload is not None:
            self._acknowledge(send, source, Answer.DENIED)
        elif kind.home_first and seq == 0:
            send(form(home_item(self._keeper.home()), to=source, seq=0, current=False, kind=kind.number))
        elif seq < len(self.store.items):
            current = self._keeper.flies_item(self.store, seq)
            send(form(self.store.items[seq], to=source, seq=seq, current=current, kind=kind.number))
        else:
            if kind.home_first:
                self._count(send, source)  # tells a station that asks too far how far it may
            self._acknowledge(send, source, kind.missing)

    def _count(self, send: Send, source: Address) -> None:
        send(dialect.MAVLink_mission_count_message(*source, len(self.store.items), self.store.kind.number))

    def _acknowledge(self, send: Send, source: Address, result: Answer) -> None:
        acknowledge(send, source, result, self.store.kind.number)


def acknowledge(send: Send, source: Address, result: Answer, kind: int) -> None:
    send(dialect.MAVLink_mission_ack_message(*source, int(result), kind))


def _source(message: Any) -> Address:
    return message.get_srcSystem(), message.get_srcComponent()
