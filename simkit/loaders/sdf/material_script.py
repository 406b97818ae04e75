"""Reader of OGRE material scripts (`.material`) named in a visual's `<script><uri>`: colours, texture, inheritance.

The first value of each kind in a script's techniques and passes is used. Shaders, animations and blending are ignored.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Final

from simkit.input_file import read_input_text
from simkit.loaders.sdf.gazebo_materials import gazebo_colours
from simkit.scene.model import Colour
from simkit.trusted_folders import join_within

_LARGEST_SCRIPT: Final = 1 << 20
_MOST_SCRIPTS: Final = 200
_DEEPEST: Final = 16
_COLOURS: Final = ("ambient", "diffuse", "specular", "emissive")
_TOKEN: Final = re.compile(r'//[^\n]*|/\*.*?(?:\*/|\Z)|"[^"\n]*"|[{}]|[^\s{}"]+|\n', re.DOTALL)


@dataclass(frozen=True)
class OgreMaterial:
    """Material of a script; `colours` has only the colours that the script gives.

    Attributes:
        parent: name of the material that it inherits from.
        texture: file name of an image.
        folder: folder of the script.
        is_transparent: true if it uses alpha blending.
        scale: size of the image, across and up; None if the script gives none.
    """

    name: str
    folder: Path
    parent: str = ""
    colours: dict[str, Colour] = field(default_factory=dict)
    texture: str = ""
    is_transparent: bool = False
    is_double_sided: bool = False
    scale: tuple[float, float] | None = None


def find_material(name: str, places: Sequence[Path], allows: Callable[[Path], bool]) -> OgreMaterial | None:
    """Return the material of that name in script files and folders, with inherited values; None if there is none.

    Args:
        name: name of the material.
        places: script files, and folders with such files.
        allows: checks whether a file may be read; a file behind a link out of the user's folders may not.
    """
    known: dict[str, OgreMaterial] = {}
    for script in filter(allows, _scripts(places)):
        for material in _materials(script):
            known.setdefault(material.name, material)
    script_material = known.get(name)
    seen = {name}
    while script_material is not None and script_material.parent and script_material.parent not in seen:
        seen.add(script_material.parent)
        above = known.get(script_material.parent)
        if above is None:
            return replace(
                script_material,
                parent="",
                colours={**gazebo_colours(script_material.parent), **script_material.colours},
            )
        script_material = replace(
            script_material,
            parent=above.parent,
            colours={**above.colours, **script_material.colours},
            texture=script_material.texture or above.texture,
            is_transparent=script_material.is_transparent or above.is_transparent,
            is_double_sided=script_material.is_double_sided or above.is_double_sided,
            scale=script_material.scale or above.scale,
        )
    return script_material


def find_texture(material: OgreMaterial, places: Sequence[Path], allows: Callable[[Path], bool]) -> Path | None:
    """Return the image that a material names: in the given folders, beside its script, or in `../textures`.

    Args:
        material: material of a script.
        places: script files, and folders with such files.
        allows: checks whether a file may be read; a file behind a link out of the user's folders may not.
    """
    folders = [p if p.is_dir() else p.parent for p in places]
    folders += [material.folder, material.folder.parent / "textures"]
    name = material.texture.replace("\\", "/")
    for folder in dict.fromkeys(folders):
        path = join_within([folder], folder, name)
        if path is not None and path.is_file() and allows(path):
            return path
    return None


def _scripts(places: Sequence[Path]) -> list[Path]:
    files: list[Path] = []
    for place in places:
        try:
            files += sorted(place.glob("*.material"))[:_MOST_SCRIPTS] if place.is_dir() else [place]
        except OSError:
            continue
    return [f for f in dict.fromkeys(files) if f.suffix == ".material"][:_MOST_SCRIPTS]


def _materials(file: Path) -> tuple[OgreMaterial, ...]:
    try:
        stat = file.stat()
        return _parsed(file, stat.st_mtime_ns)
    except OSError:
        return ()


@lru_cache(maxsize=256)
def _parsed(file: Path, _version: int) -> tuple[OgreMaterial, ...]:
    text = read_input_text(file, _LARGEST_SCRIPT, errors="replace")
    return tuple(_read(list(_lines(text)), file.parent))


def _lines(text: str) -> Iterator[list[str]]:
    """Yield the words of the script line by line; each brace is a line of its own."""
    line: list[str] = []
    for match in _TOKEN.finditer(text):
        word = match.group()
        if word.startswith(("//", "/*")):
            continue
        if word == "\n" or word in "{}":
            if line:
                yield line
            line = []
            if word != "\n":
                yield [word]
        else:
            line.append(word.strip('"'))
    if line:
        yield line


def _read(lines: list[list[str]], folder: Path) -> Iterator[OgreMaterial]:
    depth, current, header = 0, None, None
    for words in lines:
        if words == ["{"]:
            depth += 1
            if header is not None and depth == 1:
                current, header = header, None
        elif words == ["}"]:
            depth = max(0, depth - 1)
            if depth == 0 and current is not None:
                yield current
                current = None
        elif depth == 0:
            header = _header(words, folder)
        elif current is not None and depth <= _DEEPEST:
            current = _apply_line(current, words)
    if current is not None:
        yield current


def _header(words: list[str], folder: Path) -> OgreMaterial | None:
    """Parse `[abstract] material NAME [: PARENT]`."""
    words = words[1:] if words[0] == "abstract" else words
    if words[0] != "material" or len(words) < 2:
        return None
    name, _, parent = " ".join(words[1:]).partition(":")
    return OgreMaterial(name.strip(), folder, parent.strip())


def _apply_line(material: OgreMaterial, words: list[str]) -> OgreMaterial:
    key, *values = words
    if key in _COLOURS and key not in material.colours:
        colour = _colour(values, 3 if key == "specular" and len(values) == 4 else 4)
        return material if colour is None else replace(material, colours={**material.colours, key: colour})
    if key == "texture" and values and not material.texture:
        return replace(material, texture=values[0])
    if key == "set_texture_alias" and len(values) == 2:
        return replace(material, texture=values[1])
    if key == "scale" and material.scale is None:
        return replace(material, scale=_scale(values))
    if key == "scene_blend" and values[:1] == ["alpha_blend"]:
        return replace(material, is_transparent=True)
    if key == "cull_hardware" and values[:1] == ["none"]:
        return replace(material, is_double_sided=True)
    return material


def _scale(values: list[str]) -> tuple[float, float] | None:
    try:
        across, up = (float(v) for v in values)
    except ValueError:
        return None
    return (across, up) if all(1e-6 <= abs(v) <= 1e6 for v in (across, up)) else None


def _colour(values: list[str], most: int) -> Colour | None:
    """Parse red, green, blue and alpha (by default 1) from the first `most` numbers.

    `most` is 3 for a specular colour of four numbers, because its last number is the shininess.
    """
    try:
        numbers = [min(1.0, max(0.0, float(v))) for v in values[:most]]
    except ValueError:
        return None
    if len(numbers) < 3 or any(v != v for v in numbers):
        return None
    return numbers[0], numbers[1], numbers[2], numbers[3] if len(numbers) > 3 else 1.0
