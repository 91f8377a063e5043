"""How many examples a law is tried on, where the profile's number (`tests/conftest.py`) is too many or too few.

@MANY
@given(scenes)
def test_laws_of_every_decision(scene): ...
"""

from __future__ import annotations

from hypothesis import settings

_USUAL = settings().max_examples

FEW = settings(max_examples=_USUAL // 8)  # each example flies for a while
MANY = settings(max_examples=3 * _USUAL)  # so much can be drawn that a hundred say little
