"""Belts, tracks and tracked vehicles."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, model

_BOX = '<collision name="hull"><geometry><box><size>1 1 1</size></box></geometry></collision>'
_BELT = (
    '<plugin filename="gz-sim-track-controller-system" name="gz::sim::systems::TrackController">\n'
    "  <link>base</link>{inner}\n</plugin>"
)


def _wheels(geometry: str, inner: str = "") -> str:
    links = "\n".join(
        f'<link name="{name}">{INERTIAL}<collision name="tyre"><geometry>{geometry}</geometry></collision></link>'
        for name in ("a", "b")
    )
    joints = "\n".join(
        f'<joint name="{name}_axle" type="continuous"><parent>base</parent><child>{name}</child>'
        "<axis><xyz>0 1 0</xyz></axis></joint>"
        for name in ("a", "b")
    )
    return (
        f'<link name="base">{INERTIAL}</link>\n{links}\n{joints}\n'
        '<plugin filename="libWheelTrackedVehiclePlugin.so" name="tracks">\n'
        f"  <left_joint>a_axle</left_joint><right_joint>b_axle</right_joint>{inner}\n</plugin>"
    )


CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-100",
        "note",
        "`<debug>` of a track: Gazebo draws arrows where it touches, simkit does not",
        "leave it out",
        model(f'<link name="base">{INERTIAL}{_BOX}</link>\n{_BELT.format(inner="<debug>true</debug>")}'),
    ),
    Code(
        "SK-PLUGIN-101",
        "warning",
        "the link of a belt or a track has no collision, so there is nothing that it could carry",
        "give the link a `<collision>`",
        model(f'<link name="base">{INERTIAL}</link>\n{_BELT.format(inner="")}'),
    ),
    Code(
        "SK-PLUGIN-102",
        "error",
        "the wheel of a tracked vehicle has no round collision, so its radius is not known",
        "give the wheel's link a cylinder or a sphere to collide with",
        model(_wheels("<box><size>1 1 1</size></box>")),
    ),
    Code(
        "SK-PLUGIN-103",
        "warning",
        "a tracked vehicle with wheels asks for different friction along and across",
        "give both the same value",
        model(
            _wheels("<sphere><radius>0.1</radius></sphere>", "\n  <track_mu>0.7</track_mu><track_mu2>1.5</track_mu2>")
        ),
    ),
)
