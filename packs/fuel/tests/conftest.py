"""Server of Fuel, an empty working folder, and an empty cache."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from packs.fuel.tests.fuel_server import Fuel, served


@pytest.fixture
def fuel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Fuel]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GZ_FUEL_CACHE_PATH", str(tmp_path / "cache"))
    monkeypatch.delenv("GZ_FUEL_SERVER", raising=False)
    with served() as state:
        yield state
