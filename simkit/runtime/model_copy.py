"""Copies of models under another name, at another pose."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields, is_dataclass, replace
from typing import Any, Final, TypeVar

from simkit.errors import InputError
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import SceneLight, SceneModel, SceneWorld

T = TypeVar("T")

_NAME_FIELDS: Final = frozenset(
    (
        "scoped",
        "canonical_link",
        "parent_link",
        "child_link",
        "gearbox_reference",
        "parent",
        "link",
        "attached_to",
        "joint",
    )
)
_DIRECTION_FIELDS: Final = frozenset(("direction_world", "xyz_world"))


def check_model_name(name: object) -> None:
    """Raise InputError for a name that no model in a file can have."""
    if not isinstance(name, str) or not name.strip():
        raise InputError(f"found the name {name!r} for a model; expected a text that is not empty", "SK-NAME-005")
    is_reserved = name == "world" or (name.startswith("__") and name.endswith("__"))
    if is_reserved or "::" in name:
        reason = "is reserved" if is_reserved else "has '::', which separates names"
        raise InputError(f"a model cannot have the name {name!r}: it {reason}", "SK-NAME-005")


def copy_model(model: SceneModel, name: str, pose: Pose) -> SceneModel:
    """Copy a top-level model with its whole content under another name, moved to a pose in the world.

    Raises:
        InputError: the model is in MuJoCo's own format, which has names of its own.
    """
    if any(nested.mjcf for nested in model.all_models()):
        message = f"SK-SERVICE-002 model {model.name!r} is in MuJoCo's own format and cannot be copied"
        raise InputError(f"{message}; spawn its file again", "SK-SERVICE-002")
    moved = _ModelCopier(model.name, name, pose @ model.pose_world.inverse()).of(model)
    return replace(moved, name=name)


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


class _ModelCopier:
    def __init__(self, old: str, new: str, shift: Pose) -> None:
        self._old, self._new, self._shift = old, new, shift

    def of(self, value: T) -> T:
        """Copy a part of the scene."""
        if isinstance(value, tuple):
            return tuple(self.of(item) for item in value)  # type: ignore[return-value]
        if isinstance(value, Params):
            return value.copied()  # type: ignore[return-value]
        if not is_dataclass(value) or isinstance(value, type):
            return value
        changed: dict[str, Any] = {}
        for field in fields(value):
            before = getattr(value, field.name)
            after = self._field(field.name, before)
            if after is not before:
                changed[field.name] = after
        return replace(value, **changed) if changed else value

    def _field(self, name: str, value: Any) -> Any:
        if name in _NAME_FIELDS:
            return self._name(value)
        if name == "pose_world":
            return self._shift @ value
        if name in _DIRECTION_FIELDS:
            return tuple(self._shift.rotate(value).tolist())
        return self.of(value)

    def _name(self, value: Any) -> Any:
        if value == self._old or (isinstance(value, str) and value.startswith(f"{self._old}::")):
            return self._new + value[len(self._old) :]
        return value
