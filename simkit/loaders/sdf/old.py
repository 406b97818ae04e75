"""SDF 1.0 and 1.1 wrote values as attributes (`<box size="1 1 1"/>`); here they become elements, as in later ones."""

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


def modern(root: Params, version: tuple[int, int]) -> Params:
    """The tree in the spelling of SDF 1.2 and later; newer files come back as they are."""
    return _element(root) if version < _ATTRIBUTE_VERSION else root


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
