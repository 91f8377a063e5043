"""What a mission's faults did: when each was noticed, and what was seen before, meanwhile and afterwards."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from missions.coverage import Coverage
from missions.faults.detection import Detection, Detector
from missions.faults.schedule import Spell, spells_of
from missions.faults.words import whom
from missions.mission.faults import AnyFault, LastingFault
from missions.observation import Observation

WINDOW_S = 30.0  # before and after; and meanwhile, for what is over at once or never
PATIENCE_S = 5.0  # a fault that is over may be noticed for so long
_DIGITS = 6


class Costs:
    """An observer of the faults of one mission."""

    def __init__(self, faults: Sequence[AnyFault] = (), *, tick_s: float = 0.1) -> None:
        self._spells = spells = spells_of(faults, tick_s)
        self._tick_s = tick_s
        self._detector = Detector(spells, patience_ticks=round(PATIENCE_S / tick_s))

    def observe(self, observation: Observation) -> None:
        """Look at one tick."""
        self._detector.observe(observation)

    def told(self, coverage: Coverage) -> list[dict[str, Any]]:
        """Every fault in the order of the mission, for the report."""
        pairs = zip(self._spells, self._detector.found, strict=True)
        return [self._of(spell, found, coverage) for spell, found in pairs]

    def _of(self, spell: Spell, found: Detection | None, coverage: Coverage) -> dict[str, Any]:
        fault, window = spell.fault, round(WINDOW_S / self._tick_s)
        lasts = isinstance(fault, LastingFault) and spell.end is not None
        end = spell.end if lasts and spell.end is not None else spell.first + window
        return {
            "kind": fault.kind,
            "what": fault.what,
            "whom": whom(fault),
            "at_s": _rounded(spell.first * self._tick_s),
            "until_s": _rounded(end * self._tick_s) if lasts else None,
            "noticed_after_s": None if found is None else _rounded((found.tick - spell.first) * self._tick_s),
            "noticed_by": None if found is None else found.agent,
            "sign": None if found is None else found.words,
            "coverage": {
                "before": _rounded(coverage.between(spell.first - window, spell.first)),
                "during": _rounded(coverage.between(spell.first, end)),
                "after": _rounded(coverage.between(end, end + window)),
            },
        }


def _rounded(number: float | None) -> float | None:
    return None if number is None else round(number, _DIGITS)
