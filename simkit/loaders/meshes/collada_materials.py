"""Materials of a COLLADA file: colour, opacity and texture of its effects."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from simkit.loaders.meshes.companion_files import Companions, Pixels
from simkit.loaders.meshes.mesh_part import Colour

XmlElement = Any
"""Element of lxml."""

_SHADERS: Final = ("phong", "lambert", "blinn", "constant")


@dataclass(frozen=True)
class MaterialLook:
    """Appearance of a part of the mesh; `colour` is None if the file does not specify it."""

    colour: Colour | None = None
    texture: Pixels | None = None
    specular: float = 0.0
    emission: float = 0.0


class ColladaMaterials:
    """Materials of one document, read on first use."""

    def __init__(self, by_id: dict[str, XmlElement], companions: Companions) -> None:
        self.by_id, self.companions = by_id, companions
        self._read: dict[str, MaterialLook] = {}

    def of(self, material: str) -> MaterialLook:
        """Return the appearance of a material by its id; the default for an unknown id."""
        if material not in self._read:
            self._read[material] = self._look(self.by_id.get(material))
        return self._read[material]

    def _look(self, material: XmlElement) -> MaterialLook:
        if material is None:
            return MaterialLook()
        instance = material.find("{*}instance_effect")
        effect = self.by_id.get(instance.get("url", "").lstrip("#")) if instance is not None else None
        if effect is None:
            return MaterialLook()
        for kind in _SHADERS:
            shader = effect.find(f".//{{*}}profile_COMMON//{{*}}{kind}")
            if shader is not None:
                return self._shaded(shader, effect, kind)
        return MaterialLook()

    def _shaded(self, shader: XmlElement, effect: XmlElement, kind: str) -> MaterialLook:
        colour = self._colour(shader, "emission" if kind == "constant" else "diffuse")
        texture = self._texture(shader.find("{*}diffuse"), effect)
        emission, specular = self._colour(shader, "emission"), self._colour(shader, "specular")
        if texture is not None and colour is None:
            colour = (1.0, 1.0, 1.0, 1.0)
        if colour is not None:
            colour = (*colour[:3], self._opacity(shader, colour[3]))
        bright = 0.0
        if emission is not None and kind != "constant":
            bright = 0.2126 * emission[0] + 0.7152 * emission[1] + 0.0722 * emission[2]
        return MaterialLook(colour, texture, max(specular[:3]) if specular else 0.0, bright)

    def _colour(self, shader: XmlElement, name: str) -> Colour | None:
        colour = shader.find(f"{{*}}{name}/{{*}}color")
        if colour is None:
            return None
        try:
            numbers = [min(1.0, max(0.0, float(v))) for v in (colour.text or "").split()[:4]]
        except ValueError:
            numbers = []
        if len(numbers) < 3 or any(v != v for v in numbers):
            self.companions.note(f"has a material whose {name} is not a colour")
            return None
        r, g, b = numbers[:3]
        return r, g, b, numbers[3] if len(numbers) > 3 else 1.0

    def _opacity(self, shader: XmlElement, alpha: float) -> float:
        """Return the opacity of an effect.

        In the mode A_ONE (the default) it is the alpha of `transparent`, in the mode RGB_ZERO one minus its brightness.
        Some exporters write transparency instead of opacity. Therefore a result that is (nearly) invisible is drawn
        opaque.
        """
        transparent, amount = shader.find("{*}transparent"), shader.find("{*}transparency/{*}float")
        if transparent is None and amount is None:
            return alpha if alpha > 0.01 else 1.0
        try:
            share = 1.0 if amount is None else float(amount.text or "1")
        except ValueError:
            share = 1.0
        colour = self._colour(shader, "transparent") or (1.0, 1.0, 1.0, 1.0)
        mode = "A_ONE" if transparent is None else transparent.get("opaque", "A_ONE")
        if mode == "RGB_ZERO":
            opacity = 1.0 - (0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]) * share
        elif mode == "RGB_ONE":
            opacity = (0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]) * share
        else:
            opacity = colour[3] * share
        return opacity if 0.01 < opacity <= 1.0 else 1.0

    def _texture(self, diffuse: XmlElement, effect: XmlElement) -> Pixels | None:
        """Return the image of `<texture>`: by its sampler and surface, or directly by the image's id."""
        used = None if diffuse is None else diffuse.find("{*}texture")
        if used is None:
            return None
        name = used.get("texture", "")
        parameters = {e.get("sid"): e for e in effect.iter("{*}newparam")}
        for _ in range(3):
            parameter = parameters.get(name)
            if parameter is None:
                break
            source = parameter.find(".//{*}source")
            source = parameter.find(".//{*}init_from") if source is None else source
            instance = parameter.find(".//{*}instance_image")
            following = instance.get("url", "").lstrip("#") if instance is not None else None
            following = (source.text or "").strip() if source is not None and following is None else following
            if not following or following == name:
                break
            name = following
        image = self.by_id.get(name)
        start = None if image is None else image.find("{*}init_from")
        if start is None:
            self.companions.note(f"has a texture {name[:80]!r} without a picture")
            return None
        reference = start.find("{*}ref")
        return self.companions.picture(((start if reference is None else reference).text or "").strip())
