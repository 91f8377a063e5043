"""One request on its way: sent, sent again while unanswered, closed by an answer or by silence."""

from __future__ import annotations

from enum import Enum

from swarm_agent.autopilot.cockpit import Cockpit
from swarm_agent.autopilot.requests import Answer, Request

RESEND_S = 0.5
SENDINGS = 5
PROGRESS_S = 5.0  # a vehicle that said "in progress" may be silent for so long


class Outcome(Enum):
    """How a request stands."""

    OPEN = "open"
    ACCEPTED = "accepted"
    REFUSED = "refused"
    UNSUPPORTED = "not supported"
    SILENCE = "no answer"


OUTCOMES = {
    Answer.ACCEPTED: Outcome.ACCEPTED,
    Answer.REFUSED: Outcome.REFUSED,
    Answer.UNSUPPORTED: Outcome.UNSUPPORTED,
}


class Transaction:
    """Send `request` until it is answered: every 0.5 s, 5 times; an "in progress" buys 5 s without sending."""

    def __init__(self, request: Request) -> None:
        self._request = request
        self._sendings = 0
        self._due_s = float("-inf")

    def tick(self, cockpit: Cockpit, now_s: float) -> Outcome:
        """Read this tick's replies, then send if it is time; the outcome so far."""
        if self._sendings:
            for reply in cockpit.replies:
                answer = self._request.answer_in(reply)
                if answer is Answer.IN_PROGRESS:
                    self._due_s = now_s + PROGRESS_S
                elif answer is not None:
                    return OUTCOMES[answer]
        if now_s < self._due_s:
            return Outcome.OPEN
        if self._sendings == SENDINGS:
            return Outcome.SILENCE
        cockpit.send(self._request.message(system_id=cockpit.target, repeat=self._sendings))
        self._sendings += 1
        self._due_s = now_s + RESEND_S
        return Outcome.OPEN
