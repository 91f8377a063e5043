"""When a process is to end: signals and orders, one by one and again."""

from __future__ import annotations

import signal

import pytest

from missions.ending import Ending


def test_a_first_signal_asks_and_a_second_one_ends_at_once() -> None:
    told: list[str] = []
    ending = Ending(told.append)
    with ending.listening():
        ending.ask()  # an order is nobody's haste
        signal.raise_signal(signal.SIGTERM)
        assert ending.asked
        assert len(told) == 1
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGTERM)


def test_signals_count_anew_for_what_begins_when_a_flight_is_over() -> None:
    ending = Ending(lambda text: None)
    with ending.listening():
        signal.raise_signal(signal.SIGTERM)  # ends the flight
        is_asked_again = ending.begin_anew()
        assert not is_asked_again()
        signal.raise_signal(signal.SIGTERM)  # and what comes after it
        assert is_asked_again()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGTERM)


def test_a_second_signal_that_is_ctrl_c_is_the_reason() -> None:
    ending = Ending(lambda text: None)
    with ending.listening():
        signal.raise_signal(signal.SIGTERM)
        assert not ending.interrupted
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert ending.interrupted


@pytest.mark.parametrize("later", [signal.SIGHUP, signal.SIGTERM])
def test_ctrl_c_stays_the_reason_whatever_comes_after_it(later: signal.Signals) -> None:
    ending = Ending(lambda text: None)
    with ending.listening():
        signal.raise_signal(signal.SIGINT)
        if later is signal.SIGTERM:  # else the second signal would be haste
            ending.begin_anew()
        signal.raise_signal(later)
    assert ending.interrupted
