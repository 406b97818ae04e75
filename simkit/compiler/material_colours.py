"""Colours of the file in the words of MuJoCo's lighting: one colour, and how much of it shines, mirrors and glows.

The renderer lights every surface as diffuse + specular + emission in the style of OpenGL. The ambient colour of a
material is not separate there: it is the diffuse one. Where a file's is darker or brighter than that, emission makes up
for it under the scene's own ambient light (it may be negative), as Gazebo Classic would have it; a hue of its own it
cannot have. PBR's roughness sets the size of highlights; metalness and further maps have no counterpart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from simkit.compiler.meshes.mesh_part import Colour, MeshPart
from simkit.scene import Material, SceneVisual

PLAIN: Final[Colour] = (0.7, 0.7, 0.7, 1.0)
_SHININESS: Final = 0.3


@dataclass(frozen=True, slots=True)
class GeomColours:
    """A geom's colour, and its material's shares from 0 to 1.

    Attributes:
        ambient: brightness under ambient light, in parts of that of its colour; 1 is as bright.
    """

    rgba: tuple[float, float, float, float]
    emission: float = 0.0
    specular: float = 0.0
    shininess: float = _SHININESS
    ambient: float = 1.0

    def emission_under(self, ambient: Colour) -> float:
        """Emission that makes up for a material's own ambient colour under the scene's ambient light."""
        return self.emission + (self.ambient - 1.0) * brightness(ambient)


def geom_colours(visual: SceneVisual, part: MeshPart | None) -> GeomColours:
    """How a visual (or one part of its mesh) looks; the file's material wins over the mesh's own."""
    material = visual.material
    emission, specular, shininess, ambient = 0.0, 0.0, _SHININESS, 1.0
    if material is not None:
        colour, emission = _glowing(material)
        specular, ambient = max(material.specular[:3]), _ambient_share(material)
        if material.shininess is not None:
            shininess = min(1.0, material.shininess / 128.0)
        elif material.roughness is not None:
            shininess = 1.0 - min(1.0, max(0.0, material.roughness))
    elif part is not None:
        colour = part.colour or PLAIN
        emission, specular = part.emission, part.specular
    else:
        colour = PLAIN
    r, g, b, a = colour
    a *= 1.0 - min(1.0, max(0.0, visual.transparency))
    if (r, g, b, a) == (0.5, 0.5, 0.5, 1.0):
        r = 0.5001  # exactly MuJoCo's default would be taken for "not given"
    return GeomColours((r, g, b, a), min(1.0, emission), min(1.0, specular), shininess, ambient)


def _ambient_share(material: Material) -> float:
    """How bright the ambient colour is, in parts of the diffuse one; 1 where that is black or what glows decides."""
    own = brightness(material.diffuse)
    if own <= 0.0 or brightness(material.emissive) > own:
        return 1.0
    return brightness(material.ambient) / own


def _glowing(material: Material) -> tuple[Colour, float]:
    """Colour and emission: MuJoCo glows in the surface's own colour, so what glows more than it shines keeps that."""
    own, glow = brightness(material.diffuse), brightness(material.emissive)
    if glow <= 0.0:
        return material.diffuse, 0.0
    if glow > own:
        strongest = max(material.emissive[:3])
        r, g, b = (c / strongest for c in material.emissive[:3])
        return (r, g, b, material.diffuse[3]), strongest
    return material.diffuse, glow / own


def brightness(colour: Colour) -> float:
    """Relative luminance of linear red, green and blue (Rec. 709)."""
    return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]
