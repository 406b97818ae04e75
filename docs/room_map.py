"""Draw the rooms of simkit and its packs, with arrows for imports: python docs/room_map.py > docs/images/rooms.svg.

A room is a folder or module directly under `simkit/`, or a pack. Each room is above all rooms that it imports. An arrow
that follows from two others is left out. All rooms may import the small modules, so these have one box without arrows.
"""

from __future__ import annotations

import ast
import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CORE = ROOT / "simkit"
FRONT = {"__init__", "__main__", "extend", "facade"}  # they hand on names of all rooms
WIDTH, ROW, BOX, HEIGHT, GAP = 1180, 92, 118, 44, 14  # [px]


def main() -> None:
    """Write the drawing to the standard output."""
    rooms = read_rooms()
    arrows = {room: {name for name in used if name in rooms} for room, (_, used) in rooms.items()}
    small = {room for room in rooms if not (CORE / room).is_dir() and room not in PACKS and not arrows[room] & FOLDERS}
    count = sum(rooms[room][0] for room in small)
    arrows = {room: used - small - {room} for room, used in arrows.items() if room not in small}
    level = {room: level_of(room, arrows) for room in arrows}
    top = max(level[room] for room in arrows if room not in PACKS)
    for pack in PACKS:
        level[pack] = top + 1 + level_of(pack, {name: arrows[name] & PACKS for name in PACKS})
    places = place(level)
    lines = [text for room in arrows for text in draw_arrows(room, shown(room, arrows), places, level)]
    height = ROW * (max(level.values()) + 2) + 10
    note = f"{len(small)} small modules for all rooms: {count:,} lines of code"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif">',
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" orient="auto">',
        '<path d="M0 0L8 4L0 8z" fill="#5b6b7a"/></marker></defs><rect width="100%" height="100%" fill="#fff"/>',
        *lines,
    ]
    for room, (x, y) in places.items():
        colour = "#fdf0d8" if room in PACKS else "#e3eef9"
        parts.append(draw_box(room.removeprefix("simkit_"), rooms[room][0], x, y, colour))
    frame = f'<rect x="10" y="{height - 60}" width="{WIDTH - 20}" height="40" rx="6" fill="#eef1f3" stroke="#5b6b7a"/>'
    text = f'<text x="{WIDTH / 2:g}" y="{height - 35}" font-size="14" text-anchor="middle">{note}</text>'
    sys.stdout.write("\n".join([*parts, frame, text, "</svg>\n"]))


def read_rooms() -> dict[str, tuple[int, set[str]]]:
    """Return the lines of code of each room and the rooms that it imports, in files and in functions."""
    sizes: dict[str, int] = defaultdict(int)
    uses: dict[str, set[str]] = defaultdict(set)
    for folder in (CORE, *(path.parent for path in PACK_FILES)):
        for path in sorted(folder.rglob("*.py")):
            parts = path.relative_to(folder.parent).with_suffix("").parts
            room = parts[1] if parts[0] == "simkit" else parts[0]
            if room in FRONT:
                continue
            source = path.read_text(encoding="utf-8")
            sizes[room] += sum(bool(re.match(r"\s*[^#\s]", line)) for line in source.splitlines())
            uses[room] |= set(imported_rooms(source))
    return {room: (sizes[room], uses[room] - {room}) for room in sorted(sizes)}


def imported_rooms(source: str) -> list[str]:
    """Return the rooms that a file imports."""
    names: list[str] = []
    for node in statements(ast.parse(source)):
        if isinstance(node, ast.ImportFrom):
            names += [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
    split = [name.split(".") for name in names]
    return [parts[1] if parts[0] == "simkit" else parts[0] for parts in split if len(parts) > 1 or parts[0] in PACKS]


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the statements in a node, without their expressions, which take two thirds of the time."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, ast.expr):
            yield child
            yield from statements(child)


def level_of(room: str, arrows: dict[str, set[str]]) -> int:
    """Return the length of the longest way down from a room."""
    return max((level_of(used, arrows) + 1 for used in arrows.get(room, ())), default=0)


def shown(room: str, arrows: dict[str, set[str]]) -> set[str]:
    """Return the rooms that a room imports, without those that another of them imports; of a pack, only packs."""
    used = arrows[room] & PACKS if room in PACKS else arrows[room]
    return {name for name in used if not any(name in reach(other, arrows) for other in used - {name})}


def reach(room: str, arrows: dict[str, set[str]]) -> set[str]:
    """Return all rooms below a room."""
    return arrows[room].union(*(reach(used, arrows) for used in arrows[room]))


def place(level: dict[str, int]) -> dict[str, tuple[float, float]]:
    """Return the left upper corner of each box [px]: rows by level, the lowest at the bottom."""
    rows: dict[int, list[str]] = defaultdict(list)
    for room, row in sorted(level.items()):
        rows[row].append(room)
    last, places = max(rows), {}
    for row, names in rows.items():
        step = min(BOX + 60, (WIDTH - 20) / len(names))
        left = (WIDTH - step * len(names) + step - BOX) / 2
        places.update({name: (left + step * i, ROW * (last - row) + 10) for i, name in enumerate(names)})
    return places


def draw_arrows(room: str, used: set[str], places: dict[str, tuple[float, float]], level: dict[str, int]) -> list[str]:
    """Return one line for each arrow from a room."""
    x, y = places[room]
    lines = []
    for name in sorted(used):
        end_x, end_y = places[name]
        bend = 0 if level[room] - level[name] == 1 else (-1) ** level[name] * BOX * 0.7
        start, end = (x + BOX / 2, y + HEIGHT), (end_x + BOX / 2, end_y - 1)
        middle = ((start[0] + end[0]) / 2 + bend, (start[1] + end[1]) / 2)
        way = f"M{start[0]:.0f} {start[1]:.0f}Q{middle[0]:.0f} {middle[1]:.0f} {end[0]:.0f} {end[1]:.0f}"
        lines.append(f'<path d="{way}" fill="none" stroke="#5b6b7a" stroke-width="1.2" marker-end="url(#tip)"/>')
    return lines


def draw_box(name: str, lines: int, x: float, y: float, colour: str) -> str:
    """Return a box with the name and the lines of code of a room."""
    centre = f'x="{x + BOX / 2:.0f}" text-anchor="middle"'
    box = f'<rect x="{x:.0f}" y="{y:.0f}" width="{BOX}" height="{HEIGHT}" rx="6" fill="{colour}" stroke="#5b6b7a"/>'
    title = f'<text {centre} y="{y + 19:.0f}" font-size="14">{name}</text>'
    return f'{box}{title}<text {centre} y="{y + 36:.0f}" font-size="11" fill="#5b6b7a">{lines:,} lines</text>'


PACK_FILES = sorted(ROOT.glob("packs/*/simkit_*/__init__.py"))
PACKS = {path.parent.name for path in PACK_FILES}
FOLDERS = {path.name for path in CORE.iterdir() if path.is_dir()} - {"msgs"}

if __name__ == "__main__":
    main()
