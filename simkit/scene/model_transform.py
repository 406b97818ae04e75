"""Copies of a model's content under another name, or moved in the world."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from typing import Any, Final, TypeVar

from simkit.params import Params
from simkit.pose import Pose
from simkit.scene.model import SceneModel

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
_POSE_FIELDS: Final = frozenset(("pose_world", "place"))
_DIRECTION_FIELDS: Final = frozenset(("direction_world", "xyz_world"))


def transform_model(model: SceneModel, name: str, shift: Pose) -> SceneModel:
    """Return a copy of a top-level model with its whole content under a name, moved by a transform of the world.

    A model in MuJoCo's own format must keep its name, because the format has names of its own.
    """
    return replace(_ModelCopier(model.name, name, shift).of(model), name=name)


def move_model(model: SceneModel, shift: Pose) -> SceneModel:
    """Return a top-level model that is moved by a transform of the world, with the parameters of the original."""
    return _ModelCopier(model.name, model.name, shift, copies_params=False).of(model)


def move_part(part: T, shift: Pose) -> T:
    """Return a part of the scene that is moved by a transform of the world, with the parameters of the original."""
    return _ModelCopier("", "", shift, copies_params=False).of(part)


class _ModelCopier:
    def __init__(self, old: str, new: str, shift: Pose, *, copies_params: bool = True) -> None:
        self._old, self._new, self._shift, self._copies_params = old, new, shift, copies_params

    def of(self, value: T) -> T:
        """Copy a part of the scene."""
        if isinstance(value, tuple):
            return tuple(self.of(item) for item in value)  # type: ignore[return-value]
        if isinstance(value, Params):
            return value.copied() if self._copies_params else value  # type: ignore[return-value]
        if not is_dataclass(value) or isinstance(value, type):
            return value
        changed: dict[str, object] = {}
        for field in fields(value):
            before = getattr(value, field.name)
            after = self._field(field.name, before)
            if after is not before:
                changed[field.name] = after
        return replace(value, **changed) if changed else value

    def _field(self, name: str, value: Any) -> Any:
        if name in _NAME_FIELDS:
            return self._name(value)
        if name in _POSE_FIELDS:
            return self._shift @ value
        if name in _DIRECTION_FIELDS:
            return tuple(self._shift.rotate(value).tolist())
        return self.of(value)

    def _name(self, value: object) -> object:
        if self._old == self._new:
            return value
        if value == self._old or (isinstance(value, str) and value.startswith(f"{self._old}::")):
            return self._new + value[len(self._old) :]
        return value
