"""`simkit new pack`: a pack outside the repository brings a sensor, a plugin, a command, a code and a world."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from simkit.cli import app

USES = """
import sys, simkit
from simkit import packs
from simkit.plugins.discovery.find_plugin_class import plugin_kinds
from simkit.sensors import sensor_kinds

assert "imu" in sensor_kinds() and "diffdrive" not in plugin_kinds()
assert "simkit_fleet" not in sys.modules, "a look-up of another name imported the pack"
assert "fleet_monitor" in plugin_kinds() and "simkit_fleet.sensors.thermometer" not in sys.modules
assert not packs.is_shipped(plugin_kinds()["fleet_monitor"])
(pack,) = packs.foreign_packs()
assert (pack.name, pack.package) == ("fleet", "simkit_fleet")
"""


def new_pack(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["new", "pack", *map(str, arguments)])


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A new pack `fleet`, with the metadata that pip would write beside it."""
    folder = tmp_path_factory.mktemp("packs") / "fleet"
    done = new_pack("fleet", "--folder", folder)
    assert done.exit_code == 0 and str(folder / "simkit_fleet" / "cli" / "fleet.py") in done.stdout.splitlines()
    project = tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    info = folder / "simkit_fleet-0.1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: 0.1.0\n")
    ((group, points),) = project["entry-points"].items()
    lines = [f"[{group}]", *(f"{name} = {value}" for name, value in points.items())]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n")
    return folder


def environment(installed: Path) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(installed), "COLUMNS": "200"}


def python(installed: Path, *arguments: str) -> str:
    command = [sys.executable, *arguments]
    done = subprocess.run(command, env=environment(installed), cwd=installed, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.slow
def test_the_tests_of_a_new_pack_pass(installed: Path) -> None:
    """They use its world, sensor, plugin, command and code."""
    assert "4 passed" in python(installed, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests")


def test_a_pack_is_imported_only_for_its_own_names(installed: Path) -> None:
    python(installed, "-c", USES)


def test_the_bits_and_the_code_hash_of_simkit_do_not_depend_on_a_pack_of_others(installed: Path) -> None:
    program = "from simkit.testing.run_record.fingerprint import code_hash; print(code_hash())"
    assert python(installed, "-c", program) == python(installed.parent, "-c", program)


def test_the_name_of_an_installed_pack_is_refused(installed: Path) -> None:
    command = [sys.executable, "-m", "simkit", "new", "pack", "fleet", "--folder", "other"]
    done = subprocess.run(command, env=environment(installed), cwd=installed, capture_output=True)
    assert done.returncode == 2 and b"SK-PLUGIN-077 there is a pack or module 'fleet' already" in done.stderr


def test_a_pack_is_not_written_over_another(installed: Path) -> None:
    done = new_pack("fleet", "--folder", installed)
    assert done.exit_code == 2 and "SK-PLUGIN-074 already exists" in done.stderr
    assert new_pack("fleet", "--folder", installed, "--force").exit_code == 0


@pytest.mark.parametrize(
    ("name", "owner"),
    [
        ("run", "the command `simkit run`"),
        ("new", "the command `simkit new`"),
        ("plugin", "the command `simkit plugin` and the codes SK-PLUGIN-NNN"),
        ("sdf", "the codes SK-SDF-NNN"),
        ("empty", "a world or model 'empty'"),
        ("simkit", "'simkit' of Python or simkit"),
        ("print", "'print' of Python or simkit"),
    ],
)
def test_a_name_of_simkit_is_refused_with_its_owner(name: str, owner: str, tmp_path: Path) -> None:
    done = new_pack(name, "--folder", tmp_path / "new")
    text = f"SK-PLUGIN-077 a pack cannot have the name {name!r}: there is {owner} already"
    assert done.exit_code == 2 and text in done.stderr and f"such as {name}_tools" in done.stderr
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("name", ["Fleet", "my-fleet", "2fleets", "class", "json"])
def test_a_name_that_python_uses_or_cannot_use_is_refused(name: str, tmp_path: Path) -> None:
    done = new_pack(name, "--folder", tmp_path / "new")
    assert done.exit_code == 2 and "SK-PLUGIN-077" in done.stderr
    assert not (tmp_path / "new").exists()
