"""Surroundings of the labs in these tests: English, whatever the environment says, and matplotlib's own style."""

from __future__ import annotations

import sys

import pytest


@pytest.fixture(autouse=True)
def english(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("LC_ALL", raising=False)
    monkeypatch.delenv("LC_MESSAGES", raising=False)
    monkeypatch.setenv("LANG", "C.UTF-8")


@pytest.fixture(autouse=True)
def own_style() -> None:
    """Take back the style that a test before has set for a picture."""
    if "matplotlib" in sys.modules:
        sys.modules["matplotlib"].rcdefaults()
