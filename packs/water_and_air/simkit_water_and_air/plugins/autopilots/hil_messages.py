"""Fields of MAVLink's HIL messages from readings in the axes of Gazebo.

Gazebo's axes are forward-left-up and east-north-up; those of MAVLink are forward-right-down and north-east-down. Units
are those of MAVLink's `common.xml`: gauss, hPa, °C, 1e-7 degrees, mm, cm/s; accelerations of the true state are in
mm/s², as PX4's plugin sends them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.extend import Vector
from simkit.linear_algebra import matmul, norm
from simkit.pose import quat_multiply
from simkit_water_and_air.plugins.autopilots.mavlink import Value

if TYPE_CHECKING:
    from simkit import Link

_MOTION, _FIELD, _PRESSURE, _AIR = 0b111111, 0b111 << 6, 0b1101 << 9, 1 << 10  # bits of fields_updated
_NED_OF_ENU: Final = (0.0, math.sqrt(0.5), math.sqrt(0.5), 0.0)
_FRD_OF_FLU: Final = (0.0, 1.0, 0.0, 0.0)
_FLIP: Final = np.array((1.0, -1.0, -1.0))
_SATELLITES: Final = 10


def sensor_message(
    time: int,
    gyro: Vector,
    force: Vector,
    field: Vector | None,
    pressure: tuple[float, float, float] | None,
    air: float | None = None,
) -> dict[str, float]:
    """Return the fields of HIL_SENSOR.

    Args:
        time: time [µs].
        gyro: angular rate, forward-left-up [rad/s].
        force: specific force, forward-left-up [m/s²].
        field: magnetic field, forward-left-up [gauss]; None if there is no new reading.
        pressure: pressure [hPa], altitude [m] and temperature [°C]; None if there is no new reading.
        air: pressure of the air that flows by [hPa]; None if there is no new reading.
    """
    names = ("xacc", "yacc", "zacc", "xgyro", "ygyro", "zgyro", "xmag", "ymag", "zmag")
    vectors = (force * _FLIP, gyro * _FLIP, np.zeros(3) if field is None else field * _FLIP)
    fields: dict[str, float] = dict(zip(names, np.concatenate(vectors).tolist(), strict=True))
    updated = _MOTION
    if field is not None:
        updated |= _FIELD
    if pressure is not None:
        updated |= _PRESSURE
        fields["abs_pressure"], fields["pressure_alt"], fields["temperature"] = pressure
    if air is not None:
        updated |= _AIR
        fields["diff_pressure"] = air
    return {**fields, "time_usec": time, "fields_updated": updated}


def gps_message(time: int, place: tuple[float, float, float], velocity: Vector) -> dict[str, float]:
    """Return the fields of HIL_GPS.

    Args:
        time: time of the measurement [µs].
        place: latitude and longitude [rad], altitude [m].
        velocity: east, north and up [m/s].
    """
    east, north, up = velocity.tolist()
    course = math.degrees(math.atan2(east, north)) % 360.0
    return {
        "time_usec": time,
        "fix_type": 3,
        **_degrees(place),
        "eph": 100,
        "epv": 100,
        "vel": 100 * math.hypot(east, north),
        "vn": 100 * north,
        "ve": 100 * east,
        "vd": -100 * up,
        "cog": min(100 * course, 35999.0),
        "satellites_visible": _SATELLITES,
    }


def state_message(time: int, link: Link, place: tuple[float, float, float]) -> dict[str, Value]:
    """Return the fields of HIL_STATE_QUATERNION, the true state of a link.

    Args:
        time: time [µs].
        link: link of the vehicle.
        place: latitude and longitude [rad], altitude [m].
    """
    axes, velocity = link.pose.matrix, link.linear_velocity
    attitude = quat_multiply(quat_multiply(_NED_OF_ENU, link.pose.quaternion), _FRD_OF_FLU)
    attitude = -attitude if attitude[0] < 0 else attitude
    rates = (matmul(link.angular_velocity, axes) * _FLIP).tolist()
    forces = (matmul(link.linear_acceleration, axes) * _FLIP).tolist()
    east, north, up = velocity.tolist()
    return {
        "time_usec": time,
        "attitude_quaternion": tuple(attitude.tolist()),
        **dict(zip(("rollspeed", "pitchspeed", "yawspeed"), rates, strict=True)),
        **_degrees(place),
        "vx": 100 * north,
        "vy": 100 * east,
        "vz": -100 * up,
        "ind_airspeed": 100 * max(float(matmul(velocity, axes[:, 0])), 0.0),
        "true_airspeed": 100 * norm(velocity),
        **{name: 1000 * value for name, value in zip(("xacc", "yacc", "zacc"), forces, strict=True)},
    }


def _degrees(place: tuple[float, float, float]) -> dict[str, float]:
    latitude, longitude, altitude = place
    return {"lat": math.degrees(latitude) * 1e7, "lon": math.degrees(longitude) * 1e7, "alt": 1000 * altitude}
