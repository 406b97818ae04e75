"""Packs: what belongs to simkit, and what a pack of somebody else may not replace."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
import typer

import simkit
from simkit import registry
from simkit.cli import app
from simkit.cli.diagnostic_catalogue import catalogue
from simkit.loaders.resources.bundled_models import bundled_folders, find_bundled_world
from simkit.msgs.shipped_interfaces import definition_files
from simkit.packs import (
    Pack,
    installed_packs,
    is_shipped,
    is_shipped_file,
    is_shipped_module,
    shipped_folders,
    shipped_packs,
)
from simkit.plugins import adapters
from simkit.plugins.discovery import find_plugin_class, make_instances
from simkit.plugins.discovery.find_plugin_class import plugin_kinds
from simkit.sensors import sensor_kinds
from simkit.testing.run_record import fingerprint

CORE = Path(simkit.__file__).parent
IN_PACKS = [(pack, file) for pack in shipped_packs() for file in sorted(Path(pack.folder).rglob("*.py"))]


def test_classes_of_the_core_and_of_packs_are_shipped() -> None:
    assert is_shipped(simkit.Simulation)
    assert all(is_shipped(cls) for cls in plugin_kinds().values() if cls.__module__.split(".")[0].startswith("simkit"))
    with_plugins = {pack.package for pack in shipped_packs() if Path(pack.folder, "plugins").is_dir()}
    assert {cls.__module__.split(".")[0] for cls in plugin_kinds().values()} >= with_plugins


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


LEFT_OUT = {
    "filenames": {"libslotcar.so": "open_rmf", "gz-sim-python-system-loader-system": "gz_python"},
    "names": {},
    "entities": {"actors": "actors"},
    "hooks": {"pre_update": "gz_python"},
    "factories": {"get_system": "gz_python"},
    "kinds": {"thermal_camera": "special_cameras"},
}


@pytest.fixture
def core_alone(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A core that was built without packs: as in a wheel of `SIMKIT_PACKS=none`, which has the names in a file."""
    kinds = plugin_kinds, sensor_kinds, adapters._entity_kinds, adapters._system_kinds

    def left_out_names(*attributes: str) -> dict[str, str]:
        return {name: pack for attribute in attributes for name, pack in LEFT_OUT[attribute].items()}

    monkeypatch.setattr(registry, "shipped_packs", tuple)
    for module in (adapters, find_plugin_class, make_instances):
        monkeypatch.setattr(module, "left_out_names", left_out_names)
    for table in kinds:
        table.cache_clear()
    yield
    for table in kinds:
        table.cache_clear()


@pytest.mark.usefixtures("core_alone")
def test_a_world_that_needs_a_missing_pack_gets_its_name_and_the_way_to_install_it() -> None:
    world = """<sdf version="1.9"><world name="w"><actor name="anna"/>
      <plugin filename="libslotcar.so" name="car"/>
      <plugin filename="libgz-sim8-python-system-loader-system.so" name="loader"/></world></sdf>"""
    with simkit.load(world) as sim:
        reported = [(d.code, d.severity, d.message.split("; ")[0]) for d in sim.diagnostics]
        assert "anna" not in sim.models
        assert all(d.hint.startswith("install simkit with its packs: pip install") for d in sim.diagnostics)
    assert reported == [
        ("SK-PLUGIN-001", "warning", f"{who} needs the pack {pack}, which is not installed")
        for who, pack in (
            ("the simulation of actors", "actors"),
            ("plugin 'libslotcar.so' (name 'car')", "open_rmf"),
            ("plugin 'libgz-sim8-python-system-loader-system.so' (name 'loader')", "gz_python"),
        )
    ]


@pytest.mark.usefixtures("core_alone")
def test_a_sensor_of_a_missing_pack_gets_its_name() -> None:
    world = """<sdf version="1.9"><world name="w"><model name="m"><link name="l">
      <sensor name="heat" type="thermal_camera"/></link></model></world></sdf>"""
    with simkit.load(world) as sim:
        warnings = [(d.code, d.message, d.hint) for d in sim.diagnostics if d.severity == "warning"]
    needs = "sensor 'm::l::heat': kind 'thermal_camera' needs the pack special_cameras, which is not installed"
    assert [(code, message) for code, message, _ in warnings] == [("SK-SENSOR-001", needs)]
    assert warnings[0][2].startswith("install simkit with its packs: pip install")


@pytest.mark.usefixtures("core_alone")
def test_an_object_with_hooks_of_a_missing_pack_gets_its_name(tmp_path: Path) -> None:
    class Lift:
        def pre_update(self, info: object, ecm: object) -> None:
            pass

    needs = "pre_update needs the pack gz_python, which is not installed: install simkit with its packs"
    with pytest.raises(simkit.LoadError, match=f"SK-PLUGIN-022(.|\n)*help: {needs}"):
        simkit.load("<sdf version='1.9'><world name='w'/></sdf>", plugins=[Lift()])
    (tmp_path / "lift.py").write_text("class Lift:\n    def pre_update(self, info, ecm):\n        pass\n")
    for name in ("lift.py", "lift.py:Lift"):
        world = f"<sdf version='1.9'><world name='w'><plugin filename='{name}' name='p'/></world></sdf>"
        with pytest.raises(simkit.LoadError, match=f"SK-PLUGIN-008(.|\n)*help: {needs}"):
            simkit.load(world, plugin_paths=[tmp_path])


def test_a_command_of_a_missing_pack_gets_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("simkit.packs.left_out_names", lambda kind: {"harbour": "boats"} if kind == "commands" else {})
    with pytest.raises(simkit.InputError, match="SK-INPUT-004 simkit harbour needs the pack boats, which is not inst"):
        typer.main.get_command(app)(["harbour"])


def test_a_command_of_a_pack_is_listed_after_the_one_that_it_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "cli").mkdir()
    for name, before in (("buoy", "check"), ("anchor", "buoy"), ("canal", "nothing")):
        (tmp_path / "cli" / f"{name}.py").write_text(f'"""Do it."""\n\nLISTED_AFTER = "{before}"\n')
    boats = Pack("boats", "simkit_boats", str(tmp_path), is_shipped=False)
    monkeypatch.setattr("simkit.packs.installed_packs", lambda: (boats,))
    root = typer.main.get_command(app)
    names = root.list_commands(typer.Context(root))
    first = names.index("check")
    assert names[first : first + 3] == ["check", "buoy", "anchor"] and names[-1] == "canal"


@pytest.mark.needs_packs
def test_a_pack_adds_commands_to_a_group_of_another_pack(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "simkit_groups_of_boats" / "cli" / "groups"
    folder.mkdir(parents=True)
    text = "import typer\n\nnode = typer.Typer()\n\n@node.command()\ndef sink() -> None: pass\n"
    (folder / "node.py").write_text(text)
    boats = Pack("boats", "simkit_groups_of_boats", str(tmp_path / "simkit_groups_of_boats"), is_shipped=False)
    monkeypatch.syspath_prepend(tmp_path)
    packs = installed_packs()
    monkeypatch.setattr("simkit.packs.installed_packs", lambda: (*packs, boats))
    command = typer.main.get_command(app)
    node = command.get_command(typer.Context(command), "node").real
    assert {"list", "info", "sink"} <= node.commands.keys()


def test_a_class_without_a_module_is_not_shipped() -> None:
    assert not is_shipped(type(SimpleNamespace()))
