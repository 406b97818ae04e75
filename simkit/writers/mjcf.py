"""Writer of a compiled world as MJCF with its assets, for MuJoCo alone."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from simkit import progress
from simkit.errors import InputError
from simkit.memory_error import find_memory_error
from simkit.writers.atomic_output import AtomicOutput

if TYPE_CHECKING:
    import mujoco

    from simkit.compiler import SpecBuilder


@dataclass(slots=True)
class WrittenMjcf:
    """Written files.

    Attributes:
        files: number of files in the asset folder.
        balanced: links whose inertia MuJoCo's compiler rejects; the file has the nearest valid inertia.
    """

    path: Path
    files: int = 0
    balanced: list[str] = field(default_factory=list)


def write_mjcf(builder: SpecBuilder, path: Path, *, overwrite: bool = False) -> WrittenMjcf:
    """Write an MJCF file and its folder `<stem>_assets`. Nothing is left behind after an error.

    Args:
        builder: builder of the compiled world.
        path: XML file to write.
        overwrite: replace existing files.

    Raises:
        InputError: SK-CLI-016 a file exists or is not writable, its path is not valid text, or MuJoCo cannot read the
            result.
    """
    _check_text(path)
    writing = progress.task(f"writing {path.name}")
    with AtomicOutput(path, f"{path.stem}_assets", overwrite=overwrite) as staging, writing:
        # work on a copy: file names in the spec of a running simulation would affect later spawns
        spec = builder.spec.copy()
        count = _Assets(spec, staging.folder).write()
        for body in spec.bodies:
            if body.explicitinertial and body.mass > 0 and not np.isfinite(body.ipos[0]):
                body.ipos = (0.0, 0.0, 0.0)  # without a position, the XML would not contain the mass
        spec.modelfiledir = str(staging.file.parent)
        try:
            spec.compile()
            with _full_precision():
                staging.file.write_text(spec.to_xml(), encoding="utf-8")
            _read_back(staging.file)
        except ValueError as error:
            if too_little := find_memory_error(error):
                raise too_little from error
            raise InputError("SK-CLI-016", f"cannot write {path}: MuJoCo reports: {error}") from None
    balanced = [name for record in builder.records.values() for name in record.exact]
    return WrittenMjcf(path, count, balanced)


def _check_text(path: Path) -> None:
    """Raise an error if a path has bytes that are no text, which MuJoCo and XML do not take.

    In an ASCII locale, these are all bytes of letters that are not ASCII.
    """
    try:
        str(path.absolute()).encode()
    except UnicodeEncodeError:
        reason = "MuJoCo needs a path that is valid text in the locale"
        hint = "choose another name and folder, or set LC_ALL=C.UTF-8"
        raise InputError("SK-CLI-016", f"cannot write {path}: {reason}", help=hint) from None


@contextmanager
def _full_precision() -> Iterator[None]:
    """Make MuJoCo write numbers with 17 digits instead of 6, if its library has the private setter."""
    import mujoco

    files = sorted(Path(mujoco.__file__).parent.glob("*mujoco*.*"))
    libraries = [p for p in files if ".so" in p.name or p.suffix in (".dylib", ".dll")]
    try:
        library = ctypes.CDLL(str(libraries[0]))  # returns the already loaded library
        get, set_ = library._mjPRIVATE__get_xml_precision, library._mjPRIVATE__set_xml_precision
    except (IndexError, OSError, AttributeError):
        yield
        return
    original = int(get())
    set_(17)
    try:
        yield
    finally:
        set_(original)


def _read_back(file: Path) -> None:
    """Read the file with MuJoCo; raise ValueError if it is invalid."""
    import mujoco

    mujoco.MjModel.from_xml_path(str(file))


class _Assets:
    """Assets of a specification, each written to its own file."""

    def __init__(self, spec: mujoco.MjSpec, folder: Path) -> None:
        self.spec, self.folder = spec, folder
        self._used_names: set[str] = set()
        self._known: dict[bytes, str] = {}

    def write(self) -> int:
        """Write all assets; return the number of files."""
        spec = self.spec
        self._textures(spec.textures)
        for item in (*spec.meshes, *spec.hfields, *spec.skins):
            if item.file:
                content, stem = self._content(item.file, spec.meshdir), _file_stem(item.name or item.file)
                item.file, item.content_type = self._save(content, stem, Path(item.file).suffix), ""
        spec.meshdir = spec.texturedir = ""
        for name in list(spec.assets):
            del spec.assets[name]
        # assets of attached files have no folder on disk, so the compiler needs them in memory
        spec.assets.update({name: content for content, name in self._known.items()})
        return len(self._used_names)

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
        """Return the bytes of an asset in memory or on disk."""
        content = self.spec.assets.get(file)
        if content is not None:
            return bytes(content)
        folder = Path(self.spec.modelfiledir or ".")
        for path in (Path(file), folder / below / file, folder / file):
            if path.is_file():
                return path.read_bytes()
        raise InputError("SK-CLI-016", f"the asset {file} does not exist any more")

    def _save(self, content: bytes, stem: str, suffix: str) -> str:
        """Write a file under a unique name; return its path relative to the XML file. Equal contents share one file."""
        if content in self._known:
            return self._known[content]
        name, k = f"{stem}{suffix.lower()}", 1
        while name.lower() in self._used_names:
            k += 1
            name = f"{stem}_{k}{suffix.lower()}"
        self._used_names.add(name.lower())
        self.folder.mkdir(exist_ok=True)
        (self.folder / name).write_bytes(content)
        self._known[content] = f"{self.folder.name}/{name}"
        return self._known[content]


def _file_stem(name: str) -> str:
    """Convert a name to a file name (without suffix) that is valid on every operating system."""
    return re.sub(r"[^A-Za-z0-9_-]+", "_", name.rsplit("/", 1)[-1].partition(".")[0]).strip("_")[:80] or "asset"


def _png(texture: mujoco.MjsTexture) -> bytes:
    import cv2

    pixels = np.frombuffer(bytes(texture.data), np.uint8).reshape(texture.height, texture.width, texture.nchannel)
    if texture.height == 6 * texture.width:
        pixels = pixels[: texture.width]  # all six sides of the cube have the same image
    is_encoded, encoded = cv2.imencode(".png", pixels[:, :, ::-1])
    if not is_encoded:
        raise InputError("SK-CLI-016", f"cannot write the texture {texture.name}")
    return bytes(encoded.tobytes())
