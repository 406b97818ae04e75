"""Every listed path can be set, and the list shows the new value."""

from __future__ import annotations

import math

import pytest

from simkit.build import read_scene
from simkit.scene import Scene
from simkit.scene.entity_paths import EntityPaths
from simkit.scene.override_list import SettablePath, settable_paths
from simkit.scene.override_poses import pose_of
from simkit.scene.override_values import POSE
from simkit.scene.overrides import apply_overrides
from simkit.sensors.default_parameters import read_parameters

PENDULUM = """
<mujoco><worldbody><geom name="floor" type="plane" size="5 5 .1"/>
  <body name="arm" pos="0 0 1"><joint name="hinge" axis="0 1 0" damping="0.1" range="-90 90" limited="true"/>
    <geom name="rod" type="capsule" fromto="0 0 0 0.5 0 0" size="0.02" mass="1"/></body></worldbody></mujoco>
"""


def listed(scene: Scene) -> dict[str, SettablePath]:
    return {found.path: found for found in settable_paths(scene.world, scene.arguments, read_parameters)}


def changed(path: SettablePath) -> str | None:
    """Return a slightly changed value of the same kind; None for a text whose kind is unknown."""
    if path.value in ("true", "false"):
        return "false" if path.value == "true" else "true"
    try:
        numbers = [float(word) for word in path.value.split()]
    except ValueError:
        return None
    if path.path.endswith((".ambient", ".background", ".diffuse", ".specular", ".emissive")):
        return " ".join(["0.5"] * len(numbers))
    if path.path.endswith((".xyz", ".direction", ".normal")):
        return "0 0.6 0.8"
    if path.path.endswith(("bitmask", "flags", "max_contacts")):
        return str(int(numbers[0]) - 1)
    return " ".join(repr(n + 0.25 if math.isfinite(n) else n) for n in numbers) or None


@pytest.mark.parametrize("source", ["turtlebot3_world", "tiago", PENDULUM], ids=["sdf", "urdf", "mjcf"])
def test_every_listed_path_reads_back_its_own_value_and_a_changed_one(source: str) -> None:
    scene, _ = read_scene(source)
    paths = {name: path for name, path in listed(scene).items() if not name.endswith(".count")}
    assert len(paths) > 40
    own = apply_overrides(scene, [f"{name}={path.value}" for name, path in paths.items()])
    assert listed(own).items() >= paths.items()
    wanted = {name: text for name, path in paths.items() if (text := changed(path)) is not None}
    tried = {name: text for name, text in wanted.items() if name.rpartition(".")[2] != "pose"}
    new = listed(apply_overrides(scene, [f"{name}={text}" for name, text in tried.items()]))
    for name, text in tried.items():
        assert _numbers(new[name].value) == pytest.approx(_numbers(text), abs=1e-12), name
    poses = [name for name in paths if name.rpartition(".")[2] == "pose"]
    for name in poses[:: max(1, len(poses) // 20)]:
        x, *rest = paths[name].value.split()
        text = " ".join([repr(float(x) + 0.25), *rest])
        world = EntityPaths(apply_overrides(scene, [f"{name}={text}"]).world)
        ((entity, _),) = world.find(name)
        pose = pose_of(world.item(entity), world.holders(entity))
        assert pose is not None
        assert _numbers(POSE.format(pose)) == pytest.approx(_numbers(text), abs=1e-9), name


def _numbers(text: str) -> object:
    return [float(word) for word in text.split()] if text not in ("true", "false") else text == "true"
