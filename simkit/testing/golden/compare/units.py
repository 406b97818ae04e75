"""Units of messages' fields, and numbers with them in words."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Final

_INDEX = re.compile(r"\[[^\]]*\]|\.\d+(?=\.|$)")

_UNITS_BY_TYPE: Final[tuple[tuple[str, str, str], ...]] = (
    (r"sensor_msgs/msg/LaserScan", r"(ranges|range_min|range_max)", "m"),
    (r"sensor_msgs/msg/LaserScan", r"angle_.*", "rad"),
    (r"sensor_msgs/msg/LaserScan", r"(time_increment|scan_time)", "s"),
    (r"sensor_msgs/msg/Range", r"(range|min_range|max_range|variance)", "m"),
    (r"sensor_msgs/msg/Range", r"field_of_view", "rad"),
    (r"sensor_msgs/msg/PointCloud2", r"points\.rgba?", "of 255"),
    (r"sensor_msgs/msg/PointCloud2?", r"(.*\.)?(xyz|x|y|z|points|range)", "m"),
    (r"sensor_msgs/msg/(JointState|MultiDOFJointState)", r"position", "rad or m"),
    (r"sensor_msgs/msg/(JointState|MultiDOFJointState)", r"velocity", "rad/s or m/s"),
    (r"sensor_msgs/msg/(JointState|MultiDOFJointState)", r"effort", "N m or N"),
    (r"sensor_msgs/msg/FluidPressure", r"fluid_pressure", "Pa"),
    (r"sensor_msgs/msg/FluidPressure", r"variance", "Pa²"),
    (r"sensor_msgs/msg/MagneticField", r"magnetic_field(\..*)?", "T"),
    (r"sensor_msgs/msg/Temperature", r"temperature", "°C"),
    (r"sensor_msgs/msg/(NavSatFix)|gps_msgs/msg/GPSFix", r"(latitude|longitude)", "°"),
    (r"sensor_msgs/msg/(NavSatFix)|gps_msgs/msg/GPSFix", r"altitude", "m"),
    (r"sensor_msgs/msg/(NavSatFix)|gps_msgs/msg/GPSFix", r"position_covariance.*", "m²"),
    (r"gps_msgs/msg/GPSFix", r"(speed|climb)", "m/s"),
    (r"gps_msgs/msg/GPSFix", r"(track|pitch|roll|dip)", "°"),
    (r"sensor_msgs/msg/BatteryState", r"voltage|cell_voltage", "V"),
    (r"sensor_msgs/msg/BatteryState", r"current", "A"),
    (r"sensor_msgs/msg/BatteryState", r"(charge|capacity|design_capacity)", "A h"),
    (r"sensor_msgs/msg/BatteryState", r"(temperature|cell_temperature)", "°C"),
    (r"sensor_msgs/msg/Illuminance", r"illuminance", "lx"),
    (r"ros_gz_interfaces/msg/Altimeter", r"vertical_velocity", "m/s"),
    (r"ros_gz_interfaces/msg/Altimeter", r"vertical_(position|reference)", "m"),
    (r"ros_gz_interfaces/msg/AirSpeed", r"diff_pressure", "Pa"),
    (r"ros_gz_interfaces/msg/AirSpeed", r"temperature", "K"),
    (r"actuator_msgs/msg/Actuators", r"velocity", "rad/s"),
    (r"simkit_msgs/msg/LogicalCameraSensor", r"(near_clip|far_clip)", "m"),
    (r"simkit_msgs/msg/LogicalCameraSensor", r"horizontal_fov", "rad"),
    (r"sensor_msgs/msg/CameraInfo", r"[kKpP]|roi\..*|width|height", "px"),
    (r"vision_msgs/msg/Detection2D.*", r"(.*\.)?(center|position|size_[xy]).*", "px"),
    (r"simkit_msgs/msg/Wind", r".*", "m/s"),
)
_UNITS_BY_FIELD: Final[tuple[tuple[str, str], ...]] = (
    (r"(.*\.)?(stamp|lifetime|time_from_start|\w+_time)", "ns"),  # times are columns of nanoseconds
    (r"(.*\.)?orientation_covariance.*", "rad²"),
    (r"(.*\.)?angular_velocity_covariance.*", "(rad/s)²"),
    (r"(.*\.)?linear_acceleration_covariance.*", "(m/s²)²"),
    (r"(.*\.)?magnetic_field_covariance.*", "T²"),
    (r"(.*\.)?(orientation|rotation|quaternion)(\..*)?", "rad"),
    (r"(.*\.)?linear_acceleration(\..*)?", "m/s²"),
    (r"(.*\.)?angular_velocity(\..*)?", "rad/s"),
    (r"(.*\.)?(twist|velocity)\.(linear)(\..*)?|(.*\.)?linear(\.[xyz])?", "m/s"),
    (r"(.*\.)?(twist|velocity)\.(angular)(\..*)?|(.*\.)?angular(\.[xyz])?", "rad/s"),
    (r"(.*\.)?accel\.linear(\..*)?", "m/s²"),
    (r"(.*\.)?accel\.angular(\..*)?", "rad/s²"),
    (r"(.*\.)?force(\.[xyz])?", "N"),
    (r"(.*\.)?torque(\.[xyz])?", "N m"),
    (r"(.*\.)?magnetic_field(\..*)?", "T"),
    (r"(.*\.)?contact_normals.*|(.*\.)?normals.*", ""),
    (r"(.*\.)?(positions?|translation|points?|depths?|contact_positions)(\.[xyz])?", "m"),
    (r"(.*\.)?(size)(\.[xyz])", "m"),
    (r"(.*\.)?(yaw|roll|pitch|theta|angle)", "rad"),
    (r"(.*\.)?(lateral_slip|longitudinal_slip)", "m/s"),
    (r"(.*\.)?speed", "m/s"),
)
_ITEM_NAMES: Final[tuple[tuple[str, str, str], ...]] = (
    (r"sensor_msgs/msg/LaserScan", r"(ranges|intensities).*", "rays"),
    (r"sensor_msgs/msg/PointCloud2?", r".*", "points"),
    (r"sensor_msgs/msg/JointState|control_msgs/.*", r".*", "joints"),
    (r"ros_gz_interfaces/msg/Contacts|gazebo_msgs/msg/Contacts?State", r".*", "contacts"),
    (r"sensor_msgs/msg/(Compressed)?Image", r".*", "pixels"),
)
_SMALL: Final = {"m": ("mm", 1e3), "m/s": ("mm/s", 1e3), "s": ("ms", 1e3), "T": ("µT", 1e6), "V": ("mV", 1e3)}
_SMALLER: Final = {"m": ("µm", 1e6), "T": ("nT", 1e9), "s": ("µs", 1e6)}


def plain_path(field: str) -> str:
    """A path without indices and names in brackets: `transforms[base].transform` as `transforms.transform`."""
    return _INDEX.sub("", field)


@cache
def unit_of(type_name: str, field: str) -> str:
    """The SI unit of a field; "" for a number without one.

    Orientations are compared as angles, so theirs is rad. A joint's position is in rad or m, which the message does not
    say.

    Args:
        type_name: the message's ROS type.
        field: path of the field within it; indices do not count.
    """
    path = plain_path(field)
    for of_type, of_field, unit in _UNITS_BY_TYPE:
        if re.fullmatch(of_type, type_name) and re.fullmatch(of_field, path):
            return unit
    for of_field, unit in _UNITS_BY_FIELD:
        if re.fullmatch(of_field, path):
            return unit
    return ""


def period_of(type_name: str, field: str) -> float:
    """After which an angle is the same again, in its unit; 0 for what does not come round.

    A joint's position counts its turns, and does not.
    """
    unit = unit_of(type_name, field)
    if not re.search(r"(^|\.)(track|heading|yaw|theta)$", plain_path(field)):
        return 0.0
    return {"rad": math.tau, "°": 360.0}.get(unit, 0.0)


def is_colour(field: str) -> bool:
    """Whether numbers of a field are colours, a byte for each channel."""
    return plain_path(field) in ("points.rgb", "points.rgba")


def joint_unit(unit: str, position: str) -> str:
    """The unit of a joint's quantity, once it is known whether it turns or slides.

    Args:
        unit: as `unit_of` gives it: `rad/s or m/s`.
        position: unit of the joint's position: "rad", "m", or "" where it is not known.
    """
    turns, _, slides = unit.partition(" or ")
    return {"rad": turns, "m": slides or unit}.get(position, unit)


@cache
def item_name(type_name: str, field: str) -> str:
    """What the values of an array are: rays, points, pixels, joints, contacts, or values."""
    path = plain_path(field)
    for of_type, of_field, things in _ITEM_NAMES:
        if re.fullmatch(of_type, type_name) and re.fullmatch(of_field, path):
            return things
    return "values"


def quantity_text(value: float, unit: str, signed: bool = True, error: float = 0.0) -> str:
    """A number with its unit, three digits of it: `+12 mm`, `−1.5°`, `0.2 m/s²`.

    Lengths under a metre are in mm, angles in degrees, magnetic fields in µT.

    Args:
        value: in `unit`.
        unit: SI, as `unit_of` gives it.
        signed: whether a plus is written.
        error: how far off the number may be, in `unit`; digits below that are left out.
    """
    sign = "−" if value < 0 else "+" if signed else ""
    size = abs(value)
    if math.isnan(size):
        return "nan"
    if math.isinf(size):
        return f"{sign}inf"
    if unit == "rad":
        return f"{sign}{_digits(math.degrees(size), math.degrees(error))}°"
    if unit == "ns":
        return quantity_text(value * 1e-9, "s", signed, error * 1e-9)
    if 0.0 < size < 1.0 and unit in _SMALL:
        shown, factor = _SMALL[unit]
        if size * factor < 0.1 and unit in _SMALLER:
            shown, factor = _SMALLER[unit]
        return f"{sign}{_digits(size * factor, error * factor)} {shown}"
    gap = "" if unit in ("", "°") else " "
    return f"{sign}{_digits(size, error)}{gap}{unit}"


def value_text(value: float, unit: str, digits: int = 6) -> str:
    """A value as such, with as many digits as it has, up to some."""
    number = float(value)
    if unit == "ns":
        return f"{number * 1e-9:.9g} s"
    text = f"{number:.{digits}g}"
    text = "−" + text[1:] if text.startswith("-") else text
    return f"{text} {unit}" if unit and unit != "°" else f"{text}{unit}"


def time_text(time: float) -> str:
    """A time in words: `t = 3.20 s`; milliseconds where it is between hundredths."""
    hundredths = round(time * 100.0, 6)
    return f"t = {time:.2f} s" if hundredths == round(hundredths) else f"t = {time:.6f}".rstrip("0") + " s"


def _digits(size: float, error: float) -> str:
    """Three digits or as many as are certain, without an exponent where that stays short."""
    if size == 0.0:
        return "0"
    if size >= 99_999.5 or size < 1e-3:
        return f"{size:.2e}".replace("e-0", "e-").replace("e+0", "e+").replace("e+", "e")
    first = -math.floor(math.log10(size))
    places = first + 2
    if error > 0.0:
        places = max(first, min(places, math.floor(-math.log10(error))))
    found = f"{size:.{max(0, places)}f}"
    return found.rstrip("0").rstrip(".") if "." in found else found
