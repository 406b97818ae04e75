"""Fixtures that load small inline texts."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from simkit.compiler.mjcf_parser import MjcfParser
from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.loaders import Resolver, load_scene
from simkit.scene import Scene

sys.path.insert(0, str(Path(__file__).parent))

Load = Callable[..., tuple[Scene, list[Diagnostic]]]


@pytest.fixture
def load() -> Load:
    """Return a function load(source, paths=()) that returns the scene and its diagnostics."""

    def _load(source: str | Path, paths: tuple[Path, ...] = (), **options: object) -> tuple[Scene, list[Diagnostic]]:
        diagnostics = Diagnostics()
        scene = load_scene(source, resolver=Resolver(paths), diagnostics=diagnostics, mjcf_parser=MjcfParser, **options)  # type: ignore[arg-type]
        return scene, list(diagnostics)

    return _load


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str, str], Path]:
    """Return a function write("folder/file.sdf", text) that writes a file under a folder of this test."""

    def _write(name: str, text: str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    return _write
