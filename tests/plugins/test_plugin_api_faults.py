"""Plugins that raise: the run stops with the name of the plugin, or continues without the plugin."""

from __future__ import annotations

import io
import math
import re
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from plugin_worlds import GROUND, rover, world

import simkit
from simkit import Params, WorldPlugin
from simkit.runtime import Simulation

BALL = """<model name="ball"><pose>0 0 1 0 0 0</pose><link name="l"><inertial><mass>2</mass></inertial>
<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model>"""
FLOATING = f"<gravity>0 0 0</gravity>{BALL}"


class Pusher(WorldPlugin):
    """Pushes the ball with 2 N until it raises at `last` [s]; publishes, offers and acts meanwhile."""

    def __init__(self, last: float = 0.5, on_error: Any = "disable") -> None:
        self.last, self.on_error = last, on_error

    def load(self, parent: Simulation, params: Params) -> None:
        self.ball = parent.link("ball::l")
        self.pushes = self.advertise("pushes", "std_msgs/msg/Float64")
        self.listen("more", "std_msgs/msg/Float64", self.take)
        self.offer("again", "std_srvs/srv/Trigger", self.answer)
        self.act("go", "example_interfaces/action/Fibonacci", lambda goal: None)
        self.gain = self.declare("gain", 1.0)

    def take(self, message: Any) -> None:
        if message.data < 0:
            raise ValueError("less than nothing")

    def answer(self, _request: Any) -> Any:
        raise KeyError("no answer")

    def before_step(self) -> None:
        if self.sim.time > self.last - 1e-9:
            raise RuntimeError("out of breath")
        self.ball.apply_wrench((2.0, 0.0, 0.0))
        self.pushes.publish(simkit.msgs.make("std_msgs/msg/Float64", data=1.0))


def velocity(sim: Simulation) -> float:
    return float(sim.link("ball::l").linear_velocity[0])


def bits(sim: Simulation) -> bytes:
    return bytes(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())


def warnings(sim: Simulation) -> list[str]:
    return [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-020"]


def test_a_disabled_plugin_pushes_no_more_and_the_run_continues() -> None:
    with simkit.load(world(FLOATING), plugins=[Pusher()]) as sim:
        sim.run(2.0)
        assert sim.time == pytest.approx(2.0)
        assert velocity(sim) == pytest.approx(2.0 / 2.0 * 0.5, rel=1e-9)  # F t / m


def test_the_warning_names_plugin_hook_time_and_the_last_line_of_the_traceback() -> None:
    with simkit.load(world(FLOATING), plugins=[Pusher(0.25)]) as sim:
        sim.run(1.0)
        found = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-020"]
    assert len(found) == 1
    assert found[0].message == (
        "plugin 'Pusher' raised in before_step at t=0.25 s and is disabled from then on: RuntimeError: out of breath"
    )
    assert "test_plugin_api_faults.py" in found[0].hint and found[0].hint.endswith("in before_step")


def test_a_disabled_plugin_loses_its_topics_services_actions_and_parameters() -> None:
    with simkit.load(world(FLOATING), plugins=[Pusher(0.1)]) as sim:
        assert (
            "/pushes" in sim.topics()
            and "/again" in sim.communication.services.names()
            and "/go" in sim.communication.actions.names()
        )
        assert any("gain" in names for names in sim.communication.parameters.values())
        goal = sim.send_goal("/go", {"order": 3})
        sim.step()
        assert goal.is_active
        sim.run(0.3)
        assert goal.status.name == "ABORTED" and "out of breath" in goal.reason
        assert not {"/pushes", "/more"} & set(sim.topics())
        assert "/again" not in sim.communication.services.names() and "/go" not in sim.communication.actions.names()
        assert not any("gain" in names for names in sim.communication.parameters.values())


def test_the_state_equals_that_of_a_run_whose_plugin_does_nothing_from_then_on() -> None:
    class Silent(Pusher):
        def before_step(self) -> None:
            if self.sim.time < self.last - 1e-9:
                super().before_step()

    ends = []
    for plugin in (Pusher(0.123), Silent(0.123)):
        with simkit.load(world(GROUND, BALL, rover()), plugins=[plugin]) as sim:
            sim.run(1.0)
            ends.append(bits(sim))
    assert ends[0] == ends[1]


def test_without_on_error_the_run_stops() -> None:
    with simkit.load(world(FLOATING), plugins=[Pusher(0.1, None)]) as sim:
        with pytest.raises(simkit.PluginError, match="out of breath") as caught:
            sim.run(1.0)
        assert caught.value.exit_code == 4
        assert caught.value.time == pytest.approx(0.1)


def test_reset_and_restore_enable_the_plugin_again() -> None:
    with simkit.load(world(FLOATING), plugins=[Pusher(0.1)]) as sim:
        sim.run(0.05)
        before = sim.snapshot()
        sim.run(0.2)
        after, speed = sim.snapshot(), velocity(sim)
        for reset in (False, True):
            if reset:
                sim.reset()
            else:
                sim.restore(before)
            assert "/pushes" in sim.topics()
            sim.run(0.25 - sim.time)
            assert velocity(sim) == pytest.approx(speed) and "/pushes" not in sim.topics()
        sim.reset()
        sim.restore(after)
        assert "/pushes" not in sim.topics()
        sim.run(0.1)
        assert velocity(sim) == pytest.approx(speed)


@pytest.mark.parametrize("what", ["topic", "service", "parameter"])
def test_exceptions_in_callbacks_are_handled_like_those_in_hooks(what: str) -> None:
    class Touchy(Pusher):
        def load(self, parent: Simulation, params: Params) -> None:
            super().load(parent, params)
            self.limit = self.declare("limit", 1.0, on_change=self.changed)

        def changed(self, value: float) -> None:
            raise OSError("not now")

    with simkit.load(world(FLOATING), plugins=[Touchy(9.0)]) as sim:
        sim.step()
        if what == "topic":
            sim.publish("/more", {"data": -1.0})
        elif what == "service":
            with pytest.raises(simkit.SimkitError, match="is disabled"):
                sim.call("/again")
        else:
            sim.set_parameter(next(iter(sim.communication.parameters)), "limit", 2.0)
        sim.run(0.1)
        said = {"topic": "less than nothing", "service": "no answer", "parameter": "not now"}[what]
        assert len(warnings(sim)) == 1 and said in warnings(sim)[0]
        assert velocity(sim) < 0.01


def test_the_argument_overrides_the_file_and_the_file_the_class(tmp_path: Path) -> None:
    source = (
        "from simkit import ModelPlugin\n"
        "class Weak(ModelPlugin):\n"
        "    on_error = 'stop'\n"
        "    def load(self, parent, params):\n"
        "        pass\n"
        "    def after_step(self):\n"
        "        raise ValueError('weak')\n"
    )
    (tmp_path / "weak.py").write_text(source)
    plugin = "<plugin name='weak' filename='weak.py'>{}</plugin>"

    def left_out(body: str, **options: Any) -> bool:
        with simkit.load(world(GROUND, rover(plugin.format(body))), plugin_paths=[tmp_path], **options) as sim:
            assert not [d for d in sim.diagnostics if d.code == "SK-PARAM-003"]
            try:
                sim.step()
            except simkit.PluginError:
                return False
            return len(warnings(sim)) == 1

    says = "<simkit:on_error>{}</simkit:on_error>".format
    assert not left_out("")
    assert left_out(says("disable"))
    assert left_out("<on_error>disable</on_error>")
    assert left_out("", on_error="disable")
    assert left_out(says("stop"), on_error="disable")
    assert not left_out(says("disable"), on_error="stop")


def test_an_unknown_policy_is_an_error_with_the_allowed_words(tmp_path: Path) -> None:
    plugin = (
        "<plugin name='d' filename='libgazebo_ros_diff_drive.so'><simkit:on_error>ignore</simkit:on_error></plugin>"
    )
    with pytest.raises(simkit.LoadError, match="expected one of stop, disable"):
        simkit.load(world(GROUND, rover(plugin)))
    with pytest.raises(simkit.SimkitError, match="'stop' or 'disable'"):
        simkit.load(world(GROUND), on_error="ignore")  # type: ignore[arg-type]


def test_a_plugin_that_raises_in_load_is_disabled_and_the_others_load() -> None:
    class Broken(WorldPlugin):
        on_error = "disable"

        def load(self, parent: Simulation, params: Params) -> None:
            self.advertise("broken", "std_msgs/msg/Float64")
            raise LookupError("nothing here")

    with simkit.load(world(FLOATING), plugins=[Broken(), Pusher(9.0)]) as sim:
        sim.run(0.1)
        assert "/broken" not in sim.topics() and "/pushes" in sim.topics()
        assert "in load at t=0 s" in warnings(sim)[0]
        sim.reset()
        assert "/broken" not in sim.topics()


def test_a_servo_of_a_disabled_plugin_releases_its_joint() -> None:
    class Motor(WorldPlugin):
        on_error = "disable"

        def prepare(self, scene: Any, params: Params, builder: Any) -> None:
            self.servo = builder.add_velocity_servo("arm::j", max_effort=50.0, owner=self.name)

        def load(self, parent: Simulation, params: Params) -> None:
            self.sim.engine.set_control(self.servo, 2.0)

        def after_step(self) -> None:
            if self.sim.time > 0.5:
                raise RuntimeError("burnt")

    arm = """<gravity>0 0 0</gravity><model name="arm"><link name="base"/><joint name="w" type="fixed">
<parent>world</parent><child>base</child></joint><link name="rod"><inertial><mass>1</mass></inertial></link>
<joint name="j" type="revolute"><parent>base</parent><child>rod</child><axis><xyz>0 0 1</xyz>
<dynamics><damping>0.5</damping></dynamics></axis></joint></model>"""
    with simkit.load(world(arm), plugins=[Motor()]) as sim:
        sim.run(0.4)
        before = sim.snapshot()
        assert sim.joint("arm::j").velocity == pytest.approx(2.0, rel=0.1)
        sim.run(2.0)
        coasting = 2.0 * math.exp(-0.5 * 1.9)  # damping 0.5 on an inertia of 1
        assert sim.joint("arm::j").velocity == pytest.approx(coasting, rel=0.01)
        sim.spawn(f"<sdf version='1.9'>{BALL}</sdf>")
        sim.run(1.0)
        assert sim.joint("arm::j").velocity == pytest.approx(coasting * math.exp(-0.5), rel=0.01)
        sim.restore(before)
        sim.run(0.09)
        assert sim.joint("arm::j").velocity == pytest.approx(2.0, rel=0.1)


def test_closing_closes_every_plugin_and_then_reports_an_exception() -> None:
    closed: list[str] = []

    class Stubborn(WorldPlugin):
        def load(self, parent: Simulation, params: Params) -> None:
            pass

        def close(self) -> None:
            closed.append("stubborn")
            raise OSError("stuck")

    class Meek(Stubborn):
        def close(self) -> None:
            closed.append("meek")

    sim = simkit.load(world(GROUND), plugins=[Stubborn(), Meek()])
    with pytest.raises(simkit.PluginError, match="raised in close"):
        sim.close()
    assert closed == ["stubborn", "meek"]
    sim.close()
    assert closed == ["stubborn", "meek"]


def test_an_invalid_argument_in_a_hook_is_a_plugin_error() -> None:
    class Wrong(WorldPlugin):
        def load(self, parent: Simulation, params: Params) -> None:
            pass

        def after_step(self) -> None:
            self.sim.publish("/nobody", {"data": 1.0})

    with simkit.load(world(GROUND), plugins=[Wrong()]) as sim, pytest.raises(simkit.PluginError) as caught:
        sim.step()
    assert isinstance(caught.value.__cause__, simkit.MessageError)


class Holder(WorldPlugin):
    """Holds objects that cannot be copied."""

    def load(self, parent: Simulation, params: Params) -> None:
        self.counted = 0
        self.file = Path(__file__).open()  # noqa: SIM115 - to be held
        self.thread = threading.Thread(target=int)
        self.numbers = self.count()
        self.nested = {"deep": [io.TextIOWrapper(io.BytesIO())]}

    def count(self) -> Iterator[int]:
        yield from range(1000)

    def after_step(self) -> None:
        self.counted += 1

    def close(self) -> None:
        self.file.close()


def test_open_files_threads_and_generators_are_reported_by_attribute_and_not_changed() -> None:
    holder = Holder()
    with simkit.load(world(GROUND), plugins=[holder]) as sim:
        sim.step(2)
        snapshot, file = sim.snapshot(), holder.file
        sim.step(3)
        sim.restore(snapshot)
        assert holder.counted == 2 and holder.file is file and not file.closed
        found = [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-006"]
    assert [next(n for n in ("file", "thread", "numbers", "nested") if f"{n!r}" in m) for m in found] == [
        "file",
        "thread",
        "numbers",
        "nested",
    ]


class Forgetful(WorldPlugin):
    """Raises in the methods for its own state."""

    def __init__(self, hook: str, on_error: Any) -> None:
        self.hook, self.on_error, self.steps, self.is_loaded = hook, on_error, 0, False

    def load(self, parent: Simulation, params: Params) -> None:
        pass

    def after_step(self) -> None:
        self.steps += 1

    def get_state(self) -> Any:
        if self.hook == "get_state" and self.steps:
            raise RuntimeError("cannot remember")
        return super().get_state()

    def set_state(self, state: Any) -> None:
        if self.hook == "set_state":
            raise RuntimeError("cannot remember")
        super().set_state(state)


@pytest.mark.parametrize("hook", ["get_state", "set_state"])
def test_an_exception_in_get_state_is_handled_like_one_in_a_hook(hook: str) -> None:
    with simkit.load(world(FLOATING), plugins=[Forgetful(hook, "stop")]) as sim:
        sim.step(2)
        with pytest.raises(simkit.PluginError, match=f"'Forgetful'.*raised in {hook} .*cannot remember"):
            sim.restore(sim.snapshot())
    with simkit.load(world(FLOATING), plugins=[Forgetful(hook, "disable")]) as sim:
        sim.step(2)
        sim.restore(sim.snapshot())
        sim.step(2)
        assert [hook in line and "is disabled" in line for line in warnings(sim)] == [True]
        assert sim.contents.plugins["Forgetful"].steps == 2


def test_two_plugins_with_one_service_or_action_are_an_error_with_a_code_and_both_places() -> None:
    class Server(WorldPlugin):
        def load(self, parent: Simulation, params: Params) -> None:
            self.offer("home", "std_srvs/srv/Trigger", lambda request: None)

    class Second(Server):
        on_error = "disable"

    class Actor(WorldPlugin):
        def load(self, parent: Simulation, params: Params) -> None:
            self.act("home", "example_interfaces/action/Fibonacci", lambda goal: None)

    class Late(Server):
        def load(self, parent: Simulation, params: Params) -> None:
            pass

        def before_step(self) -> None:
            self.offer("home", "std_srvs/srv/Trigger", lambda request: None)

    for kind, code in ((Server, "SK-SERVICE-001"), (Actor, "SK-ACTION-001")):
        with pytest.raises(simkit.LoadError) as found:
            simkit.load(world(FLOATING), plugins=[kind(), kind()])
        (problem,) = found.value.diagnostics
        assert problem.code == code and problem.hint
        assert re.match(
            f"plugin '{kind.__name__}': an? .* '/home' exists already, of plugin '{kind.__name__}'", problem.message
        )
    with (
        simkit.load(world(FLOATING), plugins=[Server(), Late()]) as sim,
        pytest.raises(simkit.PluginError, match="plugin 'Late' .* SK-SERVICE-001 .*, of plugin 'Server'"),
    ):
        sim.step()
    with simkit.load(world(FLOATING), plugins=[Server(), Second()]) as sim:
        assert "/home" in sim.communication.services.names() and "plugin 'Second' raised in load" in warnings(sim)[0]


def test_two_plugins_of_simkit_with_one_service_are_a_warning_and_the_first_one_answers(tmp_path: Path) -> None:
    wall = """<model name="wall"><static>true</static><link name="l"><collision name="c"><geometry><box>
      <size>{} 1 1</size></box></geometry></collision></link></model>"""
    server = '<plugin filename="libsimkit_map_server.so" name="map_server"><resolution>{}</resolution></plugin>'
    file = tmp_path / "w.sdf"
    content = wall.format(1) + server.format(0.1) + server.format(0.5)
    file.write_text(f'<sdf version="1.9"><world name="w">{content}</world></sdf>', "utf-8")
    with simkit.load(file) as sim:
        found = [d for d in sim.diagnostics if d.code == "SK-SERVICE-004"]
        assert sim.call("/map_server/map").map.info.resolution == pytest.approx(0.1)
    assert len(found) == 2  # ~/map and ~/load_map
    assert "plugin 'map_server' cannot be reached: a service '/map_server/map' exists already, of plugin" in str(
        found[0]
    )


def test_load_cannot_reset_the_simulation() -> None:
    class Hasty(WorldPlugin):
        def load(self, parent: Simulation, params: Params) -> None:
            parent.reset()

    with pytest.raises(simkit.PluginError, match="'Hasty'.*still being loaded"):
        simkit.load(world(FLOATING), plugins=[Hasty()])


@pytest.mark.parametrize("what", ["topic", "service", "parameter"])
def test_an_endless_recursion_disables_the_plugin_with_a_message(what: str) -> None:
    class Echo(WorldPlugin):
        on_error = "disable"

        def load(self, parent: Simulation, params: Params) -> None:
            self.out = self.advertise("out", "std_msgs/msg/Empty")
            self.subscribe("out", self.out.publish)
            self.offer("srv", "std_srvs/srv/Trigger", lambda request: parent.call("/srv"))
            self.gain = self.declare("gain", 1.0, on_change=lambda v: parent.set_parameter("/Echo", "gain", v + 1))

        def after_step(self) -> None:
            if what == "topic":
                self.out.publish(simkit.msgs.make("std_msgs/msg/Empty"))

    with simkit.load(world(FLOATING), plugins=[Echo()]) as sim:
        if what == "service":
            with pytest.raises(simkit.InputError, match="plugin 'Echo' is disabled"):
                sim.call("/srv")
        if what == "parameter":
            sim.set_parameter("/Echo", "gain", 2.0)
        sim.step(2)
        assert ["RecursionError" in line and "is disabled" in line for line in warnings(sim)] == [True]
