"""Conversion of older SDF versions to the current spelling: values in attributes, IMU noise, flattened models."""

from __future__ import annotations

from simkit.loaders.sdf.frames import MODEL
from simkit.params import Params

FIRST_NESTED = (1, 8)
_GROUPED = ("frame", "joint", "link", "model", "gripper")
_JOINT_LINKS = ("parent", "child", "gripper_link", "palm_link", "gearbox_reference_body")
_REFERENCES = {"pose": "relative_to", "xyz": "expressed_in"}


def nest_flattened_models(root: Params, version: tuple[int, int]) -> Params:
    """Convert elements with names such as `arm::link` to a nested model `arm`, in place, in files before SDF 1.8."""
    if version < FIRST_NESTED:
        for element in (root, *(c for c in root.children if c.name == "world")):
            for child in element.children:
                if child.name == "model":
                    _unflatten(child)
    return root


def _unflatten(model: Params) -> None:
    groups: dict[str, Params] = {}
    children: list[Params] = []
    for child in model.children:
        outer, separator, inner = child.attributes.get("name", "").partition("::")
        if child.name not in _GROUPED or not separator or not outer or not inner:
            children.append(child)
            continue
        if outer not in groups:
            groups[outer] = Params("model", "", {"name": outer}, (), child.where, child.diagnostics)
            children.append(groups[outer])
        if child.name == "frame" and inner == MODEL:
            _use_model_frame(child, outer, groups[outer])
            continue
        child.attributes["name"] = inner
        _strip_group_name(child, f"{outer}::")
        groups[outer].children.append(child)
    model.children = children
    for child in children:
        if child.name == "model":
            _unflatten(child)


def _use_model_frame(frame: Params, name: str, model: Params) -> None:
    """Copy pose and canonical link to a nested model from `frame`, which replaced its model frame in old files."""
    attached = frame.attributes.get("attached_to", "").removeprefix(f"{name}::")
    if attached:
        model.attributes["canonical_link"] = attached
    model.children += [c for c in frame.children if c.name == "pose"]
    for pose in model.children:
        if pose.attributes.get("relative_to") == f"{name}::{MODEL}":
            del pose.attributes["relative_to"]


def _strip_group_name(element: Params, prefix: str) -> None:
    """Remove the prefix of a nested model (`arm::`) from all references inside an element."""
    for key in ("attached_to", _REFERENCES.get(element.name, "")):
        if key and key in element.attributes:
            element.attributes[key] = element.attributes[key].removeprefix(prefix)
    if element.name in _JOINT_LINKS:
        element.value = element.value.removeprefix(prefix)
    if element.name == "mimic" and "joint" in element.attributes:
        element.attributes["joint"] = element.attributes["joint"].removeprefix(prefix)
    if element.name == "plugin":
        return
    for child in element.children:
        _strip_group_name(child, prefix)


_KEPT_ATTRIBUTES = frozenset(("name", "type", "version", "filename", "default"))
_OWN_TEXT = {
    "rgba": ("ambient", "diffuse", "specular", "emissive", "background"),
    "xyz": ("gravity", "direction", "magnetic_field"),
    "enabled": ("shadows", "static"),
    "link": ("parent", "child"),
}
_ATTRIBUTE_VERSION = (1, 2)
_NOISE_VERSION = (1, 6)
_NOISE_OF = {"rate": "angular_velocity", "accel": "linear_acceleration"}


def modernise(root: Params, version: tuple[int, int]) -> Params:
    """Return the tree in the spelling of SDF 1.6 and later; newer files stay the same."""
    if version < _ATTRIBUTE_VERSION:
        root = _element(root)
    if version < _NOISE_VERSION:
        _spread_imu_noise(root)
    return root


def _spread_imu_noise(element: Params) -> None:
    """Copy the shared noise of every IMU to each of its axes; axes with their own noise keep it."""
    for child in element.children:
        if child.name == "imu" and element.name == "sensor":
            _spread_noise(child)
        elif child.name != "plugin":
            _spread_imu_noise(child)


def _spread_noise(imu: Params) -> None:
    noise = next((c for c in imu.children if c.name == "noise"), None)
    own_names = {c.name for c in imu.children}
    kind = next((c.value for c in noise.children if c.name == "type"), "gaussian") if noise is not None else ""
    for part in noise.children if noise is not None else ():
        if part.name in _NOISE_OF and _NOISE_OF[part.name] not in own_names:
            values = [_make_element(c.name, c.value, c) for c in part.children]
            noise_block = Params("noise", "", {"type": kind}, values, part.where, part.diagnostics)
            imu.children.append(_make_element(_NOISE_OF[part.name], "", part, [noise_block]))
    imu.children = [c for c in imu.children if c is not noise]


def _element(element: Params) -> Params:
    if element.name == "plugin":
        return element
    text, attributes = element.value, {}
    children = [_element(child) for child in element.children]
    added: list[Params] = []
    name = element.name
    for key, value in element.attributes.items():
        if element.name in _OWN_TEXT.get(key, ()):
            text = value
        elif element.name == "origin" and key == "pose":
            name, text = "pose", value
        elif element.name == "material" and key == "script":
            added.append(_make_element("script", "", element, [_make_element("name", value, element)]))
        elif element.name == "mesh" and key == "filename":
            added.append(_make_element("uri", value, element))
        elif key in _KEPT_ATTRIBUTES:
            attributes[key] = value
        else:
            added.append(_make_element(key, value, element))
    return Params(name, text, attributes, [*added, *children], element.where, element.diagnostics)


def _make_element(name: str, text: str, origin: Params, children: list[Params] | None = None) -> Params:
    return Params(name, text, None, children or (), origin.where, origin.diagnostics)
