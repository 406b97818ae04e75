"""Causes of differences: each change is named and proven by undoing it."""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from simkit.loaders.resources.bundled_models import find_bundled_model
from simkit.run_spec import RunSpec
from simkit.testing.golden.cause import explain
from simkit.testing.golden.compare.difference import Explanation
from simkit.testing.golden.compare.runs import compare
from simkit.testing.run_record.record import RunRecord
from simkit.testing.run_record.run_recorder import record_run

WORLD = """<sdf version="1.12"><world name="w">
  <physics name="p" type="x"><max_step_size>0.002</max_step_size></physics>
  <model name="ground"><static>true</static><link name="l">
    <collision name="c"><geometry><plane><normal>0 0 1</normal></plane></geometry></collision>
  </link></model>
  <model name="arm">
    <pose>1 0 0.6 0 0 0</pose>
    <link name="foot"><inertial><mass>2</mass></inertial></link>
    <link name="rod"><pose>0 0 0.1 0 0.3 0</pose>
      <inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
      <collision name="skin"><geometry><cylinder><radius>0.03</radius><length>0.3</length></cylinder></geometry>
      </collision>
      <visual name="look"><geometry><cylinder><radius>0.03</radius><length>0.3</length></cylinder></geometry>
        <material><diffuse>0.5 0.5 0.5 1</diffuse></material></visual>
      <sensor name="imu" type="imu"><pose>0 0 0.1 0 0 0</pose><update_rate>50</update_rate><topic>/imu</topic>
        <imu><angular_velocity>
          <x><noise type="gaussian"><mean>0</mean><stddev>0.01</stddev></noise></x>
          <y><noise type="gaussian"><mean>0</mean><stddev>0.01</stddev></noise></y>
        </angular_velocity></imu></sensor>
    </link>
    <joint name="nail" type="fixed"><parent>world</parent><child>foot</child></joint>
    <joint name="hinge" type="revolute"><parent>foot</parent><child>rod</child><pose>0 0 -0.1 0 0 0</pose>
      <axis><xyz>0 1 0</xyz><dynamics><damping>0.1</damping></dynamics>
        <limit><lower>-3</lower><upper>3</upper></limit></axis></joint>
  </model>
  <model name="box"><pose>-1 0 0.5 0.1 0 0</pose><link name="b">
    <inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
    <collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
    <visual name="v"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></visual>
  </link></model>
</world></sdf>
"""


def scenario(folder: Path, text: str, **more: Any) -> RunSpec:
    (folder / "w.sdf").write_text(text)
    return replace(RunSpec("w.sdf", duration=0.5, folder=folder), **more)


def recorded(what: RunSpec) -> RunRecord:
    record = record_run(what)
    record.simulation.close()
    record.simulation = None
    return record


@pytest.fixture(scope="module")
def golden(tmp_path_factory: pytest.TempPathFactory) -> RunRecord:
    return recorded(scenario(tmp_path_factory.mktemp("golden"), WORLD))


Explained = Callable[..., Explanation]


@pytest.fixture
def explained(golden: RunRecord, tmp_path: Path) -> Explained:
    """Explain a run of the golden world in which some texts are replaced."""

    def of(*replaced: tuple[str, str], count: int = 1, budget: float = 30.0) -> Explanation:
        text = WORLD
        for old, new in replaced:
            assert old in text
            text = text.replace(old, new, count)
        run = recorded(scenario(tmp_path, text))
        found = compare(golden, run)
        assert not found.passed
        return explain(golden, run, found, budget_s=budget)

    return of


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("<damping>0.1<", "<damping>0.101<", "joint arm::hinge: damping 0.1 → 0.101 (+1 %)"),
        ("<mass>1</mass>", "<mass>1.01</mass>", "link arm::rod: mass 1 → 1.01 kg (+1 %)"),
        ("<size>0.2 0.2 0.2<", "<size>0.2 0.2 0.202<", "collision box::b::c: size z 0.2 → 0.202 m (+1 %)"),
        ("<update_rate>50<", "<update_rate>51<", "sensor arm::rod::imu: update_rate 50 → 51 Hz (+2 %)"),
        ("<stddev>0.01<", "<stddev>0.012<", "imu.angular_velocity.x.noise.stddev 0.01 → 0.012 (+20 %)"),
        ("<max_step_size>0.002<", "<max_step_size>0.001<", "world: physics.max_step_size 0.002 → 0.001 s"),
        ("<pose>1 0 0.6 0 0 0<", "<pose>1.002 0 0.6 0 0 0<", "model arm moved 2 mm along x (x 1 → 1.002)"),
        ("<pose>-1 0 0.5 0.1 0 0<", "<pose>-1 0 0.5 0.117453 0 0<", "model box rotated 1° about x"),
        ("<pose>0 0 0.1 0 0 0</pose><u", "<pose>0 0.002 0.1 0 0 0</pose><u", "sensor arm::rod::imu moved 2 mm along y"),
        ("<xyz>0 1 0<", "<xyz>0.1 1 0<", "joint arm::hinge: axis xyz x 0 → 0.0995, y 1 → 0.995"),
        ("<topic>/imu<", "<topic>/other<", "sensor arm::rod::imu: topic /imu → /other"),
    ],
)
def test_one_change_is_named_and_proven(explained: Explained, old: str, new: str, words: str) -> None:
    found = explained((old, new))
    assert words in found.lines[0], found.lines
    assert [c.proven for c in found.causes] == [True], found.lines
    assert re.search(r"w\.sdf:\d+\)$", found.lines[0])
    assert found.lines[1].endswith("with this change undone, the run gives the golden outputs")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("<radius>0.033<", "<radius>0.03333<", "radius 0.033 → 0.03333 m (+1 %) in 2 places"),
        ("<stddev>1.7e-2<", "<stddev>3.4e-2<", "imu: imu.linear_acceleration.x.noise.stddev 0.017 → 0.034"),
        ("<horizontal_fov>1.02974<", "<horizontal_fov>1.04719<", "camera: camera.horizontal_fov 1.02974 → 1.04719 rad"),
        ("<max>3.5<", "<max>3.0<", "sensor turtlebot3::base_scan::lds: lidar.range.max 3.5 → 3 m"),
    ],
    ids=["wheel", "IMU", "camera", "lidar"],
)
def test_a_changed_turtlebot3_is_named_and_proven(tmp_path: Path, old: str, new: str, words: str) -> None:
    bundled = find_bundled_model("turtlebot3_waffle")
    assert bundled is not None
    model = tmp_path / "turtlebot3_waffle" / "model.sdf"
    shutil.copytree(bundled if bundled.is_dir() else bundled.parent, model.parent)
    text = """<sdf version="1.9"><world name="w"><include><uri>model://ground_plane</uri></include>
      <include><uri>model://turtlebot3_waffle</uri><name>turtlebot3</name></include>
      <model name="wall"><static>true</static><pose>3.2 0 1 0 0 0</pose><link name="l">
        <collision name="c"><geometry><box><size>0.1 4 2</size></box></geometry></collision></link></model>
    </world></sdf>"""
    topics = ("/scan", "/imu", "/odom", "/camera/camera_info")
    robot = scenario(tmp_path, text, topics=topics, options={"resource_paths": [str(tmp_path)]})
    golden = recorded(robot)
    model.write_text(model.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    run = recorded(robot)
    explanation = explain(golden, run, compare(golden, run), budget_s=60)
    assert words in " ".join(explanation.lines).replace("  ", " "), explanation.lines
    assert [c.proven for c in explanation.causes] == [True], explanation.lines


def test_a_link_that_moves_with_its_sensors_and_joint_is_one_change(explained: Explained) -> None:
    found = explained(("<pose>0 0 0.1 0 0.3 0</pose>", "<pose>0.002 0 0.1 0 0.3 0</pose>"))
    assert [c.words for c in found.causes] == ["link arm::rod moved 2 mm along x (x 0 → 0.002)"]
    assert found.causes[0].proven


def test_the_same_change_in_two_places_is_one_line(explained: Explained) -> None:
    found = explained(("<radius>0.03<", "<radius>0.0303<"), count=2)
    assert len(found.causes) == 1
    assert (
        "radius 0.03 → 0.0303 m (+1 %) in 2 places: collision arm::rod::skin, visual arm::rod::look" in found.lines[0]
    )


def test_effective_and_idle_changes_are_distinguished(
    explained: Explained,
) -> None:
    found = explained(
        ("<diffuse>0.5 ", "<diffuse>0.6 "), ("<damping>0.1<", "<damping>0.11<"), ("<stddev>0.01<", "<stddev>0.02<")
    )
    assert {c.path.rpartition(".")[2]: c.proven for c in found.causes} == {
        "damping": True,
        "stddev": True,
        "ambient": False,
    }
    assert "proven: with these 2 changes undone" in found.lines[2]
    assert found.lines[3].startswith("also changed, without effect: visual arm::rod::look: material.ambient")


def test_an_added_or_removed_model_is_one_change(explained: Explained) -> None:
    box = WORLD[WORLD.index('<model name="box"') : WORLD.index("</world>")]
    found = explained((box, ""))
    assert (found.causes[0].words, found.causes[0].proven) == ("model box is gone", True)
    found = explained((box, box + box.replace('"box"', '"crate"').replace("-1 0 0.5", "-3 0 0.5")))
    assert (found.causes[0].words, found.causes[0].proven) == ("model crate is new", True)


def test_a_renamed_entity_is_reported_as_renamed(explained: Explained) -> None:
    found = explained(('sensor name="imu"', 'sensor name="imu_2"'))
    assert found.causes[0].words == "sensor arm::rod::imu was renamed to arm::rod::imu_2"
    assert found.causes[0].proven  # the noise depends on the name of the sensor


def test_another_shape_is_one_change(explained: Explained) -> None:
    found = explained(("<box><size>0.2 0.2 0.2</size></box>", "<sphere><radius>0.1</radius></sphere>"))
    assert found.causes[0].words.startswith("collision box::b::c: shape Box → Sphere, with radius 0.1 instead of size")
    assert len(found.causes) == 1 and found.causes[0].proven


def test_a_removed_element_is_one_change(explained: Explained) -> None:
    noise = '<noise type="gaussian"><mean>0</mean><stddev>0.01</stddev></noise>'
    found = explained((f"<y>{noise}</y>", "<y></y>"))
    assert "imu.angular_velocity.y.noise is gone (it had" in found.causes[0].words
    assert len(found.causes) == 1 and found.causes[0].proven


def test_a_change_without_an_effect_on_outputs_is_reported(explained: Explained) -> None:
    found = explained(("<diffuse>0.5 ", "<diffuse>0.6 "))
    assert found.lines[0].startswith(
        "cause: visual arm::rod::look: material.ambient r 0.5 → 0.6 (+20 %), diffuse r 0.5 → 0.6 (+20 %)"
    )
    assert found.lines[1:] == ["  no other input changed", "  no recorded output differs"]
    assert found.tick is None


def test_causes_are_listed_without_proof_if_no_time_is_left(explained: Explained) -> None:
    found = explained(("<damping>0.1<", "<damping>0.15<"), budget=0.0)
    assert [(c.words, c.proven) for c in found.causes] == [("joint arm::hinge: damping 0.1 → 0.15 (+50 %)", None)]


def test_the_first_tick_and_quantity_are_those_of_the_change(explained: Explained) -> None:
    found = explained(("<damping>0.1<", "<damping>0.11<"))
    assert found.tick is not None and found.tick <= 3
    assert found.quantity.startswith("arm::hinge ")
    assert "all inputs are equal" in found.lines[-1]


def test_a_seed_is_named(golden: RunRecord, tmp_path: Path) -> None:
    run = recorded(scenario(tmp_path, WORLD, seed=1))
    found = explain(golden, run, compare(golden, run))
    assert (found.causes[0].words, found.causes[0].proven) == ("scenario: seed 0 → 1", True)


PUSH = """from simkit import ModelPlugin
from strength import NEWTON


class Push(ModelPlugin):
    filenames = ("push.py",)

    def load(self, parent, params):
        self.link = parent.links["b"]

    def before_step(self):
        if self.sim.time > 0.1:
            self.link.apply_wrench((NEWTON, 0, 0))
"""


def test_changed_code_imported_by_a_plugin_is_named_with_the_first_different_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    text = WORLD.replace("</link></model>\n</world>", '</link><plugin name="push" filename="push.py"/></model></world>')
    (tmp_path / "push.py").write_text(PUSH)
    (tmp_path / "strength.py").write_text("NEWTON = 1.0\n")
    before = recorded(scenario(tmp_path, text, options={"plugin_paths": [str(tmp_path)]}))
    other = tmp_path / "other"
    shutil.copytree(tmp_path, other, ignore=shutil.ignore_patterns("other", "__pycache__"))
    (other / "strength.py").write_text("NEWTON = 1.5\n")
    sys.modules.pop("strength", None)
    monkeypatch.syspath_prepend(str(other))
    run = recorded(scenario(other, text, options={"plugin_paths": [str(other)]}))
    run.scenario = replace(run.scenario, options=before.scenario.options)
    found = explain(before, run, compare(before, run), rerun=None)
    assert found.lines[0] == "cause: the code of strength.py was changed"
    assert found.tick == 52  # the force acts first in the step that begins at t = 0.102 s
    assert found.lines[2].startswith("the inputs from plugins and commands differ first at tick 52")
