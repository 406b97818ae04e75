"""Layered layout of a directed graph: columns from left to right, with few crossings.

The method is that of Sugiyama, Tagawa and Toda (1981). Cycles are broken, boxes get columns, and edges over several
columns get bends. Each column is sorted by the mean of the neighbours, and boxes move towards their neighbours.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from simkit.float_sum import float_sum

Edge = tuple[str, str]

_SWEEPS: Final = 12
_BEND: Final = 6.0  # [px] height of an edge that passes a column
_GAP: Final = 14.0  # [px] between two boxes of a column
_BETWEEN: Final = 70.0  # [px] between two columns


@dataclass
class Layout:
    """Places of boxes and edges [px].

    Attributes:
        boxes: left, top, width and height of each box.
        paths: points of each edge, from its first box to its second one.
        width, height: size of the drawing.
    """

    boxes: dict[str, tuple[float, float, float, float]] = field(default_factory=dict)
    paths: dict[Edge, list[tuple[float, float]]] = field(default_factory=dict)
    width: float = 0.0
    height: float = 0.0


def layered_layout(sizes: Mapping[str, tuple[float, float]], edges: Sequence[Edge]) -> Layout:
    """Return the places of the boxes and edges of a graph.

    Args:
        sizes: width and height of each box [px].
        edges: pairs of boxes; edges of a box with itself are left out.
    """
    without_loops = list(dict.fromkeys(edge for edge in edges if edge[0] != edge[1]))
    forward = _without_cycles(list(sizes), without_loops)
    column = _columns(list(sizes), [edge for edge, _ in forward])
    bends: dict[Edge, list[str]] = {}
    height = {name: size[1] for name, size in sizes.items()}
    columns: list[list[str]] = [[] for _ in range(max(column.values(), default=-1) + 1)]
    for name in sizes:
        columns[column[name]].append(name)
    links: list[Edge] = []
    for number, ((start, end), is_turned) in enumerate(forward):
        chain = [start]
        for at in range(column[start] + 1, column[end]):
            bend = f"\0{number}.{at}"
            columns[at].append(bend)
            height[bend] = _BEND
            chain.append(bend)
        chain.append(end)
        links += list(itertools.pairwise(chain))
        bends[(end, start) if is_turned else (start, end)] = chain[::-1] if is_turned else chain
    _order(columns, links)
    middles = _heights(columns, links, height)
    return _placed(columns, middles, sizes, bends)


def _without_cycles(names: Sequence[str], edges: Sequence[Edge]) -> list[tuple[Edge, bool]]:
    """Return the edges without cycles, those that close one turned around; True marks turned edges."""
    after: dict[str, list[str]] = {name: [] for name in names}
    for start, end in edges:
        after[start].append(end)
    state = dict.fromkeys(names, 0)  # 1: on the path of the search, 2: done
    closing: set[Edge] = set()
    entered = {end for _, end in edges}
    for root in sorted(names, key=lambda name: name in entered):  # sources first
        if state[root]:
            continue
        state[root] = 1
        waiting = [(root, iter(after[root]))]
        while waiting:
            name, following = waiting[-1]
            other = next(following, None)
            if other is None:
                state[name] = 2
                waiting.pop()
            elif state[other] == 1:
                closing.add((name, other))
            elif not state[other]:
                state[other] = 1
                waiting.append((other, iter(after[other])))
    return [(((end, start), True) if (start, end) in closing else ((start, end), False)) for start, end in edges]


def _columns(names: Sequence[str], edges: Sequence[Edge]) -> dict[str, int]:
    """Return the column of each box: after all boxes before it, and directly before the first one after it."""
    before: dict[str, list[str]] = {name: [] for name in names}
    after: dict[str, list[str]] = {name: [] for name in names}
    for start, end in dict.fromkeys(edges):
        before[end].append(start)
        after[start].append(end)
    column: dict[str, int] = {}
    missing = {name: len(before[name]) for name in names}
    order = [name for name in names if not missing[name]]
    for name in order:
        column[name] = max((column[neighbour] + 1 for neighbour in before[name]), default=0)
        for end in after[name]:
            missing[end] -= 1
            if not missing[end]:
                order.append(end)
    for name in reversed(order):
        if after[name] and not before[name]:
            column[name] = min(column[neighbour] for neighbour in after[name]) - 1
    return column


def _neighbours(columns: Sequence[Sequence[str]], links: Sequence[Edge]) -> tuple[dict[str, list[str]], ...]:
    """Return the neighbours in the column before, and in the column after, of each box and bend."""
    before: dict[str, list[str]] = {name: [] for names in columns for name in names}
    after: dict[str, list[str]] = {name: [] for names in columns for name in names}
    for start, end in links:
        after[start].append(end)
        before[end].append(start)
    return before, after


def _order(columns: list[list[str]], links: Sequence[Edge]) -> None:
    """Sort each column by the mean position of the neighbours; keep the order with the fewest crossings."""
    before, after = _neighbours(columns, links)
    best, fewest = [list(names) for names in columns], _crossings(columns, after)
    for sweep in range(_SWEEPS):
        numbers = range(1, len(columns)) if sweep % 2 == 0 else range(len(columns) - 2, -1, -1)
        sides = before if sweep % 2 == 0 else after
        for number in numbers:
            other = columns[number - 1 if sweep % 2 == 0 else number + 1]
            position = {name: place for place, name in enumerate(other)}
            row = {name: place for place, name in enumerate(columns[number])}
            mean = {
                name: sum(position[neighbour] for neighbour in sides[name]) / len(sides[name])
                if sides[name]
                else row[name]
                for name in columns[number]
            }
            columns[number].sort(key=lambda name: (mean[name], row[name]))
        count = _crossings(columns, after)
        if count < fewest:
            best, fewest = [list(names) for names in columns], count
    columns[:] = best


def _crossings(columns: Sequence[Sequence[str]], after: Mapping[str, Sequence[str]]) -> int:
    """Count the crossings between neighbouring columns."""
    total = 0
    for left, right in itertools.pairwise(columns):
        position = {name: place for place, name in enumerate(right)}
        ends = [place for name in left for place in sorted(position[end] for end in after[name])]
        total += sum(ends[i] > ends[j] for i in range(len(ends)) for j in range(i + 1, len(ends)))
    return total


def _heights(columns: Sequence[Sequence[str]], links: Sequence[Edge], height: Mapping[str, float]) -> dict[str, float]:
    """Return the middle of each box and bend [px]: near the mean of its neighbours, without overlaps."""
    before, after = _neighbours(columns, links)
    middle: dict[str, float] = {}
    for names in columns:
        top = 0.0
        for name in names:
            middle[name] = top + height[name] / 2
            top += height[name] + _GAP
    for sweep in range(_SWEEPS):
        for names in columns if sweep % 2 == 0 else reversed(columns):
            near = [
                [middle[neighbour] for neighbour in (*before[name], *after[name])] or [middle[name]] for name in names
            ]
            _spread(names, [float_sum(values) / len(values) for values in near], height, middle)
    return middle


def _spread(
    names: Sequence[str], wanted: Sequence[float], height: Mapping[str, float], middle: dict[str, float]
) -> None:
    """Set the middles of a column nearest to the wanted ones in their order (pool adjacent violators)."""
    offsets, offset = [], 0.0
    for number, name in enumerate(names):
        if number:
            offset += (height[names[number - 1]] + height[name]) / 2 + _GAP
        offsets.append(offset)
    blocks: list[tuple[float, int]] = []  # mean of wanted minus offset, and number of boxes
    for value, shift in zip(wanted, offsets, strict=True):
        mean, count = value - shift, 1
        while blocks and blocks[-1][0] > mean:
            other, more = blocks.pop()
            mean, count = (mean * count + other * more) / (count + more), count + more
        blocks.append((mean, count))
    positions = [mean for mean, count in blocks for _ in range(count)]
    for name, position, shift in zip(names, positions, offsets, strict=True):
        middle[name] = position + shift


def _placed(
    columns: Sequence[Sequence[str]],
    middles: Mapping[str, float],
    sizes: Mapping[str, tuple[float, float]],
    bends: Mapping[Edge, Sequence[str]],
) -> Layout:
    layout = Layout()
    left = 0.0
    at: dict[str, tuple[float, float]] = {}  # left and right end of each box and bend
    tops = [middles[name] - sizes[name][1] / 2 for name in sizes]
    top = min(tops, default=0.0)
    for names in columns:
        widest = max((sizes[name][0] for name in names if name in sizes), default=0.0)
        for name in names:
            width = sizes[name][0] if name in sizes else widest
            start = left + (widest - width) / 2
            at[name] = (start, start + width)
            if name in sizes:
                layout.boxes[name] = (start, middles[name] - sizes[name][1] / 2 - top, *sizes[name])
        left += widest + _BETWEEN
    for edge, chain in bends.items():
        points: list[tuple[float, float]] = []
        is_turned = len(chain) > 1 and at[chain[0]][0] > at[chain[-1]][0]
        for number, name in enumerate(chain):
            ends = at[name][::-1] if is_turned else at[name]
            visible = ends[1:] if number == 0 else ends[:1] if number == len(chain) - 1 else ends
            points += [(x, middles[name] - top) for x in visible]
        layout.paths[edge] = points
    layout.width = max(left - _BETWEEN, 0.0)
    bottoms = [box[1] + box[3] for box in layout.boxes.values()]
    layout.height = max([*bottoms, *(y for path in layout.paths.values() for _, y in path)], default=0.0)
    return layout
