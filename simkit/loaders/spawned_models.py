"""Additional models that are loaded into a world at start: `--spawn MODEL:x,y,yaw[:name[:namespace]]`."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from simkit.diagnostics import Diagnostics
from simkit.loaders import Resolver, find_document
from simkit.loaders.resources.model_list import client_models
from simkit.number_text import counted
from simkit.pose import Pose
from simkit.run_files import SPAWN_KEYS, SPAWN_TEXT
from simkit.run_values import NamedValues
from simkit.scene import Scene, SceneModel
from simkit.scene.model_namespace import NAMESPACE, model_in_namespace

__all__ = ["SpawnEntry", "SpawnedModel", "add_spawned_models", "client_models", "parse_spawn", "spawned_model"]

_POSED: Final = re.compile(r":\s*[^:/]*,[^:/]*(:[^:/]*(:[^:]*)?)?$|:[-+.\d\s]+,[-+.,\d\s]+:")
_FORM: Final = "MODEL:x,y,yaw[:name[:namespace]], as in tiago:1,0,1.57 or robot.urdf:0,2,0:tb1:tb1; or MODEL alone"
_FARTHEST: Final = 1e15  # [m, rad]; sums of larger numbers lose their precision or overflow
_COUNTS: Final = {3: "x,y,yaw", 4: "x,y,z,yaw", 6: "x,y,z,roll,pitch,yaw"}


@dataclass(frozen=True, slots=True)
class SpawnedModel:
    """One additional model.

    Attributes:
        source: a bare name, a file, or XML text.
        place: x, y, yaw, for a model that stands on what is below it; or x, y, z, yaw; or x, y, z, roll, pitch, yaw
            [m, rad]. None keeps the pose of the file; without a pose in the file it means 0, 0, 0.
        name: replaces the name in the file; None keeps that name.
        namespace: ROS namespace of the model's topics, such as `tb1`; None keeps the names of the file.
    """

    source: str | os.PathLike[str]
    place: tuple[float, ...] | None = None
    name: str | None = None
    namespace: str | None = None

    def pose(self, file_pose: Pose) -> Pose | None:
        """Return the pose in the world, or None to keep the pose of the file.

        `x, y, yaw` and `x, y, z, yaw` keep roll and pitch of the file's pose. `x, y, yaw` also keeps its height here;
        the height at which the model stands needs the other models (`Scene.standing`).

        Args:
            file_pose: pose that the model's own file gives.
        """
        if self.place is None:
            return None
        if len(self.place) == 6:
            return Pose.from_rpy(*self.place)
        if len(self.place) == 4:
            x, y, z, yaw = self.place
        else:
            (x, y, yaw), z = self.place, float(file_pose.position[2])
        roll, pitch, _ = (float(v) for v in file_pose.rpy)
        return Pose.from_rpy(x, y, z, roll, pitch, yaw)


SpawnEntry = str | SpawnedModel | Mapping[str, Any]
"""Entry of the field `spawn` of a run."""


def parse_spawn(text: str, diagnostics: Diagnostics) -> SpawnedModel | None:
    """Parse a text such as `tiago:1,0,1.57:robot:ns`; return None, with an error recorded, if the text is invalid."""
    match = SPAWN_TEXT.fullmatch(text.strip())
    if match is None:
        if not text.strip() or _POSED.search(text):
            diagnostics.error("SK-SPAWN-001", f"--spawn: invalid value {text!r}", hint=f"write {_FORM}")
            return None
        return SpawnedModel(text.strip())
    numbers = tuple(float(v) for v in match["numbers"].split(","))
    if len(numbers) not in _COUNTS:
        message = f"--spawn: {text!r} has {counted(len(numbers), 'number')}"
        forms = "; ".join(f"{count} ({form})" for count, form in _COUNTS.items())
        diagnostics.error("SK-SPAWN-001", message, hint=f"give {forms} numbers")
        return None
    return SpawnedModel(match["model"], numbers, match["name"], match["namespace"])


def spawned_model(item: SpawnEntry, diagnostics: Diagnostics) -> SpawnedModel | None:
    """Return the model of an entry of the field `spawn` of a run; None, with an error recorded, for an invalid one.

    Args:
        item: text as for `--spawn`, object, or mapping with the keys `SPAWN_KEYS`.
        diagnostics: receives every problem.
    """
    if isinstance(item, SpawnedModel):
        return item
    if isinstance(item, str):
        return parse_spawn(item, diagnostics)
    unknown = [key for key in item if key not in SPAWN_KEYS]
    place, model = item.get("place"), item.get("model")
    if unknown or not isinstance(model, (str, os.PathLike)) or not model:
        problem = f"has no key {unknown[0]!r}" if unknown else f"needs a 'model', found {model!r:.80}"
        hint = f"allowed keys: {', '.join(SPAWN_KEYS)}"
        diagnostics.error("SK-SPAWN-001", f"spawn: a model {problem}", hint=hint)
        return None
    if place is None:
        return SpawnedModel(model, None, item.get("name"), item.get("namespace"))
    numbers = place if isinstance(place, Sequence) and not isinstance(place, str) else ()
    is_valid = all(isinstance(number, (int, float)) and not isinstance(number, bool) for number in numbers)
    if not is_valid or len(numbers) not in _COUNTS:
        forms = "; ".join(f"{count} ({form})" for count, form in _COUNTS.items())
        message = f"spawn: found the place {place!r:.80} of {model!s:.80}"
        diagnostics.error("SK-SPAWN-001", message, hint=f"give {forms} numbers")
        return None
    return SpawnedModel(model, tuple(map(float, numbers)), item.get("name"), item.get("namespace"))


def add_spawned_models(
    scene: Scene,
    spawned_models: Sequence[SpawnEntry],
    resolver: Resolver,
    diagnostics: Diagnostics,
    load_model: Callable[..., SceneModel | None],
    xacro_args: NamedValues | None = None,
) -> Scene:
    """Return the scene with more models in its world.

    Args:
        scene: the loaded scene.
        spawned_models: the additional models, in this order.
        resolver: finds files.
        diagnostics: receives every problem.
        load_model: function that reads a model from its source; it also gets diagnostics, name and pose.
        xacro_args: arguments of xacro files.
    """
    world = scene.world
    models, standing = list(world.models), list(scene.standing)
    for item in spawned_models:
        spawn = spawned_model(item, diagnostics)
        if spawn is None:
            continue
        if not all(abs(number) <= _FARTHEST for number in spawn.place or ()):  # false for NaN, too
            text = f"--spawn: {spawn.source!s:.80} at {spawn.place}"
            diagnostics.error("SK-SPAWN-001", text, hint=f"give numbers between -{_FARTHEST:g} and {_FARTHEST:g}")
            continue
        if spawn.name is not None and (not isinstance(spawn.name, str) or "::" in spawn.name or not spawn.name.strip()):
            text = f"--spawn: {spawn.source!s:.80} has the name {spawn.name!r:.80}"
            diagnostics.error("SK-SPAWN-001", text, hint="give a text without ::, as in tb1")
            continue
        namespace = spawn.namespace
        if namespace is not None and not (isinstance(namespace, str) and NAMESPACE.fullmatch(namespace)):
            text = f"--spawn: {spawn.source!s:.80} has the namespace {namespace!r:.80}"
            diagnostics.error("SK-SPAWN-001", text, hint="give words of letters, digits and _, as in tb1 or fleet/tb1")
            continue
        problems = Diagnostics()
        file_pose = _file_pose(spawn.source, resolver, xacro_args)
        pose = spawn.pose(file_pose or Pose())
        model = load_model(spawn.source, problems, name=spawn.name, pose=pose, xacro_args=xacro_args)
        problems.pass_on(diagnostics)  # plugins report problems of their parameters later; these are passed on too
        if model is None:
            continue
        if model.name in {*(m.name for m in models), *(a.name for a in world.actors)}:
            text = f"--spawn: the world already has a model or actor named {model.name!r}"
            diagnostics.error("SK-SPAWN-002", text, model.where, "give it another name: MODEL:x,y,yaw:NAME")
            continue
        models.append(model if namespace is None else model_in_namespace(model, namespace))
        if len(spawn.place or ()) == 3 or (spawn.place is None and file_pose is None):
            standing.append(model.name)
    world = replace(world, models=tuple(models))
    return replace(scene, worlds=(world, *scene.worlds[1:]), model=None, light=None, standing=tuple(standing))


def _file_pose(source: str | os.PathLike[str], resolver: Resolver, xacro_args: NamedValues | None) -> Pose | None:
    """Return the pose that a model's own file gives, or None if the file gives none."""
    if not (isinstance(source, str) and "<" in source) and Path(source).suffix in (".urdf", ".xacro", ".xml"):
        return None
    document, _ = find_document(source, resolver, Diagnostics(), xacro_args)
    if document is None or document.root.name != "sdf":
        return None
    for kind in ("model", "include"):
        first = next(iter(document.root.all(kind)), None)
        if first is not None:
            return first.pose("pose") if any(child.name == "pose" for child in first.children) else None
    return None
