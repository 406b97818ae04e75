"""World plugin that writes a published occupancy map to files, as Nav2's `map_saver`."""

from __future__ import annotations

import io
import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import WorldPlugin
from simkit.errors import SimkitError
from simkit.extend import Options, OptionsOf, SharedByCopies, counted, listens, number, offers, text
from simkit.input_file import open_input
from simkit.save_path import SAVE_PATH_VARIABLE, allowed_folder
from simkit_navigation.plugins.navigation.planar_pose import yaw_of

if TYPE_CHECKING:
    from simkit import Params, Simulation, msgs

_GRID: Final = "nav_msgs/msg/OccupancyGrid"
_MODES: Final = ("trinary", "scale", "raw")
_FORMATS: Final = {"pgm": "PPM", "png": "PNG", "bmp": "BMP"}  # file ending -> name in Pillow
_BEGINS: Final = {  # of the files that a save may replace
    "yaml": re.compile(rb"^image\s*:", re.MULTILINE),
    "pgm": re.compile(rb"\AP[25]"),
    "png": re.compile(rb"\A\x89PNG"),
    "bmp": re.compile(rb"\ABM"),
}
_HEAD: Final = 4096  # bytes at the begin of a file that are searched
_FREE, _OCCUPIED, _UNKNOWN = 254, 0, 205  # grey values of map_server
_LARGEST: Final = 100  # of the values of known cells
_READ_AS_UNKNOWN: Final = 0.196  # a map_server reads grey 205 as 0.19608 occupied; a larger limit makes it free


class MapNotSaved(Exception):
    """A map cannot be saved; the text says why."""


@dataclass(frozen=True, eq=False)
class _ReceivedMap(SharedByCopies):
    """Newest message of a topic, which never changes; snapshots share it."""

    message: msgs.OccupancyGrid


class MapSaverOptions(Options):
    """Options of `MapSaver`."""

    map_topic: str = text("map")
    free_thresh_default: float = number(0.25, minimum=0.0, maximum=1.0)
    occupied_thresh_default: float = number(0.65, minimum=0.0, maximum=1.0)


class MapSaver(WorldPlugin):
    """Writes the newest map of a topic to an image and a YAML file when `~/save_map` is called.

    The service saves the map of any latched topic. A map that is not latched is known only on `<map_topic>`.
    """

    filenames = ("libsimkit_map_saver.so",)
    names = ("simkit::MapSaver",)
    options = OptionsOf(MapSaverOptions)
    endpoints = (listens("map", _GRID, named_by=("map_topic",)), offers("~/save_map", "nav2_msgs/srv/SaveMap"))

    def load(self, parent: Simulation, params: Params) -> None:
        free, occupied = self.options.free_thresh_default, self.options.occupied_thresh_default
        if free >= occupied:
            message = f"plugin {self.name!r}: <free_thresh_default> {free:g} is not below <occupied_thresh_default>"
            params.diagnostics.error("SK-MAP-002", f"{message} {occupied:g}", self.where)
        self._topic = self.ros.topic(self.options.map_topic)
        self._newest: _ReceivedMap | None = None
        self.subscribe(self.options.map_topic, self._on_map)
        self.offer("~/save_map", "nav2_msgs/srv/SaveMap", self._on_save_map)

    def _on_map(self, message: msgs.OccupancyGrid) -> None:
        if self._once.has_type(message, _GRID, "map_topic"):
            self._newest = _ReceivedMap(message)

    def _on_save_map(self, request: msgs.nav2_msgs__srv__SaveMap_Request) -> dict[str, bool]:
        """Save a map; the log has the reason if that is not possible."""
        try:
            written = self._save(request)
        except (MapNotSaved, SimkitError, OSError, UnicodeError) as error:
            self.log.error("the map is not saved: %s", error)
            return {"result": False}
        self.log.info("saved %s", written)
        return {"result": True}

    def _save(self, request: msgs.nav2_msgs__srv__SaveMap_Request) -> Path:
        """Write the files of a request and return the YAML file."""
        free = request.free_thresh or self.options.free_thresh_default  # zero means the default, as in Nav2
        occupied = request.occupied_thresh or self.options.occupied_thresh_default
        mode, ending = request.map_mode or "trinary", request.image_format or "pgm"
        if mode == "scale" and ending != "png":
            self.log.warning("map_mode scale needs transparent pixels; the image is a PNG file")
        message = self._map_on(request.map_topic or self.options.map_topic)
        return write_map(message, _target(request.map_url or "map"), mode, ending, (free, occupied))

    def _map_on(self, topic: str) -> msgs.OccupancyGrid:
        """Return the newest map of a topic: of `<map_topic>`, or of another topic if it is latched."""
        name = self.ros.topic(topic)
        if name == self._topic:
            newest = self._newest
        else:
            subscription = self.subscribe(topic, keep=1)
            latest = subscription.latest
            subscription.close()
            newest = _ReceivedMap(latest) if latest is not None and latest.__msgtype__ == _GRID else None
        if newest is None:
            raise MapNotSaved(f"no map has been published on {name!r:.200}")
        return newest.message


def write_map(message: msgs.OccupancyGrid, stem: Path, mode: str, ending: str, thresholds: tuple[float, float]) -> Path:
    """Write the image and the YAML file of a map; return the YAML file.

    Args:
        message: map.
        stem: path of both files without ending.
        mode: "trinary", "scale" or "raw".
        ending: ending of the image: "pgm", "png" or "bmp"; the mode "scale" always writes "png".
        thresholds: occupancies below which a cell is free, and above which it is occupied.

    Raises:
        MapNotSaved: a value or the map is not valid, or a file is not a map.
        OSError: a file cannot be written.
    """
    free, occupied = thresholds
    if not 0.0 < free < occupied <= 1.0:
        raise MapNotSaved(f"expected 0 < free_thresh < occupied_thresh <= 1, found {free:g} and {occupied:g}")
    if mode not in _MODES:
        raise MapNotSaved(f"map_mode {mode!r:.60} is not one of {', '.join(_MODES)}")
    if ending not in _FORMATS:
        raise MapNotSaved(f"image_format {ending!r:.60} is not one of {', '.join(_FORMATS)}")
    ending = "png" if mode == "scale" else ending
    cells = _cells(message)
    image, file = (stem.with_name(f"{stem.name}.{end}") for end in (ending, "yaml"))
    _check_is_map(image, ending)
    _check_is_map(file, "yaml")
    _write(image, _encode(_pixels(cells[::-1], mode, free, occupied), _FORMATS[ending]))
    _write(file, _description(message.info, image.name, mode, free, occupied).encode())
    return file


def _cells(message: msgs.OccupancyGrid) -> npt.NDArray[np.int8]:
    """Return the cells of a map by row and column, and check the numbers that a YAML file contains."""
    info, origin = message.info, message.info.origin
    data = np.asarray(message.data, np.int8)
    if not data.size or data.size != info.height * info.width:
        raise MapNotSaved(f"the map has {counted(data.size, 'cell')}; its size is {info.width} × {info.height}")
    numbers = (info.resolution, origin.position.x, origin.position.y, yaw_of(origin.orientation))
    if not np.isfinite(numbers).all() or info.resolution <= 0.0:
        raise MapNotSaved(f"resolution {info.resolution:g} and origin must be finite, the resolution above 0 [m]")
    return data.reshape(info.height, info.width)


def _target(url: str) -> Path:
    """Return the path of the files without ending, in a folder that may be written to."""
    path = Path(url)
    if path.suffix in (".yaml", *(f".{ending}" for ending in _FORMATS)):
        path = path.with_suffix("")
    folder = allowed_folder(str(path.parent))
    if folder is None or path.name in ("", "..") or "\0" in path.name:
        variable = f"the environment variable {SAVE_PATH_VARIABLE} allows other folders"
        raise MapNotSaved(f"map_url {url!r:.200} is not a file below the working folder; {variable}")
    return folder / path.name


def _pixels(cells: npt.NDArray[np.int8], mode: str, free: float, occupied: float) -> npt.NDArray[np.uint8]:
    """Return the grey values of cells, as `map_server` defines them for a mode; in the mode scale with alpha."""
    is_known = (cells >= 0) & (cells <= _LARGEST)
    if mode == "raw":
        return np.where(is_known, cells.astype(np.uint8), np.uint8(255))
    if mode == "scale":
        grey = np.where(is_known, np.rint((_LARGEST - cells.astype(float)) / _LARGEST * 255.0), 0.0)
        return np.stack([grey, np.where(is_known, 255.0, 0.0)], axis=-1).astype(np.uint8)
    pixels = np.full(cells.shape, _UNKNOWN, np.uint8)
    pixels[is_known & (cells <= np.rint(free * _LARGEST))] = _FREE
    pixels[is_known & (cells >= np.rint(occupied * _LARGEST))] = _OCCUPIED
    return pixels


def _encode(pixels: npt.NDArray[np.uint8], file_format: str) -> bytes:
    from PIL import Image

    content = io.BytesIO()
    Image.fromarray(pixels).save(content, format=file_format)
    return content.getvalue()


def _description(info: msgs.MapMetaData, image: str, mode: str, free: float, occupied: float) -> str:
    """Return the YAML file of `map_server`.

    A trinary image has only three values; the limit of free cells in its file keeps the unknown ones unknown.
    """
    position, yaw = info.origin.position, yaw_of(info.origin.orientation)
    limit = min(free, _READ_AS_UNKNOWN) if mode == "trinary" else free
    return (
        f"image: {_yaml_text(image)}\nmode: {mode}\nresolution: {info.resolution:.9g}\n"
        f"origin: [{position.x:.9g}, {position.y:.9g}, {yaw:.9g}]\n"
        f"negate: 0\noccupied_thresh: {occupied:.9g}\nfree_thresh: {limit:.9g}\n"
    )


def _yaml_text(name: str) -> str:
    """Return a file name as YAML: quoted if it contains other characters than letters, digits and "_-."."""
    is_plain = re.fullmatch(r"[A-Za-z_][\w.-]*", name, re.ASCII) is not None
    return name if is_plain else json.dumps(name)


def _check_is_map(path: Path, ending: str) -> None:
    """Check that a file which a save replaces is a map or an image; the request can come from a stranger's bundle.

    Raises:
        MapNotSaved: the file is another file of the user.
    """
    if not path.is_file() or path.is_symlink():  # a link is replaced, and its target stays
        return
    with open_input(path) as file:
        head = file.read(_HEAD)
    if head and _BEGINS[ending].search(head) is None:
        raise MapNotSaved(f"{path} exists and is not a map; choose another map_url")


def _write(path: Path, data: bytes) -> None:
    """Write a whole file, or leave the old one."""
    partial = path.with_name(f".{path.name[:100]}.part")
    try:
        partial.unlink(missing_ok=True)  # it may be a link to another folder
        partial.write_bytes(data)
        partial.replace(path)
    except OSError:
        partial.unlink(missing_ok=True)
        raise
