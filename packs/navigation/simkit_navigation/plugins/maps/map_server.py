"""Plugin that publishes an occupancy map of a file, or the true one of the world, as Nav2's `map_server`."""

from __future__ import annotations

import io
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import Params, Plugin, Pose, msgs
from simkit.errors import InputError
from simkit.extend import Options, OptionsOf, SharedByCopies, boolean, number, offers, publishes, text
from simkit.input_file import TEXT_LIMIT, read_input
from simkit.plugins.find_entities import find_plugin_file
from simkit.sensors.occupancy_map import OccupancyMap, make_map
from simkit.trusted_folders import TrustedFolders, join_within
from simkit.yaml_reader import NotYaml, finite_number, read_yaml

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import SceneModel, SceneWorld, SpecBuilder

_LARGEST_IMAGE: Final = 256 << 20  # [bytes]
_MOST_CELLS: Final = 100_000_000
_MODES: Final = ("trinary", "scale", "raw")
_LIMITS: Final = {"occupied": 0.65, "free": 0.25}
_FORMATS: Final = ("PPM", "PNG", "BMP")
_NOT_FOUND, _BAD_IMAGE, _BAD_YAML = 1, 2, 3  # results of nav2_msgs/srv/LoadMap

Cells = npt.NDArray[np.int8]


class MapFileError(Exception):
    """A map file cannot be used.

    Attributes:
        result: result of `nav2_msgs/srv/LoadMap`.
    """

    def __init__(self, problem: str, result: int) -> None:
        super().__init__(problem)
        self.result = result


@dataclass(frozen=True, eq=False)
class _PublishedMap(SharedByCopies):
    """Map as a message, which never changes; snapshots share it."""

    message: msgs.OccupancyGrid


class MapServerOptions(Options):
    """Options of `MapServer`."""

    yaml_filename: str = text()
    topic_name: str = text("map")
    frame_id: str = text("map")
    height: float = number(0.2, "m")
    resolution: float = number(0.05, "m", minimum=1e-4)
    publish_transform: bool = boolean(False)


class MapServer(Plugin):
    """Publishes a map on `map` (latched), and answers `~/map` and `~/load_map`.

    `<yaml_filename>` is a file of map_server. Without it, the map is the true one of the world's static collisions at
    `<height>` [m] with cells of `<resolution>` [m], where every cell is free that is not occupied. The frame `map` lies
    at the origin of the world. `<publish_transform>` publishes it on `/tf_static` as the parent of `world`.
    """

    filenames = ("libsimkit_map_server.so",)
    parent_kind = ("world", "model")
    names = ("simkit::MapServer",)
    options = OptionsOf(MapServerOptions)
    endpoints = (
        publishes("map", "nav_msgs/msg/OccupancyGrid", named_by=("topic_name",)),
        offers("~/map", "nav_msgs/srv/GetMap"),
        offers("~/load_map", "nav2_msgs/srv/LoadMap"),
    )

    @property
    def reads_at_load(self) -> tuple[str, ...]:
        """Values that `load` reads: the true map depends on the shapes and poses of the static collisions."""
        return () if self.options.yaml_filename else ("geometry", "pose_link", "pose_world")

    def set_state(self, state: Mapping[str, object]) -> None:
        before = self._map
        super().set_state(state)
        if self._map is not before:
            self._publisher.publish(self._map.message)

    def prepare(self, scene: SceneWorld | SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._file: OccupancyMap | None = None  # until `load`
        name = self.options.yaml_filename
        if not name:
            return
        path = find_plugin_file(self, name, builder)
        try:
            if path is None:
                raise MapFileError(f"there is no file {name!r:.200}", _NOT_FOUND)
            self._file = read_map(path)
        except MapFileError as error:
            params.diagnostics.error(
                "SK-MAP-001", f"plugin {self.name!r}: {error}", self.where, "check <yaml_filename>"
            )

    def load(self, parent: Simulation | Model, params: Params) -> None:
        self._publisher = self.advertise(self.options.topic_name, "nav_msgs/msg/OccupancyGrid", latched=True)
        self.offer("~/map", "nav_msgs/srv/GetMap", lambda _: {"map": self._map.message})
        self.offer("~/load_map", "nav2_msgs/srv/LoadMap", self._on_load_map)
        if self.options.publish_transform:
            header = {"frame_id": self.options.frame_id}
            transform = {"header": header, "child_frame_id": "world", "transform": {"rotation": {"w": 1.0}}}
            tf = self.advertise("/tf_static", "tf2_msgs/msg/TFMessage", latched=True)
            tf.publish(msgs.from_dict(["tf2_msgs/msg/TFMessage"], {"transforms": [transform]}))
        grid = self._file
        if grid is None:
            data = self.sim.engine.physics.fresh()
            try:
                grid = make_map(self.sim.mj_model, data, self.options.height, self.options.resolution)
            except InputError as error:
                hint = "change <height> or <resolution>, or use the file of a map: <yaml_filename>"
                params.diagnostics.error("SK-MAP-001", f"plugin {self.name!r}: {error.message}", self.where, hint)
                grid = OccupancyMap(np.zeros((0, 0), np.int8), self.options.resolution, Pose())
        self._file = None
        self._publish(grid)

    def _publish(self, occupancy: OccupancyMap) -> None:
        rows, columns = occupancy.cells.shape
        stamp = msgs.time(self.sim.time_ns)
        info = {"map_load_time": stamp, "resolution": occupancy.resolution, "width": columns, "height": rows}
        values: dict[str, object] = {
            "header": msgs.header(self.sim.time_ns, self.options.frame_id),
            "info": {**info, "origin": msgs.pose_message(occupancy.origin)},
            "data": occupancy.cells.reshape(-1),
        }
        self._map = _PublishedMap(msgs.from_dict(["nav_msgs/msg/OccupancyGrid"], values))
        self._publisher.publish(self._map.message)

    def _on_load_map(self, request: msgs.nav2_msgs__srv__LoadMap_Request) -> dict[str, object]:
        """Replace the map by that of a file; the files are those that a world may use."""
        path = find_plugin_file(self, request.map_url, self.sim.engine.structure.builder)
        try:
            if path is None:
                raise MapFileError(f"there is no file {request.map_url!r:.200} in the folders of the world", _NOT_FOUND)
            grid = read_map(path)
        except MapFileError as error:
            self.log.error("%s", error)
            return {"result": error.result}
        self._publish(grid)
        return {"map": self._map.message, "result": 0}


def read_map(path: Path, is_ros_1: bool = False) -> OccupancyMap:
    """Return the map of a YAML file of map_server.

    Args:
        path: file.
        is_ros_1: True for the mode `scale` of ROS 1.

    Raises:
        MapFileError: the file or its image cannot be read, or a value is not valid.
    """
    try:
        values = read_yaml(read_input(path, TEXT_LIMIT).decode("utf-8"))
    except (OSError, UnicodeDecodeError, NotYaml) as error:
        raise MapFileError(f"{path} cannot be read: {_reason(error)}", _BAD_YAML) from None
    if not isinstance(values, dict):
        raise MapFileError(f"{path}: expected the keys image, resolution and origin", _BAD_YAML)
    problems = [f"missing key '{key}'" for key in ("image", "resolution", "origin") if key not in values]
    resolution = finite_number(values.get("resolution", 1.0))
    if resolution is None or resolution <= 0:
        problems.append(f"resolution: found {values['resolution']!r:.60}; expected a number above 0 [m]")
    origin = values.get("origin", [0, 0, 0])
    place = [finite_number(value) for value in origin] if isinstance(origin, list) else []
    if len(place) != 3 or None in place:
        problems.append(f"origin: found {origin!r:.60}; expected x, y and yaw")
    mode = values.get("mode", "trinary")
    if mode not in _MODES:
        problems.append(f"mode: found {mode!r:.60}; expected one of {', '.join(_MODES)}")
    occupied, free = (finite_number(values.get(f"{kind}_thresh", limit)) for kind, limit in _LIMITS.items())
    if occupied is None or free is None or not 0 <= free < occupied <= 1:
        problems.append("occupied_thresh, free_thresh: expected 0 <= free_thresh < occupied_thresh <= 1")
    negate = values.get("negate", 0)
    if negate not in (0, 1):
        problems.append(f"negate: found {negate!r:.60}; expected 0 or 1")
    if problems:
        raise MapFileError(f"{path}: {'; '.join(problems)}", _BAD_YAML)
    assert resolution is not None and occupied is not None and free is not None
    name = values["image"]
    if not isinstance(name, str) or not name or "\0" in name:
        raise MapFileError(f"{path}: found image: {name!r:.100}; expected the name of a file", _BAD_YAML)
    folder = path.absolute().parent
    image = join_within([folder], folder, name)
    if image is None or not TrustedFolders([folder, path.resolve().parent]).allows(image):
        raise MapFileError(f"{path}: the image {name!r:.100} is outside of the map's folder", _BAD_YAML)
    shade, alpha = _read_image(image)
    cells = _cells(shade, shade if negate else 1.0 - shade, alpha, mode, (occupied, free), is_ros_1)
    x, y, yaw = (value or 0.0 for value in place)
    return OccupancyMap(np.ascontiguousarray(cells[::-1]), resolution, Pose.from_rpy(x, y, 0.0, 0.0, 0.0, yaw))


def _read_image(path: Path) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.bool_] | None]:
    """Return brightness, 0 to 1, and which pixels are transparent, shape (rows, columns) from the top."""
    from PIL import Image, UnidentifiedImageError

    try:
        content = read_input(path, _LARGEST_IMAGE)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with Image.open(io.BytesIO(content), formats=_FORMATS) as image:
                if image.width * image.height > _MOST_CELLS:
                    raise MapFileError(f"{path} has more than {_MOST_CELLS:.0e} pixels", _BAD_IMAGE)
                if image.mode not in ("L", "1", "I;16", "I"):
                    pixels = np.asarray(image.convert("RGBA"), np.float64)
                    return pixels[..., :3].mean(axis=2) / 255.0, pixels[..., 3] == 0
                scale = 255.0 if image.mode in ("L", "1") else 65535.0
                return np.asarray(image.convert("L") if image.mode == "1" else image, np.float64) / scale, None
    except UnidentifiedImageError:
        raise MapFileError(f"{path} is not an image; expected a PGM, PNG or BMP file", _BAD_IMAGE) from None
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise MapFileError(f"{path} cannot be read: {_reason(error)}", _BAD_IMAGE) from None


def _reason(error: Exception) -> str:
    """Return the reason of an error without its number and a repeated file name."""
    return getattr(error, "strerror", None) or str(error)


def _cells(
    shade: npt.NDArray[np.float64],
    occupancy: npt.NDArray[np.float64],
    transparent: npt.NDArray[np.bool_] | None,
    mode: str,
    limits: tuple[float, float],
    is_ros_1: bool,
) -> Cells:
    """Return the cells of an image as `map_server` defines them for each mode; row 0 is at the top.

    Between the thresholds, the mode `scale` gives 0 to 100 (Nav2's `map_io.cpp`), and 1 to 99 in ROS 1.
    """
    occupied, free = limits
    if mode == "raw":
        values = np.round(shade * 255.0)
        return np.where(values <= 100, values, -1).astype(np.int8)
    between = np.full(occupancy.shape, -1.0)
    if mode == "scale":
        share = (occupancy - free) / (occupied - free)
        between = np.rint(share * 98.0 + 1.0 if is_ros_1 else share * 100.0)
    cells = np.where(occupancy > occupied, 100.0, np.where(occupancy < free, 0.0, between))
    if transparent is not None and mode == "scale":
        cells[transparent] = -1.0
    return cells.astype(np.int8)
