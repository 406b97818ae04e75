"""The office's floors, walls, doors and windows. Lengths m; x along the corridor."""

from __future__ import annotations

from collections.abc import Sequence

from office_parts import Part

HALF_LENGTH, HALF_WIDTH, CORRIDOR = 6.5, 4.8, 1.2
WALL, HEIGHT, DOOR = 0.12, 2.4, 2.05


def wall(
    name: str, a: tuple[float, float], b: tuple[float, float], doors: Sequence[tuple[float, float]] = ()
) -> list[Part]:
    """A wall from a to b along x or y; doors as (from, to) along it, with a lintel above."""
    along_x = a[1] == b[1]
    start, end = (a[0], b[0]) if along_x else (a[1], b[1])
    fixed = a[1] if along_x else a[0]

    def part(label: str, low: float, high: float, bottom: float) -> Part:
        length, middle, tall = high - low, (low + high) / 2, HEIGHT - bottom
        size = (length, WALL, tall) if along_x else (WALL, length, tall)
        at = (middle, fixed, bottom + tall / 2) if along_x else (fixed, middle, bottom + tall / 2)
        return Part(label, size, at, "wall")

    found, place = [], start
    for i, (low, high) in enumerate(doors, 1):
        found += [part(f"{name}_{i}", place, low, 0.0), part(f"{name}_lintel_{i}", low, high, DOOR)]
        place = high
    return [*found, part(f"{name}_end", place, end, 0.0)]


def floor(name: str, x: tuple[float, float], y: tuple[float, float], look: str) -> Part:
    size = (x[1] - x[0], y[1] - y[0], 0.004)
    return Part(name, size, ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2, -0.002), look, felt=False)


def building() -> list[Part]:
    length, width, hall = HALF_LENGTH, HALF_WIDTH, CORRIDOR
    found = [
        floor("floor_hall", (-length, length), (-hall, hall), "corridor"),
        floor("floor_north", (-length, length), (hall, width), "carpet"),
        floor("floor_open", (-length, 2.0), (-width, -hall), "carpet"),
        floor("floor_kitchen", (2.0, length), (-width, -hall), "tiles"),
        *wall("north", (-length, width), (length, width)),
        *wall("south", (-length, -width), (length, -width)),
        *wall("west", (-length, -width), (-length, width)),
        *wall("east", (length, -width), (length, width)),
        *wall("hall_north", (-length, hall), (length, hall), [(-3.2, -2.2), (0.6, 1.6), (3.6, 4.6)]),
        *wall("hall_south", (-length, -hall), (length, -hall), [(-4.2, -0.8), (3.2, 4.2)]),
        *wall("between_offices", (-1.2, hall), (-1.2, width)),
        *wall("meeting", (2.6, hall), (2.6, width)),
        *wall("kitchen", (2.0, -width), (2.0, -hall)),
    ]
    # a stripe along the corridor, windows, and a board with the way out: something for the eye
    for i, x in enumerate((-4.6, -1.9, 0.7, 4.4)):
        found.append(Part(f"window_{i}", (1.5, 0.02, 1.1), (x, width - WALL / 2 - 0.005, 1.5), "glass", felt=False))
        found.append(
            Part(f"window_south_{i}", (1.5, 0.02, 1.1), (x, -width + WALL / 2 + 0.005, 1.5), "glass", felt=False)
        )
    for name, side in (("accent", 1), ("accent_west", -1)):
        at = (side * (length - WALL / 2 - 0.005), 0.0, HEIGHT / 2)
        found.append(Part(name, (0.02, 2 * hall - WALL, HEIGHT), at, "accent", felt=False))
    return found
