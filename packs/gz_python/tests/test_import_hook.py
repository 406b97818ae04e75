"""How Gazebo's module names are found, and when they are not."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

import simkit_gz_python as gz_python
from simkit_gz_python import import_hook


@pytest.mark.parametrize(
    ("name", "ours"),
    [
        ("gz", ""),
        ("ignition", ""),
        ("gz.sim", "simkit_gz_python.sim"),
        ("gz.sim10", "simkit_gz_python.sim"),
        ("ignition.gazebo6", "simkit_gz_python.sim"),
        ("gz.math7", "simkit_gz_python.math"),
        ("ignition.math6", "simkit_gz_python.math"),
        ("gz.common5", "simkit_gz_python.common"),
        ("gz.transport13", "simkit_gz_python.transport"),
        ("gz.msgs10.twist_pb2", "simkit_gz_python.msgs.twist_pb2"),
        ("gz.sim8.components", "simkit_gz_python.sim.components"),
        ("sdformat14", "simkit_gz_python.sdformat"),
        ("sdformat", "simkit_gz_python.sdformat"),
        ("gz.rendering8", None),
        ("gzip", None),
        ("gz.math7.helpers", None),
        ("sdformats", None),
    ],
)
def test_every_version_is_one_module_of_simkit(name: str, ours: str | None) -> None:
    assert import_hook.module_behind(name) == ours


def test_the_names_exist_only_within_the_context() -> None:
    with gz_python.importable():
        eight, ten = importlib.import_module("gz.sim8"), importlib.import_module("gz.sim10")
        assert eight.Link is ten.Link
        assert importlib.import_module("gz.sim8.components").Name == eight.components.Name
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("gz.sim8")


def test_install_lasts_until_uninstall() -> None:
    assert gz_python.install() == {}
    try:
        assert importlib.import_module("gz.math7").Vector3d(1, 2, 3).length() > 3
    finally:
        gz_python.uninstall()
    assert "gz.math7" not in sys.modules


def test_a_missing_module_lists_the_existing_ones() -> None:
    with gz_python.importable():
        with pytest.raises(ImportError, match="no Gui; simkit has no user interface"):
            from gz.sim8 import Gui  # type: ignore[import-not-found]  # noqa: F401
        with pytest.raises(ImportError, match=r"no world_entty; did you mean 'world_entity'"):
            from gz.sim8 import world_entty  # noqa: F401
        assert not hasattr(importlib.import_module("gz.sim8"), "Gui")
        with pytest.raises(
            ModuleNotFoundError,
            match=r"simkit has no gz\.msgs\.marker_pb2; supported modules of gz\.msgs: actuators_pb2",
        ):
            importlib.import_module("gz.msgs10.marker_pb2")
        with pytest.raises(ImportError, match="no Root; use simkit.describe"):
            from sdformat14 import Root  # type: ignore[import-not-found]  # noqa: F401


REAL = "NAME = 'the real one'\n\nclass Vector3d: ...\n"


@pytest.fixture
def real_gz(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A `gz` package with a `math7` of its own, installed for all that Python knows."""
    (tmp_path / "gz").mkdir()
    (tmp_path / "gz" / "math7.py").write_text(REAL, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    yield tmp_path  # type: ignore[misc]
    for name in [n for n in sys.modules if n == "gz" or n.startswith("gz.")]:
        del sys.modules[name]
    import_hook._finder.modules.clear()


def test_an_installed_module_has_priority_and_is_reported(real_gz: Path) -> None:
    assert gz_python.installed() == {"gz.math7": str(real_gz / "gz" / "math7.py")}
    with gz_python.importable():
        assert importlib.import_module("gz.math7").NAME == "the real one"
        assert import_hook.is_shim(importlib.import_module("gz.sim8"))  # the rest of the package is ours


def test_with_shadow_simkits_module_has_priority(real_gz: Path) -> None:
    with gz_python.importable(shadow=True):
        assert import_hook.is_shim(importlib.import_module("gz.math7"))


def test_a_world_says_which_installed_module_its_system_got(real_gz: Path, tmp_path: Path) -> None:
    import simkit

    (tmp_path / "systems").mkdir()
    text = "from gz.math7 import Vector3d\n\nclass System:\n    def update(self, info, ecm): ...\n"
    text += "\ndef get_system():\n    return System()\n"
    (tmp_path / "systems" / "user.py").write_text(text, encoding="utf-8")
    world = """<sdf version="1.9"><world name="w">
      <plugin filename="gz-sim-python-system-loader-system" name="gz::sim::systems::PythonSystemLoader">
        <module_name>user</module_name>{}</plugin></world></sdf>"""
    with simkit.load(world.format(""), plugin_paths=[tmp_path / "systems"]) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-083"]
        assert "gz.math7 is installed" in found.message and "shadow_gz" in found.hint


def test_a_system_with_an_installed_gz_sim_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import simkit

    (tmp_path / "real" / "gz").mkdir(parents=True)
    (tmp_path / "real" / "gz" / "sim8.py").write_text("class Model: ...\n", encoding="utf-8")
    (tmp_path / "systems").mkdir()
    text = "from gz.sim8 import Model\n\ndef get_system(): ...\n"
    (tmp_path / "systems" / "user_of_sim.py").write_text(text, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path / "real")
    world = """<sdf version="1.9"><world name="w">
      <plugin filename="gz-sim-python-system-loader-system" name="gz::sim::systems::PythonSystemLoader">
        <module_name>user_of_sim</module_name></plugin></world></sdf>"""
    try:
        with pytest.raises(simkit.LoadError, match=r"SK-PLUGIN-083.*it cannot access a simulation of simkit"):
            simkit.load(world, plugin_paths=[tmp_path / "systems"])
    finally:
        for name in [n for n in sys.modules if n == "gz" or n.startswith("gz.")]:
            del sys.modules[name]


FALLING = "<sdf version='1.6'><world name='w'><model name='falling'><link name='l'/></model></world></sdf>"


def test_a_script_of_gz_sim_runs_after_one_line(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        """
import simkit_gz_python

simkit_gz_python.install()
import time

from gz.common import set_verbosity
from gz.sim8 import TestFixture, World, world_entity
from gz.math7 import Vector3d
from sdformat14 import Element

set_verbosity(1)
fixture = TestFixture(WORLD)
counts = {"pre": 0, "post": 0}


def before(info, ecm):
    counts["pre"] += 1
    if counts["pre"] == 1:
        world = World(world_entity(ecm))
        print("gravity", world.gravity(ecm), "falling", world.model_by_name(ecm, "falling"))


def after(info, ecm):
    counts["post"] += 1
    if info.sim_time.seconds == 1:
        print("after a second", info.sim_time)


fixture.on_post_update(after)
fixture.on_pre_update(before)
fixture.finalize()
server = fixture.server()
server.run(False, 1000, False)
while server.is_running():
    time.sleep(0.1)
print(counts)
""".replace("WORLD", repr(FALLING)),
        encoding="utf-8",
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=120, check=False)
    assert done.stderr == ""
    assert done.stdout.splitlines() == [
        "gravity 0 0 -9.8 falling 4",
        "after a second 0:00:01",
        "{'pre': 1000, 'post': 1000}",
    ]
