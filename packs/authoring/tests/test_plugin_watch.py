"""`simkit run --watch`: an edited plugin is reloaded, and the run goes on from where it is.

Nobody edits files at a given simulated time but the plugins themselves; so these do.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

import simkit
from simkit.cli import app
from simkit_authoring.plugin_reload import PluginReloader

WORLD = """<sdf version="1.9"><world name="w"><model name="arm">
  <link name="base"/><link name="lever"><pose>0 0 1 0 0 0</pose></link>
  <joint name="fixed" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="turn" type="revolute"><parent>base</parent><child>lever</child><axis><xyz>0 0 1</xyz></axis></joint>
  <plugin name="turner" filename="libturner.so"><speed>1</speed></plugin>
</model></world></sdf>
"""
TURNER = """
from simkit import ModelPlugin, msgs

STEP = 1


class Turner(ModelPlugin):
    filenames = ("libturner.so",)
    after_step_rate = 100.0

    def prepare(self, scene, params, builder):
        self.servo = builder.add_velocity_servo("arm::turn", max_effort=50.0, owner=self.name)

    def load(self, model, params):
        self.speed = params.number("speed", 0.0)
        self.gain = self.declare("gain", 2.0)
        self.count = 0
        self.told = self.advertise("count", "std_msgs/msg/Int32")
        self.listen("set", "std_msgs/msg/Int32", self.on_set)
        self.heard = 0
        self.subscribe("/clock", self.on_clock)
        self.offer("zero", "std_srvs/srv/Empty", self.on_zero)

    def on_set(self, message):
        self.count = int(message.data)

    def on_clock(self, message):
        self.heard += 1

    def on_zero(self, request):
        self.count = 0

    def before_step(self):
        self.sim.engine.set_control(self.servo, self.speed)

    def after_step(self):
        self.count += STEP
        self.told.publish(msgs.make("std_msgs/msg/Int32", data=self.count))

    def close(self):
        pass
"""


class Edited:
    """A running world whose plugin's file is edited."""

    def __init__(self, folder: Path) -> None:
        self.file = folder / "turner.py"
        self.file.write_text(TURNER)
        (folder / "world.sdf").write_text(WORLD)
        self.sim = simkit.load(folder / "world.sdf", plugin_paths=[folder])
        self.said: list[str] = []
        self.reloader = PluginReloader(self.sim, [folder], self.said.append)
        self.told = self.sim.subscribe("count")

    def edit(self, *changes: tuple[str, str]) -> bool:
        text = self.file.read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        self.file.write_text(text)
        return self.reloader.poll()

    @property
    def plugin(self) -> Any:
        return self.sim.contents.plugins["arm::turner"]

    def state(self) -> str:
        data = self.sim.mj_data
        return hashlib.sha256(data.qpos.tobytes() + data.qvel.tobytes() + data.act.tobytes()).hexdigest()


@pytest.fixture
def edited(tmp_path: Path) -> Iterator[Edited]:
    found = Edited(tmp_path)
    yield found
    found.sim.close()


def test_new_code_is_at_work_from_the_next_step_and_the_world_stays_as_it_is(edited: Edited) -> None:
    edited.sim.run(0.1)
    before, old = edited.state(), edited.plugin
    assert edited.edit(("STEP = 1", "STEP = 100"))
    assert (edited.state(), edited.sim.time) == (before, 0.1)
    assert edited.plugin is not old
    edited.sim.run(0.02)
    assert edited.told.latest.data == 10 + 200, "the count went over, the step is the new one"
    assert edited.said == ["turner.py: 'turner' reloaded at 0.1 s"]


def test_a_run_that_is_watched_but_not_edited_is_the_same_bit_for_bit(edited: Edited, tmp_path: Path) -> None:
    for _ in range(20):
        edited.sim.run(0.01)
        assert not edited.reloader.poll()
    with simkit.load(tmp_path / "world.sdf", plugin_paths=[tmp_path]) as other:
        other.run(0.2)
        assert (other.mj_data.qpos == edited.sim.mj_data.qpos).all()
        assert (other.mj_data.qvel == edited.sim.mj_data.qvel).all()


def test_an_edit_that_changes_nothing_leaves_the_run_as_it_would_be(edited: Edited, tmp_path: Path) -> None:
    edited.sim.run(0.1)
    assert edited.edit(("import ModelPlugin, msgs", "import ModelPlugin, msgs  # the same"))
    edited.sim.run(0.1)
    with simkit.load(tmp_path / "world.sdf", plugin_paths=[tmp_path]) as other:
        told = other.subscribe("count")
        other.run(0.2)
        assert told.latest.data == edited.told.latest.data == 20
        assert (other.mj_data.qpos == edited.sim.mj_data.qpos).all()


def test_a_reload_keeps_the_state_of_the_run_and_renews_the_values_of_load(edited: Edited) -> None:
    edited.sim.run(0.1)
    edited.sim.set_parameter("/turner", "gain", 5.0)
    assert edited.edit(
        ('"speed", 0.0)', '"speed", 0.0) * 3'), ("self.count = 0\n        self.told", "self.count = 7; self.told")
    )
    assert edited.plugin.speed == 3.0
    assert edited.plugin.count == 10
    assert edited.plugin.gain.value == 5.0
    edited.sim.run(0.2)
    assert edited.sim.joint("arm::turn").velocity == pytest.approx(3.0, abs=0.05)


def test_topics_and_services_are_the_new_plugins_own(edited: Edited) -> None:
    edited.sim.run(0.05)
    changes = (("int(message.data)", "10 * int(message.data)"), ('"zero"', '"null"'))
    assert edited.edit(*changes)
    edited.sim.publish("set", {"data": 4})
    edited.sim.run(0.01)
    assert edited.told.latest.data == 41, "one listener, the new one"
    services = [
        name for name, kind in edited.sim.communication.services.names().items() if kind == "std_srvs/srv/Empty"
    ]
    assert "/null" in services and "/zero" not in services


def test_a_subscription_of_the_old_plugin_hears_no_more(edited: Edited) -> None:
    edited.sim.run(0.1)
    old, heard = edited.plugin, edited.plugin.heard
    assert edited.edit(("self.heard += 1", "self.heard += 1000"))
    edited.sim.run(0.1)
    assert old.heard == heard
    assert edited.plugin.heard == heard + 10 * 1000


def test_a_reset_goes_back_to_what_the_new_load_made(edited: Edited) -> None:
    edited.sim.run(0.1)
    edited.edit(("self.count = 0\n        self.told", "self.count = 500\n        self.told"))
    edited.sim.reset()
    assert (edited.plugin.count, edited.plugin.gain.value) == (500, 2.0)
    edited.sim.run(0.02)
    assert edited.told.latest.data == 502


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("STEP = 1\n", "STEP = = 1\n", "turner.py:4: error SK-PLUGIN-071: "),
        ("STEP = 1\n", "STEP = 1 / 0\n", "turner.py:4: error SK-PLUGIN-071: ZeroDivisionError"),
        ("self.count = 0\n        self.told", "self.count = 1 / 0; self.told", "turner.py:17: error: SK-PLUGIN-004"),
        ("libturner", "libturned", "SK-PLUGIN-076: 'turner' is no longer in"),
        ("max_effort=50.0", "max_effort=60.0", "SK-PLUGIN-075 'turner' drives 'arm::turn' by velocity with at most 60"),
        ("0.0)\n        self.gain", "0.0, minimum=2); self.gain", "SK-PARAM-002"),
    ],
)
def test_an_invalid_edit_is_reported_and_the_old_code_continues(edited: Edited, old: str, new: str, said: str) -> None:
    edited.sim.run(0.1)
    before, plugin = edited.state(), edited.plugin
    assert not edited.edit((old, new))
    assert said in "\n".join(edited.said)
    assert edited.plugin is plugin and edited.state() == before
    edited.sim.run(0.1)
    assert edited.told.latest.data == 20
    assert edited.edit((new, old.replace("STEP = 1", "STEP = 2"))), "mended, it is taken"
    edited.sim.publish("set", {"data": 1})
    edited.sim.run(0.01)
    assert edited.told.latest.data in (2, 3)


def test_a_parameter_that_the_new_code_does_not_read_is_reported(edited: Edited) -> None:
    assert edited.edit(('"speed", 0.0', '"spede", 0.0'))
    assert "<speed> is not used" in "\n".join(edited.said) and "spede" in "\n".join(edited.said)


def test_a_file_that_is_being_replaced_is_waited_for(edited: Edited) -> None:
    text = edited.file.read_text()
    edited.file.unlink()
    assert not edited.reloader.poll() and not edited.said
    edited.file.write_text(text)
    assert not edited.reloader.poll(), "it is the same as before"


def test_a_file_that_is_emptied_before_it_is_written_is_reloaded_once(edited: Edited) -> None:
    text = edited.file.read_text()
    edited.file.write_text("")
    assert not edited.reloader.poll() and not edited.said
    edited.file.write_text(text.replace("STEP = 1", "STEP = 2"))
    assert edited.reloader.poll()
    assert not edited.reloader.poll()
    assert len(edited.said) == 1


GZ_CLASS = """
class Ticker:
    def configure(self, entity, sdf, ecm, event_manager):
        self.count = 0

    def post_update(self, info, ecm):
        self.count += 1
"""
GZ_MODULE = """
STEP = 1
count = 0


def post_update(info, ecm):
    global count
    count += STEP
"""


@pytest.mark.needs_packs
@pytest.mark.parametrize(("text", "old", "new"), [(GZ_CLASS, "+= 1", "+= 10"), (GZ_MODULE, "STEP = 1", "STEP = 10")])
def test_systems_of_gz_are_reloaded_as_well(tmp_path: Path, text: str, old: str, new: str) -> None:
    (tmp_path / "ticker.py").write_text(text)
    world = '<sdf version="1.9"><world name="w"><plugin name="t" filename="ticker.py"/></world></sdf>'
    with simkit.load(world, plugin_paths=[tmp_path]) as sim:
        said: list[str] = []
        reloader = PluginReloader(sim, [tmp_path], said.append)
        assert [path.name for path in reloader.files] == ["ticker.py"]
        sim.step(10)
        (tmp_path / "ticker.py").write_text(text.replace(old, new))
        assert reloader.poll(), said
        sim.step(10)
        assert sim.contents.plugins["t"].system.count == 110
        sim.reset()
        sim.step(10)
        assert sim.contents.plugins["t"].system.count == 100


# ---------------------------------------------------------------------- the command

SELF_EDITING = """
from pathlib import Path
from simkit import WorldPlugin

HERE = Path(__file__)


class Count(WorldPlugin):
    filenames = ("libcount.so",)
    after_step_rate = 10.0

    def load(self, world, params):
        self.count = 0

    def after_step(self):
        self.count += 1
        print("count", self.count, "at", self.sim.time_ns // 1000000)
        {edit}
"""
COUNTED = '<sdf version="1.9"><world name="w"><plugin name="count" filename="libcount.so"/></world></sdf>\n'


def run(folder: Path, edit: str, *options: str) -> Result:
    (folder / "world.sdf").write_text(COUNTED)
    (folder / "count.py").write_text(SELF_EDITING.format(edit=edit))
    arguments = ["run", str(folder / "world.sdf"), "--plugin-path", str(folder), "--duration", "1", *options]
    return CliRunner().invoke(app, arguments, catch_exceptions=False)


def test_the_command_reloads_and_goes_on(tmp_path: Path) -> None:
    result = run(tmp_path, 'HERE.write_text(HERE.read_text().replace("+= 1\\n", "+= 100\\n"))', "--watch")
    assert result.exit_code == 0
    counts = [int(line.split()[1]) for line in result.stdout.splitlines() if line.startswith("count")]
    assert counts[0] == 1 and len(counts) == 10 and counts[-1] > 100
    assert "watching count.py" in result.stderr and "'count' reloaded at " in result.stderr


def test_without_the_option_nothing_is_reloaded(tmp_path: Path) -> None:
    result = run(tmp_path, 'HERE.write_text(HERE.read_text().replace("+= 1\\n", "+= 100\\n"))')
    assert "count 10 at 1000" in result.stdout and "reloaded" not in result.stderr


def test_after_an_error_the_run_continues_from_before_it_once_the_plugin_is_corrected(tmp_path: Path) -> None:
    mended = 'HERE.write_text(HERE.read_text().replace("raise ValueError", "ValueError"))'
    result = run(tmp_path, f'if self.count == 5: {mended}; raise ValueError("the wheel fell off")', "--watch")
    assert result.exit_code == 0
    assert "the wheel fell off" in result.stderr and "for a correction of the plugin" in result.stderr
    counts = [line for line in result.stdout.splitlines() if line.startswith("count")]
    assert counts[-1] == "count 10 at 1000"


def test_an_interrupt_ends_the_waiting_with_the_error_of_the_plugin(tmp_path: Path) -> None:
    # the plugin interrupts the process as Ctrl-C does: once, so that it is the loop that sees it
    stop = "import os, signal; os.kill(os.getpid(), signal.SIGINT)"
    result = run(tmp_path, f'{stop}; raise ValueError("the wheel fell off")', "--watch")
    assert result.exit_code == 4
    assert result.stderr.count("the wheel fell off") >= 1 and "for a correction of the plugin" in result.stderr


def test_a_run_with_a_recording_does_not_wait(tmp_path: Path) -> None:
    options = ("--watch", "--record", str(tmp_path / "run.mcap"))
    result = run(tmp_path, 'raise ValueError("the wheel fell off")', *options)
    assert result.exit_code == 4 and "to be mended" not in result.stderr


def test_a_world_without_watched_plugins_is_reported(tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["run", "empty", "--duration", "0.1", "--watch"])
    assert result.exit_code == 0 and "no plugin of this world is in a folder of yours" in result.stderr
