"""Companion files of a mesh: materials, buffers, images. Only files in the mesh's folder or model are read."""

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

from simkit.input_file import read_input
from simkit.loaders.meshes.mesh_part import MeshFileError, check_is_fetched
from simkit.loaders.resources.project_folder import readable_folder
from simkit.loaders.resources.uris import absolute_path, path_of_file_uri, split_rest
from simkit.project_folder import is_top_folder
from simkit.trusted_folders import OutsideError, TrustedFolders, join_below, join_within

if TYPE_CHECKING:
    from PIL.Image import Image as PilImage

LARGEST_COMPANION: Final = 256 << 20
LARGEST_PIXELS: Final = 1 << 26
LARGEST_TEXTURE: Final = 2048
MOST_NOTES: Final = 20
_MANIFESTS: Final = ("model.config", "package.xml", "manifest.xml")
_PNG: Final = b"\x89PNG\r\n\x1a\n"
_FORMATS: Final = ("PNG", "JPEG", "TGA", "BMP", "GIF", "TIFF", "WEBP", "DDS", "PPM")

Pixels = npt.NDArray[np.uint8]


class Companions:
    """Companion files of one mesh file, with a list of those that were read and of problems.

    Args:
        file: mesh file; relative names start from its folder.

    Attributes:
        read: (size, modification time) of each requested companion by path; None for a missing file.
        notes: one sentence for each omitted element.
    """

    def __init__(self, file: Path) -> None:
        self.file, self.folder = file, file.parent
        self.read: dict[str, tuple[int, int] | None] = {}
        self.notes: list[str] = []
        self._pictures: dict[str, Pixels | None] = {}

    @cached_property
    def _roots(self) -> tuple[Path, Path, Path]:
        """Folder of the file's model as written, with links resolved, and the model folder of the resolved file."""
        written = model_folder(absolute_path(self.file))
        return written, Path(os.path.realpath(written)), model_folder(Path(os.path.realpath(self.file)))

    @cached_property
    def _trusted(self) -> TrustedFolders:
        return TrustedFolders(self._roots)

    def note(self, text: str) -> None:
        """Record a note about an omitted element; equal notes are recorded once."""
        if text not in self.notes and len(self.notes) < MOST_NOTES:
            self.notes.append(text)

    def find(self, name: str) -> Path | None:
        """Return the path of a companion file; None if it is missing or outside the model of the mesh."""
        name = name.strip().replace("\\", "/")
        if not name or "\0" in name or len(name) > 1000:
            return None
        for scheme in ("model://", "package://"):
            if name.startswith(scheme):
                return self._of_package(name.removeprefix(scheme))
        if name.startswith("file://"):
            name = path_of_file_uri(name.removeprefix("file://"))
        elif "://" in name:
            self.note(f"{_short(name)} is not fetched from a network")
            return None
        spelt = dict.fromkeys((name, unquote(name)))
        folder = absolute_path(self.folder)
        places = [join_within(self._roots, folder, place) for place in spelt]
        usual = (Path(name).name, f"../materials/textures/{Path(name).name}")
        places += [path for place in usual if (path := join_within(self._roots, folder, place)) is not None]
        return self._first(places, name)

    def _of_package(self, rest: str) -> Path | None:
        root = self._roots[0]
        try:
            package, inside = split_rest(unquote(rest))
        except OutsideError:
            return self._first([None], rest)
        if package != root.name:
            self.note(f"{_short(rest)} belongs to another model and is not read")
            return None
        return self._first([join_below(root, inside)], rest)

    def _first(self, places: list[Path | None], name: str) -> Path | None:
        """Return the first place that exists; None is a place outside of the model."""
        outside = False
        for place in dict.fromkeys(places):
            if place is None or not self._trusted.allows(place):
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

    def content(self, name: str) -> bytes | None:
        """Return the content of a companion file; record a note and return None if the file cannot be read."""
        place = self.find(name)
        if place is None:
            return None
        try:
            return read_input(place, LARGEST_COMPANION)
        except OSError as problem:
            self.note(f"{_short(name)} cannot be read: {problem.strerror}")
            return None

    def picture(self, name: str) -> Pixels | None:
        """Return a texture by its file name; record a note and return None if the image cannot be used."""
        if name not in self._pictures:
            content = self.content(name)
            self._pictures[name] = None if content is None else self.picture_in(content, name)
        return self._pictures[name]

    def picture_in(self, content: bytes, name: str) -> Pixels | None:
        """Decode the bytes of a texture; record a note and return None if the image cannot be used."""
        try:
            return read_pixels(content)
        except MeshFileError as problem:
            self.note(f"{_short(name)} {problem}")
            return None


def model_folder(file: Path) -> Path:
    """Return the folder of the outermost model or package of a file.

    Without a manifest, it is the parent of the file's folder, if the parent is in the same project or looks like a
    model; else the file's folder.
    """
    above = file.parent.parent
    folder = above if above.is_relative_to(readable_folder(file.parent)) else file.parent
    for ancestor in (file.parent, *list(file.parents)[1:6]):
        if any((ancestor / name).is_file() for name in _MANIFESTS) and not is_top_folder(ancestor):
            folder = ancestor
    return folder


def read_pixels(source: bytes | Path) -> Pixels:
    """Read an image as uint8 rows from the top, shape (h, w, 3), limited to a size that MuJoCo draws well.

    Raises:
        MeshFileError: the file is not an image or is too large; the size is checked before decoding.
    """
    from PIL import Image

    try:
        content = source if isinstance(source, bytes) else read_input(source, LARGEST_COMPANION)
        check_is_fetched(content)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with Image.open(io.BytesIO(_essential_content(content)), formats=_FORMATS) as image:
                if image.width * image.height > LARGEST_PIXELS:
                    raise MeshFileError(f"is {image.width}×{image.height} pixels, which is too large")
                image.draft("RGB", (LARGEST_TEXTURE, LARGEST_TEXTURE))
                return _rgb(image)
    except MeshFileError:
        raise
    except Image.UnidentifiedImageError:  # its text has an address in memory
        raise MeshFileError("is not a readable picture (unknown format)") from None
    except Exception as problem:  # noqa: BLE001 -- a decoder of broken data may raise anything
        raise MeshFileError(f"is not a readable picture ({_short(str(problem) or type(problem).__name__)})") from None


def _essential_content(content: bytes) -> bytes:
    """Return a picture without the chunks of a PNG file that do not change its pixels; other formats unchanged.

    Pillow refuses a PNG file with a wrong checksum in such a chunk, while Gazebo's reader only warns.
    """
    if not content.startswith(_PNG):
        return content
    kept, start = [_PNG], len(_PNG)
    while start + 8 <= len(content):
        end = start + 12 + int.from_bytes(content[start : start + 4], "big")
        name = content[start + 4 : start + 8]
        if name[:1].isupper() or name == b"tRNS":
            kept.append(content[start:end])
        start = end
    return b"".join(kept)


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


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= 120 else text[:117] + "..."
