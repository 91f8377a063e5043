"""Long texts come in pieces that a receiver can put together."""

from __future__ import annotations

import pytest

from vehicle_sim.autopilot.texts import Texts


@pytest.mark.parametrize(("length", "pieces"), [(0, 1), (50, 1), (51, 2), (99, 2), (100, 3), (149, 3)])
def test_pieces_are_the_text_and_the_last_is_shorter_than_a_whole_one(length: int, pieces: int) -> None:
    text = "".join(chr(97 + k % 26) for k in range(length))
    messages = Texts().messages(4, text)
    assert len(messages) == pieces
    assert "".join(message.text for message in messages) == text
    assert [message.chunk_seq for message in messages] == list(range(pieces))
    assert pieces == 1 or len(messages[-1].text) < 50


def test_every_long_text_has_a_number_of_its_own_and_short_ones_have_none() -> None:
    texts = Texts()
    assert [texts.messages(4, text)[0].id for text in ("short", "x" * 60, "y" * 60, "short", "z" * 60)] == [
        0,
        1,
        2,
        0,
        3,
    ]
    assert {message.id for message in texts.messages(4, "x" * 120)} == {4}
