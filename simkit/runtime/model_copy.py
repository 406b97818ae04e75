"""Copies of models under another name, at another pose."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from simkit.errors import InputError
from simkit.pose import Pose
from simkit.scene import SceneLight, SceneModel, SceneWorld
from simkit.scene.model_transform import transform_model


def check_model_name(name: object) -> None:
    """Raise InputError for a name that no model in a file can have."""
    if not isinstance(name, str) or not name.strip():
        raise InputError(
            "SK-NAME-005", f"found the name {name!r} for a model; expected a text that is not empty", shows_code=False
        )
    is_reserved = name == "world" or (name.startswith("__") and name.endswith("__"))
    if is_reserved or "::" in name:
        reason = "is reserved" if is_reserved else "has '::', which separates names"
        raise InputError("SK-NAME-005", f"a model cannot have the name {name!r}: it {reason}", shows_code=False)


def copy_model(model: SceneModel, name: str, pose: Pose) -> SceneModel:
    """Copy a top-level model with its whole content under another name, moved to a pose in the world.

    Raises:
        InputError: the model is in MuJoCo's own format, which has names of its own.
    """
    if any(nested.mjcf for nested in model.all_models()):
        message = f"model {model.name!r} is in MuJoCo's own format and cannot be copied"
        raise InputError("SK-SERVICE-002", f"{message}; spawn its file again")
    return transform_model(model, name, pose @ model.pose_world.inverse())


def present_world(
    world: SceneWorld, models: Iterable[tuple[SceneModel, Pose]], lights: Iterable[tuple[SceneLight, Pose]]
) -> SceneWorld:
    """Return a world with the present models and lights at their present poses; all joints are at zero.

    Args:
        world: world as loaded.
        models: top-level models with their present poses; a model in MuJoCo's own format keeps its loaded pose.
        lights: lights of the world itself with their present poses.
    """
    placed = tuple(m if any(n.mjcf for n in m.all_models()) else copy_model(m, m.name, pose) for m, pose in models)
    moved_lights = tuple(
        replace(li, pose_world=pose, direction_world=tuple(pose.rotate(li.direction).tolist())) for li, pose in lights
    )
    return replace(world, models=placed, lights=moved_lights)
