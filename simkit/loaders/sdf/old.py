"""Spellings of SDF before 1.2 and before 1.6.

1.0 and 1.1 wrote values as attributes (`<box size="1 1 1"/>`); here they become elements, as in later ones. Before 1.6
the noise of an IMU was one element for all axes, `<imu><noise><type>…<rate>…<accel>…`; here each axis gets its own.
"""

from __future__ import annotations

from simkit.params import Params

_KEPT = frozenset(("name", "type", "version", "filename", "default"))
_OWN_TEXT = {
    "rgba": ("ambient", "diffuse", "specular", "emissive", "background"),
    "xyz": ("gravity", "direction", "magnetic_field"),
    "enabled": ("shadows", "static"),
    "link": ("parent", "child"),
}
_ATTRIBUTE_VERSION = (1, 2)
_NOISE_VERSION = (1, 6)
_NOISE_OF = {"rate": "angular_velocity", "accel": "linear_acceleration"}


def modern(root: Params, version: tuple[int, int]) -> Params:
    """The tree in the spelling of SDF 1.6 and later; newer files come back as they are."""
    if version < _ATTRIBUTE_VERSION:
        root = _element(root)
    if version < _NOISE_VERSION:
        _spread_imu_noise(root)
    return root


def _spread_imu_noise(element: Params) -> None:
    """Gives each axis of every IMU within the noise that is written once for all; what an axis says itself stays."""
    for child in element.children:
        if child.name == "imu" and element.name == "sensor":
            _spread_noise(child)
        elif child.name != "plugin":
            _spread_imu_noise(child)


def _spread_noise(imu: Params) -> None:
    noise = next((c for c in imu.children if c.name == "noise"), None)
    said = {c.name for c in imu.children}
    kind = next((c.value for c in noise.children if c.name == "type"), "gaussian") if noise is not None else ""
    for part in noise.children if noise is not None else ():
        if part.name in _NOISE_OF and _NOISE_OF[part.name] not in said:
            values = [_made(c.name, c.value, c) for c in part.children]
            own = Params("noise", "", {"type": kind}, values, part.where, part.diagnostics)
            imu.children.append(_made(_NOISE_OF[part.name], "", part, [own]))
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
            added.append(_made("script", "", element, [_made("name", value, element)]))
        elif element.name == "mesh" and key == "filename":
            added.append(_made("uri", value, element))
        elif key in _KEPT:
            attributes[key] = value
        else:
            added.append(_made(key, value, element))
    return Params(name, text, attributes, [*added, *children], element.where, element.diagnostics)


def _made(name: str, text: str, origin: Params, children: list[Params] | None = None) -> Params:
    return Params(name, text, None, children or (), origin.where, origin.diagnostics)
