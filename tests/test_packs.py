"""Packs: what belongs to simkit, and what a pack of somebody else may not replace."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

import simkit
from simkit.cli.diagnostic_catalogue import catalogue
from simkit.loaders.resources.bundled_models import bundled_folders, find_bundled_world
from simkit.msgs.shipped_interfaces import definition_files
from simkit.packs import installed_packs, is_shipped, is_shipped_file, is_shipped_module, shipped_folders, shipped_packs
from simkit.plugins.discovery.find_plugin_class import plugin_kinds
from simkit.testing.run_record import fingerprint

CORE = Path(simkit.__file__).parent
IN_PACKS = [(pack, file) for pack in shipped_packs() for file in sorted(Path(pack.folder).rglob("*.py"))]


def test_classes_of_the_core_and_of_packs_are_shipped() -> None:
    assert is_shipped(simkit.Simulation)
    assert all(is_shipped(cls) for cls in plugin_kinds().values() if cls.__module__.split(".")[0].startswith("simkit"))
    assert {cls.__module__.split(".")[0] for cls in plugin_kinds().values()} >= {p.package for p in shipped_packs()}


@pytest.mark.parametrize(
    "module", ["simkit_user_plugins.brake", "simkit_fleet.plugins.monitor", "builtins", "simkits", ""]
)
def test_modules_of_others_are_not_shipped(module: str) -> None:
    assert not is_shipped_module(module)


def test_the_hash_of_the_code_covers_core_and_packs(monkeypatch: pytest.MonkeyPatch) -> None:
    assert shipped_folders() == (CORE, *(Path(pack.folder) for pack in shipped_packs()))
    whole = fingerprint.code_hash()
    monkeypatch.setattr(fingerprint, "shipped_folders", lambda: (CORE,))
    assert bool(shipped_packs()) == (fingerprint.code_hash.__wrapped__() != whole)


def test_files_of_core_and_packs_are_told_from_those_of_others(tmp_path: Path) -> None:
    assert is_shipped_file(str(CORE / "build.py")) and all(is_shipped_file(str(file)) for _, file in IN_PACKS)
    assert not is_shipped_file(str(tmp_path / "plugin.py")) and not is_shipped_file(f"{CORE}_x/build.py")


def test_the_worlds_models_types_and_codes_of_packs_are_found_by_name() -> None:
    for pack in installed_packs():
        folder = Path(pack.folder)
        for world in folder.glob("worlds/*.sdf"):
            assert find_bundled_world(world.stem) == world
        if (folder / "assets").is_dir():
            assert folder / "assets" in bundled_folders("assets")
        files = set(definition_files().values())
        assert {str(path) for path in folder.glob("msgs/definitions/*/*/*.*")} <= files
        for area in folder.glob("cli/diagnostic_codes/*.toml"):
            assert catalogue(f"SK-{area.stem.upper()}-")


def test_a_class_without_a_module_is_not_shipped() -> None:
    assert not is_shipped(type(SimpleNamespace()))
