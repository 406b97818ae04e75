"""A reset keeps the schedule of tasks, unless the restored state has other rates, limits, plugins or readers."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

import simkit

WORLD = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="m">
<link name="base"><inertial><mass>5</mass></inertial>
<sensor name="imu" type="imu"><update_rate>50</update_rate></sensor></link>
<link name="arm"><pose>0 0 1 0 0 0</pose></link>
<joint name="j" type="revolute"><parent>base</parent><child>arm</child>
<axis><xyz>0 0 1</xyz><limit><velocity>2</velocity></limit></axis></joint></model></world></sdf>"""


class Counter(simkit.WorldPlugin):
    """Counts its hooks, and raises at a time."""

    on_error = "disable"
    before_step_rate = 100.0
    after_step_rate: float | None = 20.0

    def load(self, parent: object, params: object) -> None:
        self.before = self.after = 0
        self.fails_at = float("inf")

    def before_step(self) -> None:
        self.before += 1

    def after_step(self) -> None:
        self.after += 1
        if self.sim.time >= self.fails_at:
            raise ValueError("no more")


@pytest.fixture
def sim() -> Iterator[simkit.Simulation]:
    with simkit.load(WORLD, plugins=[Counter()]) as sim:
        yield sim


def counter(sim: simkit.Simulation) -> Counter:
    return next(plugin for plugin in sim.plugins.values() if isinstance(plugin, Counter))


def fill_count(sim: simkit.Simulation, monkeypatch: pytest.MonkeyPatch, call: Callable[[], object]) -> int:
    """Return how often a call fills the schedule."""
    filled: list[object] = []
    fill = sim.engine.loop._fill
    monkeypatch.setattr(sim.engine.loop, "_fill", lambda scheduler: (filled.append(1), fill(scheduler)))
    call()
    return len(filled)


def test_a_reset_without_changes_keeps_the_tasks(sim: simkit.Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    sim.run(0.11)
    before = counter(sim).before, counter(sim).after
    assert fill_count(sim, monkeypatch, sim.reset) == 0
    sim.run(0.11)
    assert (counter(sim).before, counter(sim).after) == before == (10, 2)


def test_hooks_have_their_first_rates_after_a_reset(sim: simkit.Simulation) -> None:
    counter(sim)._set_before_step_rate(10.0)
    counter(sim)._set_after_step_rate(None)
    sim.run(0.1)
    sim.reset()
    sim.run(0.1)
    assert (counter(sim).before, counter(sim).after) == (9, 2)


def test_a_sensor_has_its_first_rate_after_a_reset(sim: simkit.Simulation) -> None:
    imu = sim.sensor("m::base::imu")
    imu.set_rate(10.0)
    sim.run(0.2)
    sim.reset()
    sim.run(0.2)
    assert imu.count == 11  # one after the first step, then at 0.02, 0.04, …, 0.2 s


def test_a_disabled_plugin_runs_again_after_a_reset(sim: simkit.Simulation) -> None:
    counter(sim).fails_at = 0.1
    sim.run(0.2)
    assert counter(sim).after == 2
    sim.reset()
    sim.run(0.2)
    assert counter(sim).after == 4


def test_a_joint_has_its_first_velocity_limit_after_a_reset(sim: simkit.Simulation) -> None:
    joint = sim.joint("m::j")
    joint.velocity_limit = 8.0
    sim.reset()
    joint.set_velocity(5.0)
    sim.run(0.1)
    assert float(joint.velocity) == pytest.approx(2.0)


def test_a_topic_with_a_new_reader_is_published_after_a_reset(sim: simkit.Simulation) -> None:
    sim.run(0.1)
    clock = sim.subscribe("/clock", keep=None)
    sim.reset()
    sim.run(0.1)
    assert len(clock.messages) > 0
