"""The desk where plans are handed in and out: which message of the mission protocol goes to which plan."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as dialect

from vehicle_sim.autopilot.plans.item import Item, received
from vehicle_sim.autopilot.plans.keeper import Keeper
from vehicle_sim.autopilot.plans.store import Answer
from vehicle_sim.autopilot.plans.transfer import Send, Transfer, acknowledge

EVERY_PLAN = 255  # MAV_MISSION_TYPE_ALL
GO_THERE, CHANGE_HEIGHT = 2, 3  # MISSION_ITEM.current: no part of a plan, but an order to GUIDED

ROUTES: dict[int, Callable[[Transfer, Any, Send, float], None]] = {
    dialect.MAVLINK_MSG_ID_MISSION_REQUEST_LIST: Transfer.request_list,
    dialect.MAVLINK_MSG_ID_MISSION_REQUEST_INT: Transfer.request_int,
    dialect.MAVLINK_MSG_ID_MISSION_REQUEST: Transfer.request,
    dialect.MAVLINK_MSG_ID_MISSION_COUNT: Transfer.count,
    dialect.MAVLINK_MSG_ID_MISSION_WRITE_PARTIAL_LIST: Transfer.write_partial,
    dialect.MAVLINK_MSG_ID_MISSION_ITEM: Transfer.item,
    dialect.MAVLINK_MSG_ID_MISSION_ITEM_INT: Transfer.item,
    dialect.MAVLINK_MSG_ID_MISSION_CLEAR_ALL: Transfer.clear,
}


class Desk:
    """All plans of one vehicle on the wire. `go` flies an item at once: the old way to steer GUIDED."""

    def __init__(self, keeper: Keeper, *, go: Callable[[Item, bool], bool]) -> None:
        self._transfers = {store.kind.number: Transfer(store, keeper) for store in keeper.stores}
        self._go = go

    def handle(self, message: Any, send: Send, now_s: float) -> None:
        """A message of ROUTES; answers go out by `send`."""
        source, kind = (message.get_srcSystem(), message.get_srcComponent()), message.mission_type
        current = getattr(message, "current", 0)
        clears = message.get_msgId() == dialect.MAVLINK_MSG_ID_MISSION_CLEAR_ALL
        if kind == 0 and current in (GO_THERE, CHANGE_HEIGHT):
            done = self._go(received(message), current == GO_THERE)
            acknowledge(send, source, Answer.ACCEPTED if done else Answer.ERROR, kind)
        elif clears and kind == EVERY_PLAN:
            results = [transfer.cleared() for transfer in self._transfers.values()]
            acknowledge(send, source, max(results), kind)
        elif kind not in self._transfers:
            acknowledge(send, source, Answer.UNSUPPORTED, kind)
        else:
            ROUTES[message.get_msgId()](self._transfers[kind], message, send, now_s)

    def forget(self) -> None:
        """A reboot: whoever was uploading begins again."""
        for transfer in self._transfers.values():
            transfer.forget()

    def watch(self, now_s: float) -> None:
        for transfer in self._transfers.values():
            transfer.watch(now_s)
