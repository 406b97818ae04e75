"""Write the compiled world as MJCF with its assets, for MuJoCo alone."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from simkit.errors import InputError
from simkit.writers.atomic_output import AtomicOutput

if TYPE_CHECKING:
    import mujoco

    from simkit.compiler import SpecBuilder


@dataclass(slots=True)
class WrittenMjcf:
    """Files that were written.

    Attributes:
        files: how many files lie in the folder beside the XML.
        balanced: links whose inertia MuJoCo's compiler refuses; the file has the nearest that it takes.
    """

    path: Path
    files: int = 0
    balanced: list[str] = field(default_factory=list)


def write_mjcf(builder: SpecBuilder, path: Path, *, overwrite: bool = False) -> WrittenMjcf:
    """Write `path` and the folder `<stem>_assets` beside it. Nothing is left behind when it fails.

    Args:
        builder: of the compiled world.
        path: of the XML file.
        overwrite: whether older files may be replaced.

    Raises:
        InputError: SK-CLI-016 something is there already, it cannot be written, or MuJoCo cannot read it back.
    """
    with AtomicOutput(path, f"{path.stem}_assets", overwrite=overwrite) as staging:
        # A copy: naming files in the spec of a running simulation would change what a later spawn compiles.
        spec = builder.spec.copy()
        count = _Assets(spec, staging.folder).write()
        for body in spec.bodies:
            if body.explicitinertial and body.mass > 0 and not np.isfinite(body.ipos[0]):
                body.ipos = (0.0, 0.0, 0.0)  # without a place the XML would not say what it weighs
        spec.modelfiledir = str(staging.file.parent)
        try:
            spec.compile()
            with _full_precision():
                staging.file.write_text(spec.to_xml(), encoding="utf-8")
            _read_back(staging.file)
        except ValueError as error:
            raise InputError(f"SK-CLI-016 cannot write {path}: MuJoCo says: {error}", "SK-CLI-016") from None
    balanced = [name for record in builder.records.values() for name in record.exact]
    return WrittenMjcf(path, count, balanced)


@contextmanager
def _full_precision() -> Iterator[None]:
    """Lets MuJoCo write numbers with 17 digits instead of 6, where its library has a way to be told."""
    import mujoco

    found = sorted(Path(mujoco.__file__).parent.glob("*mujoco*.*"))
    libraries = [p for p in found if ".so" in p.name or p.suffix in (".dylib", ".dll")]
    try:
        library = ctypes.CDLL(str(libraries[0]))  # the one that is loaded already
        get, put = library._mjPRIVATE__get_xml_precision, library._mjPRIVATE__set_xml_precision
    except (IndexError, OSError, AttributeError):
        yield
        return
    usual = int(get())
    put(17)
    try:
        yield
    finally:
        put(usual)


def _read_back(file: Path) -> None:
    """Raises ValueError where MuJoCo cannot open the file."""
    import mujoco

    mujoco.MjModel.from_xml_path(str(file))


class _Assets:
    """Gives every asset of a specification a file of its own."""

    def __init__(self, spec: mujoco.MjSpec, folder: Path) -> None:
        self.spec, self.folder = spec, folder
        self._taken: set[str] = set()
        self._known: dict[bytes, str] = {}

    def write(self) -> int:
        """Writes them all; returns how many files there are."""
        spec = self.spec
        self._textures(spec.textures)
        for item in (*spec.meshes, *spec.hfields, *spec.skins):
            if item.file:
                content, stem = self._content(item.file, spec.meshdir), _file_stem(item.name or item.file)
                item.file, item.content_type = self._save(content, stem, Path(item.file).suffix), ""
        spec.meshdir = spec.texturedir = ""
        for name in list(spec.assets):
            del spec.assets[name]
        # what an attached file brought has no folder of its own to be found in: it stays in memory for the compile
        spec.assets.update({name: content for content, name in self._known.items()})
        return len(self._taken)

    def _textures(self, textures: Iterable[mujoco.MjsTexture]) -> None:
        for texture in textures:
            sides = list(texture.cubefiles) if any(texture.cubefiles) else []
            if texture.file:
                content = self._content(texture.file, self.spec.texturedir)
                texture.file = self._save(content, _file_stem(texture.name), Path(texture.file).suffix)
                texture.content_type = ""
            elif sides:
                for i, side in enumerate(sides):
                    if side:
                        content = self._content(side, self.spec.texturedir)
                        texture.cubefiles[i] = self._save(content, f"{_file_stem(texture.name)}_{i}", Path(side).suffix)
            elif len(texture.data):
                texture.file = self._save(_png(texture), _file_stem(texture.name), ".png")
                texture.data = b""
                texture.width = texture.height = 0
                texture.nchannel = 3

    def _content(self, file: str, below: str) -> bytes:
        """The bytes of an asset in memory or on disk."""
        held = self.spec.assets.get(file)
        if held is not None:
            return bytes(held)
        at = Path(self.spec.modelfiledir or ".")
        for place in (Path(file), at / below / file, at / file):
            if place.is_file():
                return place.read_bytes()
        raise InputError(f"SK-CLI-016 the asset {file} is not there any more", "SK-CLI-016")

    def _save(self, content: bytes, stem: str, suffix: str) -> str:
        """Writes a file under a name that no other has; equal contents are one file. Returns the path from the XML."""
        if content in self._known:
            return self._known[content]
        name, k = f"{stem}{suffix.lower()}", 1
        while name.lower() in self._taken:
            k += 1
            name = f"{stem}_{k}{suffix.lower()}"
        self._taken.add(name.lower())
        self.folder.mkdir(exist_ok=True)
        (self.folder / name).write_bytes(content)
        self._known[content] = f"{self.folder.name}/{name}"
        return self._known[content]


def _file_stem(name: str) -> str:
    """A file name without ending that every system takes."""
    return re.sub(r"[^A-Za-z0-9_-]+", "_", name.rsplit("/", 1)[-1].partition(".")[0]).strip("_")[:80] or "asset"


def _png(texture: mujoco.MjsTexture) -> bytes:
    import cv2

    pixels = np.frombuffer(bytes(texture.data), np.uint8).reshape(texture.height, texture.width, texture.nchannel)
    if texture.height == 6 * texture.width:
        pixels = pixels[: texture.width]  # the six sides of a cube are the same picture
    done, encoded = cv2.imencode(".png", pixels[:, :, ::-1])
    if not done:
        raise InputError(f"SK-CLI-016 the texture {texture.name} cannot be written", "SK-CLI-016")
    return bytes(encoded.tobytes())
