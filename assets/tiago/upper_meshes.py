"""The shapes of torso and head, in the frames of their links."""

from __future__ import annotations

from shapely.geometry import Polygon
from solids import Mesh, along_x, barrel, disc, hull, moved, rectangle, slab, stack


def torso_foot() -> list[Mesh]:
    """The foot around the column, and the tray that slopes down to the front."""
    foot = rectangle((-0.114, -0.125), (0.122, 0.125), 0.020)
    upper = rectangle((-0.106, -0.117), (0.110, 0.117), 0.018)
    tray = hull(
        (rectangle((0.080, -0.122), (0.283, 0.122), 0.030), 0.0),
        (rectangle((0.080, -0.122), (0.281, 0.122), 0.030), 0.026),
        (rectangle((0.080, -0.108), (0.225, 0.108), 0.024), 0.048),
    )
    return [*stack((foot, 0.0), (foot, 0.085), (upper, 0.104)), tray]


def torso_column() -> list[Mesh]:
    """The telescope's inner part, with the ribs of its bellows."""
    parts = [slab(rectangle((-0.078, -0.098), (0.078, 0.098), 0.010), 0.0, 0.55)]
    for k in range(16):
        parts.append(slab(rectangle((-0.081, -0.101), (0.081, 0.101), 0.012), 0.120 + k * 0.026, 0.130 + k * 0.026))
    return parts


def torso_shell() -> list[Mesh]:
    """Wide at the shoulders, narrow at the waist; in front the shelf that carries head and arm."""
    sections = (
        (rectangle((-0.112, -0.118), (0.088, 0.118), 0.022), -0.467),
        (rectangle((-0.118, -0.122), (0.092, 0.122), 0.022), -0.440),
        (rectangle((-0.122, -0.126), (0.094, 0.126), 0.024), -0.210),
        (rectangle((-0.126, -0.130), (0.095, 0.130), 0.024), -0.178),
        (rectangle((-0.140, -0.144), (0.096, 0.144), 0.024), -0.146),
        (rectangle((-0.163, -0.165), (0.098, 0.165), 0.024), -0.118),
        (rectangle((-0.161, -0.163), (0.098, 0.163), 0.022), -0.014),
        (rectangle((-0.154, -0.156), (0.094, 0.156), 0.020), -0.002),
    )
    shelf = hull(
        (rectangle((0.060, -0.078), (0.190, 0.078), 0.020), -0.100),
        (rectangle((0.060, -0.082), (0.234, 0.082), 0.026), -0.068),
        (rectangle((0.060, -0.082), (0.237, 0.082), 0.026), -0.010),
        (rectangle((0.060, -0.076), (0.231, 0.076), 0.024), -0.002),
    )
    return [*stack(*sections), shelf]


def torso_trim() -> list[Mesh]:
    """The dark plate on top and the seam around the shoulders."""
    return [
        slab(rectangle((-0.140, -0.140), (0.080, 0.140), 0.020), -0.003, 0.0012),
        slab(rectangle((-0.1645, -0.1665), (0.0990, 0.1665), 0.024), -0.1185, -0.1150),
    ]


def arm_bracket() -> list[Mesh]:
    """What holds the arm from below: a drum before the chest."""
    arm = disc(0.048, 0.155, 0.014)
    web = hull((rectangle((0.080, -0.050), (0.100, 0.070), 0.008), -0.245), (arm, -0.225), (arm, -0.182))
    return [web, moved(barrel(0.050, -0.256, -0.176), 0.155, 0.014)]


def neck_shell() -> list[Mesh]:
    """A swivel on the shelf, and the yoke that carries the head."""
    yoke = hull(
        (disc(0.038, 0.0), 0.030),
        (rectangle((-0.050, -0.033), (0.040, 0.033), 0.014), 0.080),
        (rectangle((-0.056, -0.030), (0.034, 0.030), 0.014), 0.120),
    )
    return [barrel(0.043, 0.004, 0.036, 0.006), yoke]


def head_shell() -> list[Mesh]:
    """x forward, y up, z to the right: a broad skull with a slanting brow, and the jaw in the yoke."""

    def profile(shrink: float) -> Polygon:
        points = [(-0.076, 0.040), (-0.062, 0.105), (-0.030, 0.124), (0.075, 0.125), (0.104, 0.112), (0.107, 0.098)]
        points += [(0.100, 0.050), (0.075, 0.022), (0.030, 0.010), (-0.050, 0.012)]
        return Polygon(points).buffer(-shrink, join_style="mitre")

    skull = hull((profile(0.022), -0.130), (profile(0.0), -0.108), (profile(0.0), 0.108), (profile(0.022), 0.130))
    jaw = hull(
        (disc(0.046, 0.0, 0.0), -0.052),
        (disc(0.046, 0.0, 0.0), 0.052),
        (rectangle((-0.060, 0.010), (0.070, 0.050), 0.012), -0.085),
        (rectangle((-0.060, 0.010), (0.070, 0.050), 0.012), 0.085),
    )
    return [skull, jaw]


def head_visor() -> list[Mesh]:
    """The dark window with the camera behind it."""
    face = hull(
        (rectangle((0.096, 0.058), (0.107, 0.102), 0.003), -0.092),
        (rectangle((0.090, 0.054), (0.1105, 0.106), 0.004), -0.080),
        (rectangle((0.090, 0.054), (0.1105, 0.106), 0.004), 0.080),
        (rectangle((0.096, 0.058), (0.107, 0.102), 0.003), 0.092),
    )
    return [face]


def head_lenses() -> list[Mesh]:
    """Colour lens, depth lens and projector; z is to the right, so the colour lens lies at -0.022.

    Their fronts only: the camera looks out from behind them and would see their backs.
    """
    parts = [moved(along_x(barrel(0.011, 0.0, 0.004, 0.001, 18)), 0.109, 0.080, z) for z in (-0.022, 0.035, -0.060)]
    for part in parts:
        part.update_faces(part.face_normals[:, 0] > 0.1)
    return parts
