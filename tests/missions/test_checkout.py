"""Which commit runs."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from missions import checkout


def test_a_checkout_says_its_commit() -> None:
    found = checkout.commit()
    assert found is None or re.fullmatch(r"[0-9a-f]{12,}(-dirty)?", found)


def test_what_is_no_checkout_says_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checkout, "__file__", str(tmp_path / "checkout.py"))
    assert checkout.commit() is None


def test_without_git_it_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    assert checkout.commit() is None
