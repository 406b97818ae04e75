"""Changes of a world, made by rule from what its files say: ones that matter, and ones that do not.

Every number, switch and word of every element of every file, every mesh, and every element that may be left out is a
candidate; what kind of thing it is follows from where it stands. Of each kind one is drawn.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from lxml import etree

_ANGLE, _LENGTH, _PART, _NOISE = math.radians(1.0), 0.002, 0.01, 0.2
_LENGTHS = frozenset(
    ("radius", "length", "size", "wheel_radius", "wheel_separation", "wheel_diameter", "min", "max", "near", "far")
)
_ANGLES = frozenset(("horizontal_fov", "min_angle", "max_angle", "heading_deg"))
_RATES = re.compile(r".*(update_rate|publish_rate|_frequency|odom_publish_frequency)$")
_NOISES = frozenset(("stddev", "mean", "bias_mean", "bias_stddev", "dynamic_bias_stddev"))
# said for people or other programs only: no output can show them
_MUTE = frozenset(
    ("description", "author", "name", "email", "visualize", "always_on", "real_time_factor", "real_time_update_rate")
)


@dataclass(frozen=True)
class Change:
    """One change of one file.

    Attributes:
        kind: where in a file it stands, without names: `collision/geometry/cylinder/radius`.
        file: relative to the world's folder.
        words: what was done.
        content: of the changed file.
        line: where it stands in the changed file; 0 in what has no lines.
        named: of the element, and of one that only groups it, with a blank between; then the names of its owners, or of
            the file, from within.
        new: the new value as written; empty where there is none.
    """

    kind: str
    file: Path
    words: str
    content: bytes
    line: int
    named: tuple[str, ...]
    new: str = ""


def changes(folder: Path, seed: int, each: int = 1) -> list[Change]:
    """Changes that matter, of each kind so many, drawn by `seed`."""
    kinds: dict[str, list[Change]] = {}
    for change in [*_of_documents(folder), *_of_meshes(folder)]:
        kinds.setdefault(change.kind, []).append(change)
    draw = random.Random(seed)
    return [one for kind in sorted(kinds) for one in draw.sample(kinds[kind], min(each, len(kinds[kind])))]


def _of_documents(folder: Path) -> Iterator[Change]:
    for file in sorted([*folder.rglob("*.sdf"), *folder.rglob("*.urdf")]):
        text = file.read_bytes()
        count = sum(1 for _ in etree.fromstring(text).iter("*"))
        for number in range(count):
            yield from _of_element(text, number, file.relative_to(folder))


def _of_element(text: bytes, number: int, file: Path) -> Iterator[Change]:
    """The changes of one element, each in a tree of its own."""
    element = _nth(text, number)
    tag = _tag(element)
    if element.get("name") and tag in ("sensor", "collision", "plugin", "light") and element.getparent() is not None:
        name = element.get("name")
        element.getparent().remove(element)
        yield Change(f"without {tag}", file, f"{tag} {name} left out", _written(element), 0, (name, tag))
        element = _nth(text, number)
    if file.suffix == ".urdf" and _path(element)[:2] != ("robot", "material"):  # those are used by name, or not
        yield from _of_attributes(text, number, file)
    said = (element.text or "").strip()
    if len(element) or not said or tag in _MUTE or _path(element)[:1] == ("model.config",):
        return
    for new, words in _other(element, tag, said):
        element.text = new
        content = _written(element)
        line = _nth(content, number).sourceline or 0
        kind = "/".join(_path(element)[-4:])
        yield Change(f"{kind}{words and ' ' + words}", file, f"{said} → {new}", content, line, _named(element), new)
        element = _nth(text, number)


def _of_attributes(text: bytes, number: int, file: Path) -> Iterator[Change]:
    """Every number that an element of a URDF has as an attribute."""
    for name, said in _nth(text, number).items():
        element = _nth(text, number)
        for new, words in _other(element, {"xyz": "pose", "rpy": "pose"}.get(name, name), said):
            element.set(name, new)
            content = _written(element)
            line = _nth(content, number).sourceline or 0
            kind = "/".join(["urdf", *_path(element)[-2:], name])
            own, *around = _named(element)
            named = (f"{name} {own}", *around)
            yield Change(f"{kind}{words and ' ' + words}", file, f"{said} → {new}", content, line, named, new)


def _other(element: etree._Element, tag: str, said: str) -> Iterator[tuple[str, str]]:
    """Other values that an element may have, of a size that matters."""
    parts = said.split()
    numbers = [_number(part) for part in parts]
    if said in ("true", "false", "0", "1") and said in ("true", "false"):
        yield ("false" if said == "true" else "true"), ""
    elif None in numbers:
        return
    elif tag == "pose" and len(numbers) >= 3:
        yield _joined(numbers, 0, numbers[0] + _LENGTH), "moved"
        if len(numbers) == 6:
            yield _joined(numbers, 5, numbers[5] + _ANGLE), "turned"
    elif tag in ("xyz", "gravity", "direction", "magnetic_field"):
        place = numbers.index(0.0) if 0.0 in numbers else 0  # of a direction the length means nothing
        yield _joined(numbers, place, numbers[place] + 0.02), ""
    elif len(numbers) == 1:
        value = numbers[0]
        if _RATES.match(tag):
            yield f"{value + 1:.9g}", ""
        elif tag in _ANGLES:
            yield f"{value + _ANGLE:.9g}", ""
        elif tag in _NOISES:
            yield f"{value * (1 + _NOISE) if value else 0.001:.9g}", ""
        elif re.fullmatch(r"\d+", said) and tag in ("samples", "width", "height", "resolution"):
            yield f"{value + 1:.0f}", ""
        elif tag in _LENGTHS:
            yield f"{value * (1 + _PART):.9g}", ""
        elif re.fullmatch(r"[+-]?\d*\.\d*(e[+-]?\d+)?", said):
            yield f"{value * 1.05 if value else 0.01:.9g}", ""
    elif len(numbers) in (2, 3, 4) and element.getparent() is not None:
        first = numbers[0]
        yield _joined(numbers, 0, first * (1 + _PART) if tag in _LENGTHS else first * 0.9 + 0.013), ""


def _of_meshes(folder: Path) -> Iterator[Change]:
    """Each mesh one hundredth longer along x."""
    for file in sorted(folder.rglob("*.obj")):
        lines = file.read_text(encoding="utf-8").splitlines()
        grown = [_grown(line) if line.startswith("v ") else line for line in lines]
        content = ("\n".join(grown) + "\n").encode()
        yield Change(
            "mesh longer", file.relative_to(folder), f"{file.name} 1 % longer", content, 0, (file.name, file.stem)
        )


def harmless(folder: Path, seed: int) -> Iterator[tuple[str, dict[Path, bytes]]]:
    """Changes that nobody may notice: name, and the files that are other."""
    draw = random.Random(seed)
    documents = {file.relative_to(folder): file.read_bytes() for file in sorted(folder.rglob("*.sdf"))}
    world = next(file for file in documents if len(file.parts) == 1)
    text = documents[world]
    yield (
        "comments",
        {f: re.sub(rb"(<(?:link|model|world)\b[^>]*>)", rb"\1<!-- seen -->", t) for f, t in documents.items()},
    )
    yield "blank lines and indents", {f: re.sub(rb">\s*\n\s*<", b">\n\n\t<", t) for f, t in documents.items()}
    yield "numbers written otherwise", {f: re.sub(rb">(\d+\.\d+)<", _longer, t) for f, t in documents.items()}
    yield "order of unrelated models", {world: _shuffled(text, draw)}
    robots = {file.relative_to(folder): file.read_bytes() for file in sorted(folder.rglob("*.urdf"))}
    if robots:
        yield "an unused material renamed", {f: t.replace(b'"spare"', b'"spare_blue"') for f, t in robots.items()}
    yield "a file more in the folder", {Path("meshes/spare.obj"): b"v 0 0 0\n"}
    yield (
        "attributes in single quotes",
        {f: re.sub(rb'name="([^"\']*)"', rb"name='\1'", t) for f, t in documents.items()},
    )


def _longer(found: re.Match[bytes]) -> bytes:
    return b">" + repr(float(found[1])).encode() + b"0<" if b"e" not in repr(float(found[1])).encode() else found[0]


def _shuffled(text: bytes, draw: random.Random) -> bytes:
    """The models and includes of a world in another order."""
    root = etree.fromstring(text)
    world = root.find("world")
    assert world is not None
    places = [i for i, one in enumerate(world) if one.tag in ("model", "include")]
    moved = [world[i] for i in places]
    draw.shuffle(moved)
    order = list(world)
    for place, one in zip(places, moved, strict=True):
        order[place] = one
    for one in order:
        world.remove(one)
    world.extend(order)
    return etree.tostring(root)


def _named(element: etree._Element) -> tuple[str, ...]:
    """The names around an element, its own tag included."""
    names = [_tag(element).removesuffix("_deg")]
    above = element.getparent()
    if _tag(element) == "origin" and above is not None and above.find("child") is not None:
        names.append(above.find("child").get("link"))  # what a joint's origin moves
    if above is not None and not above.get("name"):
        names[0] += f" {_tag(above)}"
    if above is not None and above.find("uri") is not None:  # what is included goes by its file's name
        names.append(Path(str(above.findtext("uri"))).stem)
    while above is not None:
        if above.get("name"):
            names.append(above.get("name"))
        above = above.getparent()
    return tuple(names)


def _path(element: etree._Element) -> tuple[str, ...]:
    path = [_tag(element)]
    above = element.getparent()
    while above is not None:
        kind = above.get("type") if above.tag == "sensor" else above.get("filename") if above.tag == "plugin" else None
        path.append(f"{_tag(above)}({kind})" if kind else _tag(above))
        above = above.getparent()
    return tuple(reversed(path))


def _nth(text: bytes, number: int) -> etree._Element:
    return list(etree.fromstring(text).iter("*"))[number]


def _written(element: etree._Element) -> bytes:
    return etree.tostring(element.getroottree())


def _tag(element: etree._Element) -> str:
    return etree.QName(element).localname


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _joined(numbers: list[float | None], place: int, value: float) -> str:
    return " ".join(f"{value if i == place else one:.9g}" for i, one in enumerate(numbers))


def _grown(line: str) -> str:
    _, x, *rest = line.split()
    return " ".join(["v", f"{float(x) * (1 + _PART):.9g}", *rest])
