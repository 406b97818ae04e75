"""A copy of a model under another name, at another place."""

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
    """Raises InputError where no model in a file could have this name."""
    if not isinstance(name, str) or not name.strip():
        raise InputError(f"found the name {name!r} for a model, allowed is a text that is not empty", "SK-NAME-005")
    is_ours = name == "world" or (name.startswith("__") and name.endswith("__"))
    if is_ours or "::" in name:
        why = "is reserved" if is_ours else "has '::', which separates names"
        raise InputError(f"a model cannot have the name {name!r}: it {why}", "SK-NAME-005")


def copy_model(model: SceneModel, name: str, pose: Pose) -> SceneModel:
    """A top-level model with everything in it under another name and moved along to a pose in the world.

    Raises:
        InputError: it is in the engine's own format, which has names of its own.
    """
    if any(nested.mjcf for nested in model.all_models()):
        message = f"SK-SERVICE-002 model {model.name!r} is in MuJoCo's own format and cannot be copied"
        raise InputError(f"{message}; spawn its file again", "SK-SERVICE-002")
    moved = _ModelCopier(model.name, name, pose @ model.pose_world.inverse()).of(model)
    return replace(moved, name=name)


def present_world(
    world: SceneWorld, models: Iterable[tuple[SceneModel, Pose]], lights: Iterable[tuple[SceneLight, Pose]]
) -> SceneWorld:
    """A world with the models and lights that are there now, where they are now; joints are at zero in it.

    Args:
        world: as it was loaded.
        models: top-level ones with the present pose of each; one in the engine's own format stays where it was.
        lights: of the world itself, with the present pose of each.
    """
    placed = tuple(m if any(n.mjcf for n in m.all_models()) else copy_model(m, m.name, pose) for m, pose in models)
    shining = tuple(
        replace(li, pose_world=pose, direction_world=tuple(pose.rotate(li.direction).tolist())) for li, pose in lights
    )
    return replace(world, models=placed, lights=shining)


class _ModelCopier:
    def __init__(self, old: str, new: str, shift: Pose) -> None:
        self._old, self._new, self._shift = old, new, shift

    def of(self, value: T) -> T:
        """A copy of a part of the scene."""
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
