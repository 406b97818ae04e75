"""Belts, crates and vehicles on tracks, as text."""

from __future__ import annotations

from plugin_worlds import GROUND, world

BELT = "/model/conveyor/link/belt/track_cmd_vel"
CENTRE = "/model/conveyor/link/belt/track_cmd_center_of_rotation"


def rubs(mu: float, mu2: float | None = None, fdir1: str = "") -> str:
    across = mu if mu2 is None else mu2
    direction = f"<fdir1>{fdir1}</fdir1>" if fdir1 else ""
    return f"<surface><friction><ode><mu>{mu}</mu><mu2>{across}</mu2>{direction}</ode></friction></surface>"


def track_controller(link: str, inner: str = "") -> str:
    return (
        '<plugin filename="gz-sim-track-controller-system" name="gz::sim::systems::TrackController">'
        f"<link>{link}</link>{inner}</plugin>"
    )


def conveyor(inner: str = "", *, mu: float = 0.7, surface: str = "", size: str = "40 4 0.1", **values: str) -> str:
    """Its upper side is at z = 0."""
    pose, static = values.get("pose", "0 0 -0.05 0 0 0"), values.get("static", "<static>true</static>")
    return (
        f'<model name="conveyor"><pose>{pose}</pose>{static}<link name="belt">{values.get("inertial", "")}'
        f'<collision name="c"><geometry><box><size>{size}</size></box></geometry>{surface or rubs(mu)}'
        "</collision></link>"
        f"{values.get('extra', '')}{track_controller('belt', inner)}</model>"
    )


def crate(
    pose: str = "0 0 0.05 0 0 0", name: str = "crate", mass: float = 1.0, shape: str = "", mu: float = 1.0
) -> str:
    """0.1 m each way."""
    moment = mass * 0.01 / 6
    inertia = "".join(f"<{axis}>{moment}</{axis}>" for axis in ("ixx", "iyy", "izz"))
    geometry = shape or "<box><size>0.1 0.1 0.1</size></box>"
    return (
        f'<model name="{name}"><pose>{pose}</pose><link name="link"><inertial><mass>{mass}</mass>'
        f"<inertia>{inertia}</inertia>"
        f'</inertial><collision name="c"><geometry>{geometry}</geometry>{rubs(mu)}</collision></link></model>'
    )


def wall(x: float) -> str:
    """A smooth one, whose face looks towards -x."""
    return (
        f'<model name="wall"><static>true</static><pose>{x + 0.05} 0 0.3 0 0 0</pose><link name="link">'
        '<collision name="c">'
        f"<geometry><box><size>0.1 2 0.6</size></box></geometry>{rubs(0)}</collision></link></model>"
    )


def _track(side: str, y: float, surface: str) -> str:
    wheel = "<cylinder><length>0.1</length><radius>0.09</radius></cylinder>"
    ends = "".join(
        f'<collision name="end{x}"><pose>{x} 0 0 1.5707963 0 0</pose><geometry>{wheel}</geometry>{surface}</collision>'
        for x in (-0.25, 0.25)
    )
    return (
        f'<link name="{side}_track"><pose>0 {y} 0.09 0 0 0</pose><inertial><mass>6</mass><inertia><ixx>0.02</ixx>'
        "<iyy>0.15</iyy><izz>0.15</izz></inertia></inertial>"
        f'<collision name="c"><geometry><box><size>0.5 0.1 0.18</size></box></geometry>{surface}'
        f"</collision>{ends}</link>"
        f'<joint name="{side}_weld" type="fixed"><parent>base</parent><child>{side}_track</child></joint>'
    )


TRACKED = (
    '<plugin filename="gz-sim-tracked-vehicle-system" name="gz::sim::systems::TrackedVehicle">'
    "<left_track><link>left_track</link></left_track><right_track><link>right_track</link></right_track>"
    "<tracks_separation>0.4</tracks_separation>{inner}</plugin>"
)


def tank(plugins: str, surface: str = "", pose: str = "0 0 0 0 0 0") -> str:
    """25 kg on two tracks, 0.4 m apart; its frame is on the ground in the middle."""
    surface = surface or rubs(0.7)
    return (
        f'<model name="tank"><pose>{pose}</pose><link name="base"><pose>0 0 0.15 0 0 0</pose><inertial>'
        "<mass>13</mass><inertia>"
        "<ixx>0.1</ixx><iyy>0.35</iyy><izz>0.3</izz></inertia></inertial>"
        '<collision name="c"><geometry><box><size>0.5 0.25 0.1</size></box></geometry></collision></link>'
        f"{_track('left', 0.2, surface)}{_track('right', -0.2, surface)}{plugins}</model>"
    )


def gz_tank(inner: str = "", **values: str) -> str:
    controllers = "".join(track_controller(f"{side}_track") for side in ("left", "right"))
    return tank(TRACKED.format(inner=inner) + controllers, **values)


__all__ = [
    "BELT",
    "CENTRE",
    "GROUND",
    "conveyor",
    "crate",
    "gz_tank",
    "rubs",
    "tank",
    "track_controller",
    "wall",
    "world",
]
