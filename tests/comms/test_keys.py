"""Every key names whom it is for, and no two are the same."""

from __future__ import annotations

import pytest

from comms.keys import WORLD, Keys, crew_size, sender, somebody


def test_a_key_of_somebody_is_read_back() -> None:
    keys = Keys("tour")
    for uid in (0, 7, 249):
        for key in (keys.tx(uid), keys.rx(uid), keys.alive(uid), keys.cue(uid), keys.done(uid)):
            assert sender(key) == uid
    assert sender(keys.alive(WORLD)) is sender(keys.truth) is None


def test_a_crew_is_counted_and_is_nobody() -> None:
    keys = Keys("tour")
    found = somebody(keys.crew(250))
    assert found is not None
    assert crew_size(found[1]) == 250
    assert sender(keys.crew(250)) is None
    assert [crew_size(who) for who in (WORLD, "7", "crew", "crewx", "crew999999")] == [None] * 5


def test_no_two_keys_are_the_same() -> None:
    keys = Keys("tour")
    mine = [keys.tx(1), keys.rx(1), keys.alive(1), keys.cue(1), keys.done(1), keys.command(1, "land")]
    shared = [keys.alive(WORLD), keys.recorder(1), keys.recorder(2), keys.truth, keys.kept]
    assert len({*mine, *shared}) == len(mine) + len(shared)


@pytest.mark.parametrize("name", ["", "a/b", "a*", "$x", "-a", "a" * 65])
def test_a_mission_that_is_no_chunk_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match="not usable in a key"):
        Keys(name)
