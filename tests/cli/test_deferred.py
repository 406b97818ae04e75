"""Commands are read from their modules only when they are asked for, and nobody sees a difference."""

from __future__ import annotations

import inspect
import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import typer

from simkit.cli import COMMANDS, app
from simkit.packs import shipped_packs

HEAVY = ("mujoco", "numpy", "pydantic", "rich", "rosbags", "scipy", "trimesh", "yaml")
PACKAGES = {
    **dict.fromkeys(COMMANDS, "simkit.cli"),
    **{
        file.stem: f"{pack.package}.cli"
        for pack in shipped_packs()
        for file in sorted(Path(pack.folder, "cli").glob("[a-z]*.py"))
    },
}
"""Package with the module of each command."""
MODULES = [f"{package}.{name}" for name, package in PACKAGES.items()]
SCRIPT = f"""
import sys
from simkit.cli import app
try:
    app(prog_name="simkit")
finally:
    found = [name for name in {HEAVY} if name in sys.modules]
    found += [name.rpartition(".")[2] for name in {MODULES} if name in sys.modules]
    sys.stderr.write(" ".join(found))
"""


@pytest.mark.parametrize("name", PACKAGES)
def test_the_line_beside_a_command_is_the_first_of_its_help(name: str) -> None:
    module = import_module(f"{PACKAGES[name]}.{name}")
    found = getattr(module, name)
    written = found.info.help if isinstance(found, typer.Typer) else inspect.getdoc(found)
    assert str(written).splitlines()[0] == COMMANDS.get(name, str(module.__doc__).splitlines()[0])


@pytest.mark.parametrize("name", PACKAGES)
def test_a_command_is_the_one_of_its_module(name: str) -> None:
    root: Any = typer.main.get_command(app)
    root.list_commands(typer.Context(root))  # adds the commands of packs
    found: Any = getattr(import_module(f"{PACKAGES[name]}.{name}"), name)
    real = root.commands[name].real
    assert real.name == name
    if isinstance(found, typer.Typer):
        commands = [c.name or c.callback.__name__ for c in found.registered_commands if c.callback]
        assert list(real.commands)[: len(commands)] == commands, "commands that other packs add come after them"
    else:
        assert [p.name for p in real.params if p.name != "help"] == list(inspect.signature(found).parameters)


@pytest.mark.parametrize(
    ("line", "read"),
    [
        ("simkit --help", ""),
        ("simkit --version", ""),
        ("simkit run --help", "run"),
        ("simkit topic --help", "topic"),
        ("simkit topic list --help", "topic"),
    ],
)
def test_only_the_module_of_the_command_is_imported(line: str, read: str) -> None:
    assert loaded(line.split()[1:]) == read


@pytest.mark.parametrize(("line", "read"), [("simkit to", ""), ("simkit topic ec", "topic"), ("simkit bag re", "bag")])
def test_completion_reads_only_the_command_that_is_written(line: str, read: str) -> None:
    env = {"_SIMKIT_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(len(line.split()) - 1)}
    assert loaded([], env) == read


def test_a_client_that_lists_topics_imports_nothing_heavy(tmp_path: Any) -> None:
    code = "import sys, simkit.live, simkit_terminal.cli.topic\n"
    code += f"sys.stderr.write(' '.join(name for name in {HEAVY} if name in sys.modules))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert found.stderr == ""


UNUSED = """
OpenGL PIL glfw.library lxml numpy.ma numpy.random pydantic rosbags scipy sqlite3 trimesh xacro yaml
simkit.bridges.live.answering simkit.compiler.meshes.convex_decomposition simkit.loaders.meshes.mesh_reader
simkit.loaders.xacro.expansion simkit_actors simkit_gz_python simkit.recording.bags.mcap_file
simkit.recording.films simkit.recording.pictures simkit.sensors.cameras.rendered_camera simkit.testing.conditions
"""
"""Modules that a run of an empty world does not need; some take 20 ms."""


def test_a_run_without_options_imports_only_what_it_uses(tmp_path: Any) -> None:
    code = f"""
import sys
from simkit.cli import app
try:
    app(["run", "empty", "--duration", "0.01"], prog_name="simkit")
finally:
    found = [name for name in {UNUSED.split()} if name in sys.modules]
    sys.stdout.write(" ".join(["imported:", *found]))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "imported:"


def loaded(words: list[str], env: dict[str, str] | None = None) -> str:
    """Heavy packages and modules of commands that a command line has imported by its end."""
    found = subprocess.run(
        [sys.executable, "-c", SCRIPT, *words],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, **(env or {})},
    )
    return found.stderr
