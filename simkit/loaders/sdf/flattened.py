"""Models flattened into one by an older program (`<link name="arm::hand">`), made nested again.

Up to SDF 1.7 a nested or included model was written as links, joints and frames with `::` in their names, its own
pose as a frame `arm::__model__`. From 1.8 on `::` only separates names, so a group becomes the model it stands for.
"""

from __future__ import annotations

from simkit.loaders.sdf.frames import MODEL
from simkit.params import Params

FIRST_NESTED = (1, 8)
_GROUPED = ("frame", "joint", "link", "model", "gripper")
_ENDS = ("parent", "child", "gripper_link", "palm_link", "gearbox_reference_body")
_REFERENCES = {"pose": "relative_to", "xyz": "expressed_in"}


def nested(root: Params, version: tuple[int, int]) -> Params:
    """Makes the groups of every model nested, in place; newer files stay as they are."""
    if version < FIRST_NESTED:
        for element in (root, *(c for c in root.children if c.name == "world")):
            for child in element.children:
                if child.name == "model":
                    _unflatten(child)
    return root


def _unflatten(model: Params) -> None:
    groups: dict[str, Params] = {}
    kept: list[Params] = []
    for child in model.children:
        outer, separator, inner = child.attributes.get("name", "").partition("::")
        if child.name not in _GROUPED or not separator or not outer or not inner:
            kept.append(child)
            continue
        if outer not in groups:
            groups[outer] = Params("model", "", {"name": outer}, (), child.where, child.diagnostics)
            kept.append(groups[outer])
        if child.name == "frame" and inner == MODEL:
            _as_model_pose(child, outer, groups[outer])
            continue
        child.attributes["name"] = inner
        _strip(child, f"{outer}::")
        groups[outer].children.append(child)
    model.children = kept
    for child in kept:
        if child.name == "model":
            _unflatten(child)


def _as_model_pose(frame: Params, name: str, model: Params) -> None:
    """The frame that stood for the model's own says where it is and which link it moves with."""
    attached = frame.attributes.get("attached_to", "").removeprefix(f"{name}::")
    if attached:
        model.attributes["canonical_link"] = attached
    model.children += [c for c in frame.children if c.name == "pose"]
    for pose in model.children:
        if pose.attributes.get("relative_to") == f"{name}::{MODEL}":
            del pose.attributes["relative_to"]


def _strip(element: Params, prefix: str) -> None:
    """Takes the group's name off every reference into the group."""
    for key in ("attached_to", _REFERENCES.get(element.name, "")):
        if key and key in element.attributes:
            element.attributes[key] = element.attributes[key].removeprefix(prefix)
    if element.name in _ENDS:
        element.value = element.value.removeprefix(prefix)
    if element.name == "mimic" and "joint" in element.attributes:
        element.attributes["joint"] = element.attributes["joint"].removeprefix(prefix)
    if element.name == "plugin":
        return
    for child in element.children:
        _strip(child, prefix)
