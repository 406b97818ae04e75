"""Reader of `<material>`: colours and textures by name, Gazebo's own names and `<visual>` extensions."""

from __future__ import annotations

from dataclasses import dataclass, field

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.gazebo_materials import gazebo_colours, gazebo_materials
from simkit.loaders.sdf.material import read_material
from simkit.loaders.urdf.element_attributes import (
    extension_text,
    leading_numbers,
    report_missing,
    report_substitute,
    text_attribute,
)
from simkit.loaders.urdf.gazebo_extensions import last_child
from simkit.loaders.urdf.robot_draft import RobotDraft
from simkit.params import Params
from simkit.scene import Material
from simkit.scene.model import Colour


@dataclass
class Materials:
    """Named materials of one robot: materials in `<robot>`, and materials that a visual defines."""

    draft: RobotDraft
    named: dict[str, Material] = field(default_factory=dict)
    _lines: dict[str, int | None] = field(default_factory=dict)
    _unknown: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        for element in self.draft.element.all("material"):
            name = text_attribute(element, "name")
            if not name:
                report_missing(element, "name", "a text")
            elif name in self._lines:
                message = f"two materials are named {name!r}; the one at line {self._lines[name]} is used"
                element.warning("SK-URDF-026", message)
                element.mark_all_read()
                continue
            self._define(name, element)
        for link in self.draft.links.values():
            for visual in link.all("visual"):
                inside = visual.child("material")
                if inside is not None and _has_own_look(inside):
                    name = text_attribute(inside, "name")
                    if name not in self.named:
                        self._define(name, inside)

    def of(self, visual: Params) -> Material | None:
        """Return the material of a visual; None if it has none (a mesh then keeps its own colours)."""
        element = visual.child("material")
        if element is None:
            return None
        name = text_attribute(element, "name")
        material = self._read(element)
        if material is not None:
            return material
        if name in self.named:
            return self.named[name]
        if name.startswith("Gazebo/") and (known := gazebo_colours(name)):
            return Material(known["diffuse"], known["diffuse"])
        if name and name not in self._unknown and name not in self._lines and not _has_own_look(element):
            self._unknown.add(name)
            message = f"material {name!r} is not defined; a mesh keeps its own colours, a shape is drawn white"
            element.warning("SK-URDF-026", message, did_you_mean(name, [*self.named, *gazebo_materials()]))
        return None

    def _define(self, name: str, element: Params) -> None:
        self._lines.setdefault(name, element.where.line)
        material = self._read(element)
        if material is not None and name:
            self.named[name] = material

    def _read(self, element: Params) -> Material | None:
        """Return the colour and texture in an element; None if both are missing."""
        colour, texture = element.child("color"), element.child("texture")
        rgba: Colour | None = None
        if colour is not None:
            numbers = leading_numbers(colour, "rgba", 4, "red green blue alpha")
            if numbers is None and "rgba" not in colour.attributes:
                report_substitute(colour, "<color> has no rgba= (red green blue alpha)", "the colour is left out")
            if numbers is not None:
                clamped = [min(1.0, max(0.0, v)) for v in numbers]
                if clamped != list(numbers):
                    text = f'<color rgba="{text_attribute(colour, "rgba")[:60]}"> has numbers outside 0 to 1'
                    report_substitute(colour, text, "they are limited to this range")
                rgba = (clamped[0], clamped[1], clamped[2], clamped[3])
        path = None
        if texture is not None:
            uri = text_attribute(texture, "filename")
            if not uri:
                message = "<texture> names no file (filename=); the visual is drawn without the texture"
                texture.warning("SK-URI-006", message)
            path = self.draft.assets.texture(uri, texture) if uri else None
        if rgba is None and path is None:
            return None
        base = rgba or (1.0, 1.0, 1.0, 1.0)
        return Material(base, base, texture=path)


def _has_own_look(element: Params) -> bool:
    return element.has("color") or element.has("texture")


def extended_material(extension: Params, written: Material | None, draft: RobotDraft) -> Material | None:
    """Return a visual's material with its `<gazebo>` extensions: a script name, or SDF elements in `<visual>`."""
    script = last_child(extension, "material")
    if script is not None:
        element = _as_sdf(script) if not script.children else Params("visual", children=[script])
        element.diagnostics = script.diagnostics
        written = read_material(element, draft.file, draft.workspace) or written
    for block in extension.all("visual"):
        written = read_material(block, draft.file, draft.workspace) or written
    return written


def _as_sdf(element: Params) -> Params:
    """Convert `<material>Gazebo/Red</material>` to SDF."""
    inner = Params("name", extension_text(element), where=element.where, diagnostics=element.diagnostics)
    for name in ("script", "material", "visual"):
        inner = Params(name, children=[inner], where=element.where, diagnostics=element.diagnostics)
    return inner
