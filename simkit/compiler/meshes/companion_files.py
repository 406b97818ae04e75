"""Files that a mesh names: materials, buffers, pictures. Only those beside it or in its own model are read."""

from __future__ import annotations

import io
import os
import warnings
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

import numpy as np
import numpy.typing as npt

from simkit.compiler.meshes.mesh_part import MeshFileError

if TYPE_CHECKING:
    from PIL.Image import Image as PilImage

LARGEST_COMPANION: Final = 256 << 20
LARGEST_PIXELS: Final = 1 << 26
LARGEST_TEXTURE: Final = 2048
MOST_NOTES: Final = 20
_MANIFESTS: Final = ("model.config", "package.xml", "manifest.xml")
_FORMATS: Final = ("PNG", "JPEG", "TGA", "BMP", "GIF", "TIFF", "WEBP", "DDS", "PPM")

Pixels = npt.NDArray[np.uint8]


class Companions:
    """What one mesh file may read besides itself, what it did read, and what was wrong with it.

    Args:
        file: the mesh file; its folder is where relative names start.

    Attributes:
        read: path -> (size, modification time) of each companion that was asked for; None where it is not there.
        notes: one sentence for each thing that was left out.
    """

    def __init__(self, file: Path) -> None:
        self.file, self.folder = file, file.parent
        self.read: dict[str, tuple[int, int] | None] = {}
        self.notes: list[str] = []
        self._pictures: dict[str, Pixels | None] = {}

    @cached_property
    def _roots(self) -> tuple[Path, Path, Path]:
        """The folders of the model that the file belongs to: as written, really, and that of the real file."""
        written = model_folder(_normal(self.file))
        return written, Path(os.path.realpath(written)), model_folder(Path(os.path.realpath(self.file)))

    def note(self, text: str) -> None:
        if text not in self.notes and len(self.notes) < MOST_NOTES:
            self.notes.append(text)

    def find(self, name: str) -> Path | None:
        """The companion that `name` means, or None where there is none or it lies outside of the mesh's model."""
        name = name.strip().replace("\\", "/")
        if not name or "\0" in name or len(name) > 1000:
            return None
        for scheme in ("model://", "package://"):
            if name.startswith(scheme):
                return self._of_package(name.removeprefix(scheme))
        if name.startswith("file://"):
            name = name.removeprefix("file://")
        elif "://" in name:
            self.note(f"{_short(name)} is not fetched from a network")
            return None
        spelt = dict.fromkeys((name, unquote(name)))
        places = [*spelt, Path(name).name, f"../materials/textures/{Path(name).name}"]
        return self._first([self.folder / place for place in places], name)

    def _of_package(self, rest: str) -> Path | None:
        package, _, inside = unquote(rest).partition("/")
        root = self._roots[0]
        if package != root.name:
            self.note(f"{_short(rest)} belongs to another model and is not read")
            return None
        return self._first([root / inside], rest)

    def _first(self, places: list[Path], name: str) -> Path | None:
        outside = False
        for place in dict.fromkeys(_normal(p) for p in places):
            if not self._is_inside(place):
                outside = True
                continue
            try:
                stat = place.stat()
            except (OSError, ValueError):
                self.read[str(place)] = None
                continue
            if place.is_file():
                self.read[str(place)] = (stat.st_size, stat.st_mtime_ns)
                return place
        self.note(f"{_short(name)} is outside of the model's folder" if outside else f"{_short(name)} is not found")
        return None

    def _is_inside(self, place: Path) -> bool:
        real = Path(os.path.realpath(place))
        return any(_holds(r, place) for r in self._roots) and any(_holds(r, real) for r in self._roots[1:])

    def content(self, name: str) -> bytes | None:
        """A companion's bytes; None, with a note, where it cannot be had."""
        place = self.find(name)
        if place is None:
            return None
        try:
            if place.stat().st_size > LARGEST_COMPANION:
                self.note(f"{_short(name)} is larger than {LARGEST_COMPANION >> 20} MiB")
                return None
            return place.read_bytes()
        except OSError as problem:
            self.note(f"{_short(name)} cannot be read: {problem.strerror}")
            return None

    def picture(self, name: str) -> Pixels | None:
        """A texture by its name; None, with a note, where it cannot be used."""
        if name not in self._pictures:
            content = self.content(name)
            self._pictures[name] = None if content is None else self.picture_in(content, name)
        return self._pictures[name]

    def picture_in(self, content: bytes, name: str) -> Pixels | None:
        try:
            return read_pixels(content)
        except MeshFileError as problem:
            self.note(f"{_short(name)} {problem}")
            return None


def model_folder(file: Path) -> Path:
    """The outermost model or package that a file belongs to, else the parent of its own folder."""
    found = file.parent.parent if len(file.parent.parts) > 2 else file.parent
    for ancestor in (file.parent, *list(file.parents)[1:6]):
        if any((ancestor / name).is_file() for name in _MANIFESTS):
            found = ancestor
    return found


def read_pixels(source: bytes | Path) -> Pixels:
    """A picture as uint8 rows from the top, shape (h, w, 3), not larger than MuJoCo draws comfortably.

    Raises:
        MeshFileError: it is none, or it is too large; the size is known before anything is unpacked.
    """
    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with Image.open(io.BytesIO(source) if isinstance(source, bytes) else source, formats=_FORMATS) as image:
                if image.width * image.height > LARGEST_PIXELS:
                    raise MeshFileError(f"is {image.width}×{image.height} pixels, which is too large")
                image.draft("RGB", (LARGEST_TEXTURE, LARGEST_TEXTURE))
                return _rgb(image)
    except MeshFileError:
        raise
    except Exception as problem:  # noqa: BLE001 -- a decoder of broken data raises whatever it likes
        raise MeshFileError(f"is not a readable picture ({_short(str(problem) or type(problem).__name__)})") from None


def _rgb(image: PilImage) -> Pixels:
    if image.mode.startswith("I") or image.mode == "F":
        grey = np.asarray(image, float)
        most = 65535.0 if image.mode.startswith("I") else max(1e-12, float(np.nanmax(grey)))
        grey = np.clip(np.nan_to_num(grey) / most * 255.0, 0.0, 255.0).astype(np.uint8)
        from PIL import Image

        image = Image.fromarray(grey)
    image = image.convert("RGB")
    image.thumbnail((LARGEST_TEXTURE, LARGEST_TEXTURE))
    return np.asarray(image, np.uint8)


def _normal(path: Path) -> Path:
    return Path(os.path.abspath(path))  # noqa: PTH100 - resolve() would follow links


def _holds(folder: Path, place: Path) -> bool:
    return place == folder or folder in place.parents


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= 120 else text[:117] + "..."
