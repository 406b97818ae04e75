"""The people in the office: where they stand, sit and walk, and what they look like. Lengths m, speeds m/s, angles rad;
degrees where it says so.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from office_parts import number, numbers

DESKS = {  # x, y and where whoever sits there looks (degrees)
    "a1": (-5.6, 3.9, 180.0), "a2": (-2.1, 3.9, 0.0), "b1": (1.6, 3.9, 0.0),
    "c1": (-5.6, -2.3, 180.0), "c2": (-5.6, -3.9, 180.0), "d1": (-1.8, -3.9, 0.0), "d2": (0.9, -3.9, 0.0),
}  # fmt: skip


def seat_of(key: str, away: float = 0.62) -> tuple[float, float, float]:
    """Where the one at a desk sits: x, y and where they look [degrees]."""
    x, y, looks = DESKS[key]
    return x - away * math.cos(math.radians(looks)), y - away * math.sin(math.radians(looks)), looks


def rounded(corners: Sequence[tuple[float, float]], radius: float) -> list[tuple[float, float]]:
    """A closed way round the corners, each of them an arc, as a fine polygon."""
    found: list[tuple[float, float]] = []
    count = len(corners)
    for i in range(count):
        (ax, ay), (bx, by), (cx, cy) = corners[i - 1], corners[i], corners[(i + 1) % count]
        before, after = math.hypot(ax - bx, ay - by), math.hypot(cx - bx, cy - by)
        near = min(radius, 0.49 * before, 0.49 * after)
        p = (bx + (ax - bx) / before * near, by + (ay - by) / before * near)
        q = (bx + (cx - bx) / after * near, by + (cy - by) / after * near)
        for k in range(9):
            t = k / 8
            a, b, c = (1 - t) ** 2, 2 * t * (1 - t), t * t
            found.append((a * p[0] + b * bx + c * q[0], a * p[1] + b * by + c * q[1]))
    return found


def waypoints(corners: Sequence[tuple[float, float]], speed: float, radius: float = 0.8) -> list[tuple[float, ...]]:
    """Time, x, y and heading every 0.6 s along a closed way at an even pace."""
    line = rounded(corners, radius)
    line.append(line[0])
    along = [0.0]
    for (ax, ay), (bx, by) in pairwise(line):
        along.append(along[-1] + math.hypot(bx - ax, by - ay))
    count = max(4, round(along[-1] / speed / 0.6))
    step = along[-1] / count

    def at(way: float) -> tuple[float, float]:
        way %= along[-1]
        i = next(k for k in range(1, len(along)) if along[k] >= way)
        part = (way - along[i - 1]) / max(along[i] - along[i - 1], 1e-9)
        (ax, ay), (bx, by) = line[i - 1], line[i]
        return ax + part * (bx - ax), ay + part * (by - ay)

    found, heading = [], None
    for k in range(count + 1):
        (x, y), (fx, fy), (px, py) = at(k * step), at(k * step + 0.05), at(k * step - 0.05)
        new = math.atan2(fy - py, fx - px)
        if heading is not None:
            new = heading + math.remainder(new - heading, 2 * math.pi)
        heading = new
        found.append((round(k * step / speed, 2), x, y, new))
    return found


WALKERS = {
    "walking_woman": ([(-5.6, -0.8), (5.6, -0.8), (5.6, 0.8), (-5.6, 0.8)], 1.15, 0.0),
    "walking_man": ([(-4.6, -1.75), (1.2, -1.75), (1.2, -2.75), (-4.0, -2.75)], 0.95, 0.0),
    "visitor": (
        [(4.35, -0.35), (4.35, 1.62), (3.1, 1.62), (3.1, 4.42), (5.9, 4.42), (5.9, 1.75), (3.85, 1.75), (3.85, 0.3),
         (2.6, 0.3), (2.6, -0.35)],
        0.9, 4.0,
    ),
}  # fmt: skip
STANDING = {
    "colleague_1": (4.45, -2.25, -38.0), "colleague_2": (5.35, -2.95, 142.0), "waiting_man": (-0.6, 3.0, -90.0),
}  # fmt: skip
SITTING = {"programmer": "a1", "secretary": "b1", "student": "c2"}
PEOPLE = {
    "walking_woman": (1.68, (0.70, 0.24, 0.30), (0.15, 0.17, 0.22), (0.90, 0.74, 0.63), (0.36, 0.22, 0.13)),
    "walking_man": (1.80, (0.23, 0.38, 0.60), (0.30, 0.27, 0.23), (0.86, 0.69, 0.56), (0.15, 0.11, 0.09)),
    "visitor": (1.76, (0.90, 0.90, 0.92), (0.12, 0.13, 0.16), (0.58, 0.41, 0.30), (0.10, 0.08, 0.07)),
    "colleague_1": (1.72, (0.28, 0.50, 0.38), (0.20, 0.24, 0.34), (0.92, 0.78, 0.68), (0.64, 0.50, 0.28)),
    "colleague_2": (1.84, (0.78, 0.62, 0.26), (0.18, 0.18, 0.20), (0.78, 0.58, 0.45), (0.16, 0.12, 0.10)),
    "waiting_man": (1.78, (0.42, 0.34, 0.54), (0.24, 0.25, 0.28), (0.88, 0.72, 0.60), (0.48, 0.47, 0.47)),
    "programmer": (1.77, (0.16, 0.18, 0.21), (0.24, 0.30, 0.42), (0.91, 0.76, 0.65), (0.55, 0.35, 0.18)),
    "secretary": (1.66, (0.86, 0.70, 0.72), (0.22, 0.20, 0.24), (0.74, 0.54, 0.42), (0.12, 0.09, 0.08)),
    "student": (1.74, (0.85, 0.46, 0.20), (0.22, 0.28, 0.38), (0.93, 0.80, 0.70), (0.70, 0.56, 0.34)),
}


def person_lines(name: str) -> list[str]:
    height, *colours = PEOPLE[name]
    inner = f"<height>{number(height)}</height>"
    for label, colour in zip(("shirt", "trousers", "skin", "hair"), colours, strict=True):
        inner += f"<{label}>{numbers(colour)}</{label}>"  # type: ignore[arg-type]
    return [f"      <simkit:person>{inner}</simkit:person>"]


def actor_lines(name: str) -> Iterator[str]:
    yield f'    <actor name="{name}">'
    if name in WALKERS:
        corners, speed, delay = WALKERS[name]
        yield from person_lines(name)
        yield "      <script>"
        yield f"        <loop>true</loop><delay_start>{number(delay)}</delay_start><auto_start>true</auto_start>"
        yield '        <trajectory id="0" type="walking">'
        for time, x, y, yaw in waypoints(corners, speed):
            pose = numbers((x, y, 0, 0, 0, yaw))
            yield f"          <waypoint><time>{number(time)}</time><pose>{pose}</pose></waypoint>"
        yield "        </trajectory>"
        yield "      </script>"
    else:
        x, y, degrees = STANDING[name] if name in STANDING else seat_of(SITTING[name], 0.60)
        yield f"      <pose>{numbers((x, y, 0, 0, 0, math.radians(degrees)))}</pose>"
        yield from person_lines(name)
        kind = "standing" if name in STANDING else "sitting"
        yield f'      <script><trajectory id="0" type="{kind}"/></script>'
    yield "    </actor>"
