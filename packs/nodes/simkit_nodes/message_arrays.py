"""Messages as NumPy arrays and back, as the packages `ros2_numpy` and `ros_numpy` convert them."""

from __future__ import annotations

import sys
from array import array
from collections.abc import Callable
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit_nodes.image_encodings import EncodingError, encoding_of
from simkit_nodes.interfaces import ProgramMessage, type_name_of
from simkit_nodes.program_messages import new_message
from simkit_nodes.transformations import (
    quaternion_from_matrix,
    quaternion_matrix,
    translation_from_matrix,
    translation_matrix,
)

Array = npt.NDArray[Any]

_DUMMY: Final = "__"
_NUMPY_TYPES: Final = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
_FIELD_TYPES: Final = {np.dtype(name): number for number, name in _NUMPY_TYPES.items()}


def numpify(msg: ProgramMessage, *args: Any, **kwargs: Any) -> Any:
    """Return a message, or several fields of a point cloud, as an array.

    Raises:
        ValueError: the type has no array.
    """
    if msg is None:
        return None
    if isinstance(msg, (list, tuple)):
        if not msg:
            raise ValueError("Cannot determine the type of an empty Collection")
        if getattr(msg[0], "_ros_type", "") == "sensor_msgs/msg/PointField":
            return fields_to_dtype(msg, *args, **kwargs)
    convert = _TO_NUMPY.get(getattr(msg, "_ros_type", ""))
    if convert is None:
        raise ValueError(f"Unable to convert message {type(msg).__name__} - only supports {_names(_TO_NUMPY)}")
    return convert(msg, *args, **kwargs)


def msgify(msg_type: Any, numpy_obj: Any, *args: Any, **kwargs: Any) -> Any:
    """Return an array as a message.

    Args:
        msg_type: class of the message.
        numpy_obj: array.
        args: further arguments of the conversion.
        kwargs: further arguments of the conversion; `plural` for several fields of a point cloud.

    Raises:
        ValueError: the type has no array.
    """
    name = type_name_of(msg_type)
    if kwargs.pop("plural", False) and name == "sensor_msgs/msg/PointField":
        return dtype_to_fields(numpy_obj, *args, **kwargs)
    convert = _FROM_NUMPY.get(name)
    if convert is None:
        raise ValueError(f"Unable to build message {msg_type.__name__} - only supports {_names(_FROM_NUMPY)}")
    return convert(numpy_obj, *args, **kwargs)


def _names(table: dict[str, Callable[..., object]]) -> str:
    return ", ".join(name.rpartition("/")[2] for name in table)


# ---------------------------------------------------------------------- point clouds


def fields_to_dtype(fields: Any, point_step: int) -> list[tuple[str, Any]]:
    """Return the type of an array with the points of a cloud; gaps have names that begin with `__`.

    Args:
        fields: `sensor_msgs.msg.PointField` of the cloud.
        point_step: length of a point [bytes].
    """
    offset = 0
    columns: list[tuple[str, Any]] = []
    for field in fields:
        columns += [(f"{_DUMMY}{byte}", np.dtype(np.uint8)) for byte in range(offset, field.offset)]
        item = np.dtype(_NUMPY_TYPES[field.datatype])
        columns.append((field.name, item if field.count == 1 else np.dtype((item, (field.count,)))))
        offset = max(offset, field.offset) + item.itemsize * field.count
    return columns + [(f"{_DUMMY}{byte}", np.dtype(np.uint8)) for byte in range(offset, point_step)]


def dtype_to_fields(dtype: Any) -> list[Any]:
    """Return the `sensor_msgs.msg.PointField` of a structured type."""
    fields = []
    for name in dtype.names:
        column, offset = dtype.fields[name][:2]
        field = new_message("sensor_msgs/msg/PointField")
        field.name, field.offset = name, offset
        item, shape = column.subdtype or (column, (1,))
        field.count, field.datatype = int(np.prod(shape)), _FIELD_TYPES[item]
        fields.append(field)
    return fields


def pointcloud2_to_array(cloud_msg: Any, squeeze: bool = True) -> Array:
    """Return a `sensor_msgs.msg.PointCloud2` as a structured array (height, width).

    Args:
        cloud_msg: message.
        squeeze: return an array with one axis for a cloud with one row.
    """
    columns = fields_to_dtype(cloud_msg.fields, cloud_msg.point_step)
    cloud: ProgramMessage = np.frombuffer(cloud_msg.data, np.dtype(columns))
    cloud = cloud[[name for name, _ in columns if not name.startswith(_DUMMY)]]
    is_flat = squeeze and cloud_msg.height == 1
    return np.reshape(cloud, (cloud_msg.width,) if is_flat else (cloud_msg.height, cloud_msg.width))


def array_to_pointcloud2(cloud_arr: Any, stamp: Any = None, frame_id: str | None = None) -> Any:
    """Return a structured array as a `sensor_msgs.msg.PointCloud2`."""
    points = np.atleast_2d(cloud_arr)
    cloud = new_message("sensor_msgs/msg/PointCloud2")
    if stamp is not None:
        cloud.header.stamp = stamp
    if frame_id is not None:
        cloud.header.frame_id = frame_id
    cloud.height, cloud.width = points.shape
    cloud.fields = dtype_to_fields(points.dtype)
    cloud.is_bigendian = False
    cloud.point_step = points.dtype.itemsize
    cloud.row_step = cloud.point_step * cloud.width
    cloud.is_dense = all(bool(np.isfinite(points[name]).all()) for name in points.dtype.names or ())
    cloud.data = octets(points.tobytes(), cloud.data)
    return cloud


def merge_rgb_fields(cloud_arr: Any) -> Array:
    """Return a structured array in which the fields `r`, `g`, `b` are one field `rgb`, as PCL has it."""
    red, green, blue = (np.asarray(cloud_arr[name], np.uint32) for name in "rgb")
    columns = [(name, cloud_arr.dtype.fields[name][0]) for name in cloud_arr.dtype.names if name not in ("r", "g", "b")]
    result = np.zeros(cloud_arr.shape, [*columns, ("rgb", np.float32)])
    for name, _ in columns:
        result[name] = cloud_arr[name]
    result["rgb"] = ((red << 16) | (green << 8) | blue).astype(np.uint32).view(np.float32)
    return result


def split_rgb_field(cloud_arr: Any) -> Array:
    """Return a structured array in which the field `rgb` of PCL is three fields `r`, `g`, `b`."""
    colors = np.ascontiguousarray(cloud_arr["rgb"]).view(np.uint32)
    columns = [(name, cloud_arr.dtype.fields[name][0]) for name in cloud_arr.dtype.names if name != "rgb"]
    result = np.zeros(cloud_arr.shape, [*columns, *((name, np.uint8) for name in "rgb")])
    for name, _ in columns:
        result[name] = cloud_arr[name]
    for name, shift in (("r", 16), ("g", 8), ("b", 0)):
        result[name] = (colors >> shift) & 255
    return result


def get_xyz_points(cloud_array: Any, remove_nans: bool = True, dtype: Any = float) -> Array:
    """Return x, y and z of a structured array as an array with a row for each point."""
    if remove_nans:
        is_finite = np.isfinite(cloud_array["x"]) & np.isfinite(cloud_array["y"]) & np.isfinite(cloud_array["z"])
        cloud_array = cloud_array[is_finite]
    return np.stack([np.asarray(cloud_array[name], dtype) for name in "xyz"], axis=-1)


def pointcloud2_to_xyz_array(cloud_msg: Any, remove_nans: bool = True) -> Array:
    """Return x, y and z of a `sensor_msgs.msg.PointCloud2` as an array with a row for each point."""
    return get_xyz_points(pointcloud2_to_array(cloud_msg), remove_nans=remove_nans)


# ---------------------------------------------------------------------- images and maps


def image_to_numpy(msg: ProgramMessage) -> Array:
    """Return a `sensor_msgs.msg.Image` as an array that shares its memory.

    Raises:
        TypeError: the encoding is unknown.
    """
    try:
        encoding = encoding_of(msg.encoding)
    except EncodingError:
        raise TypeError(f"Unrecognized encoding {msg.encoding}") from None
    dtype = encoding.dtype.newbyteorder(">" if msg.is_bigendian else "<")
    strides = (msg.step, dtype.itemsize * encoding.channels, dtype.itemsize)
    image: Array = np.ndarray((msg.height, msg.width, encoding.channels), dtype, buffer=msg.data, strides=strides)
    return image[..., 0] if encoding.channels == 1 else image


def numpy_to_image(arr: Any, encoding: str) -> Any:
    """Return an array as a `sensor_msgs.msg.Image`.

    Raises:
        TypeError: the encoding is unknown, or does not fit the array.
    """
    try:
        known = encoding_of(encoding)
    except EncodingError:
        raise TypeError(f"Unrecognized encoding {encoding}") from None
    if arr.ndim not in (2, 3):
        raise TypeError("Array must be two or three dimensional")
    channels = arr.shape[2] if arr.ndim == 3 else 1
    if channels != known.channels:
        raise TypeError(f"Array has {channels} channels, {encoding} requires {known.channels}")
    if arr.dtype.type != known.dtype.type:
        raise TypeError(f"Array is {arr.dtype.type}, {encoding} requires {known.dtype.type}")
    image = new_message("sensor_msgs/msg/Image")
    values = np.ascontiguousarray(arr)
    image.encoding, (image.height, image.width) = encoding, arr.shape[:2]
    image.data, image.step = octets(values.tobytes(), image.data), values.strides[0]
    order = arr.dtype.byteorder
    image.is_bigendian = order == ">" or (order == "=" and sys.byteorder == "big")
    return image


def occupancygrid_to_numpy(msg: ProgramMessage) -> Any:
    """Return a `nav_msgs.msg.OccupancyGrid` as an array in which unknown cells are masked."""
    data = np.array(msg.data, np.int8).reshape(msg.info.height, msg.info.width)
    return np.ma.array(data, mask=data == -1, fill_value=-1)


def numpy_to_occupancy_grid(arr: Any, info: Any = None) -> Any:
    """Return an array as a `nav_msgs.msg.OccupancyGrid`.

    Raises:
        TypeError: the array has not two axes, or other numbers than int8.
    """
    if arr.ndim != 2:
        raise TypeError("Array must be 2D")
    if arr.dtype != np.int8:
        raise TypeError("Array must be of int8s")
    values = arr.data if isinstance(arr, np.ma.MaskedArray) else arr
    grid = new_message("nav_msgs/msg/OccupancyGrid")
    if info is not None:
        grid.info = info
    grid.info.height, grid.info.width = values.shape
    numbers = np.asarray(values).ravel()
    grid.data = array("b", numbers.tobytes()) if isinstance(grid.data, array) else numbers.tolist()
    return grid


def octets(values: bytes, like: Any) -> Any:
    """Return bytes in the type that a field of a message has."""
    return values if isinstance(like, bytes) else array("B", values)


# ---------------------------------------------------------------------- geometry


def vector3_to_numpy(msg: ProgramMessage, hom: bool = False) -> Array:
    """Return a `geometry_msgs.msg.Vector3` as an array; with `hom`, with a fourth number 0."""
    return np.array([msg.x, msg.y, msg.z, 0.0] if hom else [msg.x, msg.y, msg.z])


def point_to_numpy(msg: ProgramMessage, hom: bool = False) -> Array:
    """Return a `geometry_msgs.msg.Point` as an array; with `hom`, with a fourth number 1."""
    return np.array([msg.x, msg.y, msg.z, 1.0] if hom else [msg.x, msg.y, msg.z])


def quat_to_numpy(msg: ProgramMessage) -> Array:
    """Return a `geometry_msgs.msg.Quaternion` as an array (x, y, z, w)."""
    return np.array([msg.x, msg.y, msg.z, msg.w])


def numpy_to_vector3(arr: Any) -> Any:
    """Return an array as a `geometry_msgs.msg.Vector3`, or an array of them."""
    return _each(arr[..., :3], 1, lambda values: _filled("geometry_msgs/msg/Vector3", values))


def numpy_to_point(arr: Any) -> Any:
    """Return an array as a `geometry_msgs.msg.Point`, or an array of them."""
    values = arr[..., :3] / arr[..., 3:] if arr.shape[-1] == 4 else arr
    return _each(values, 1, lambda row: _filled("geometry_msgs/msg/Point", row))


def numpy_to_quat(arr: Any) -> Any:
    """Return an array (x, y, z, w) as a `geometry_msgs.msg.Quaternion`, or an array of them."""
    return _each(arr, 1, lambda values: _filled("geometry_msgs/msg/Quaternion", values))


def transform_to_numpy(msg: ProgramMessage) -> Array:
    """Return a `geometry_msgs.msg.Transform` as a 4 × 4 matrix."""
    return _matrix(msg.translation, msg.rotation)


def pose_to_numpy(msg: ProgramMessage) -> Array:
    """Return a `geometry_msgs.msg.Pose` as a 4 × 4 matrix."""
    return _matrix(msg.position, msg.orientation)


def numpy_to_transform(arr: Any) -> Any:
    """Return a 4 × 4 matrix as a `geometry_msgs.msg.Transform`, or an array of them."""
    return _each(arr, 2, lambda matrix: _posed("geometry_msgs/msg/Transform", "translation", "rotation", matrix))


def numpy_to_pose(arr: Any) -> Any:
    """Return a 4 × 4 matrix as a `geometry_msgs.msg.Pose`, or an array of them."""
    return _each(arr, 2, lambda matrix: _posed("geometry_msgs/msg/Pose", "position", "orientation", matrix))


def _matrix(position: Any, rotation: Any) -> Array:
    turn = quaternion_matrix((rotation.x, rotation.y, rotation.z, rotation.w))
    matrix: Array = matmul(translation_matrix((position.x, position.y, position.z)), turn)
    return matrix


def _filled(type_name: str, values: Any) -> Any:
    message = new_message(type_name)
    for name, value in zip("xyzw", values, strict=False):
        setattr(message, name, float(value))
    return message


def _posed(type_name: str, position: str, rotation: str, matrix: Any) -> Any:
    message = new_message(type_name)
    for field, values in ((position, translation_from_matrix(matrix)), (rotation, quaternion_from_matrix(matrix))):
        for name, value in zip("xyzw", values, strict=False):
            setattr(getattr(message, field), name, float(value))
    return message


def _each(arr: Any, axes: int, convert: Callable[[Any], object]) -> Any:
    """Convert an array whose last axes are those of one message, or each part of a larger array."""
    if arr.ndim == axes:
        return convert(arr)
    result = np.empty(arr.shape[:-axes], object)
    for index in np.ndindex(result.shape):
        result[index] = convert(arr[index])
    return result


_TO_NUMPY: Final[dict[str, Callable[..., object]]] = {
    "geometry_msgs/msg/Vector3": vector3_to_numpy,
    "geometry_msgs/msg/Point": point_to_numpy,
    "geometry_msgs/msg/Quaternion": quat_to_numpy,
    "geometry_msgs/msg/Transform": transform_to_numpy,
    "geometry_msgs/msg/Pose": pose_to_numpy,
    "nav_msgs/msg/OccupancyGrid": occupancygrid_to_numpy,
    "sensor_msgs/msg/Image": image_to_numpy,
    "sensor_msgs/msg/PointCloud2": pointcloud2_to_array,
}

_FROM_NUMPY: Final[dict[str, Callable[..., object]]] = {
    "geometry_msgs/msg/Vector3": numpy_to_vector3,
    "geometry_msgs/msg/Point": numpy_to_point,
    "geometry_msgs/msg/Quaternion": numpy_to_quat,
    "geometry_msgs/msg/Transform": numpy_to_transform,
    "geometry_msgs/msg/Pose": numpy_to_pose,
    "nav_msgs/msg/OccupancyGrid": numpy_to_occupancy_grid,
    "sensor_msgs/msg/Image": numpy_to_image,
    "sensor_msgs/msg/PointCloud2": array_to_pointcloud2,
}
