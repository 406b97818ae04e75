"""Drawing of a message: shapes, lines, points, triangles, texts, meshes and grids in the frames of links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.linear_algebra import matmul
from simkit.run_spec import JsonObject
from simkit_view.displays.frame_poses import Placement

Floats = npt.NDArray[np.float64]
Arrays = dict[str, npt.NDArray[np.generic]]
Colour = tuple[float, float, float, float]
SHAPES: Final = ("cube", "sphere", "cylinder", "cone")
"""Shapes of size 1 around the origin; cylinders and cones along z."""
_MOST_SHAPES: Final = 20_000
_MOST_POINTS: Final = 200_000  # ends of lines, points and corners of triangles
_MOST_TEXTS: Final = 300
_MOST_PROBLEMS: Final = 5
_LONGEST_TEXT: Final = 200  # characters of one text
_FARTHEST: Final = 1e6  # [m]; a page cannot draw what is farther away


class Group:
    """Elements in the frame of one link; see `Drawing`."""

    def __init__(self) -> None:
        self.shapes: dict[str, list[Floats]] = {shape: [] for shape in SHAPES}
        self.lines: dict[float, list[tuple[Floats, Floats]]] = {}
        self.points: dict[float, list[tuple[Floats, Floats]]] = {}
        self.triangles: list[tuple[Floats, Floats]] = []
        self.texts: list[list[object]] = []
        self.meshes: list[tuple[str, list[float]]] = []
        self.grids: list[tuple[JsonObject, npt.NDArray[np.uint8]]] = []
        self.handles: list[JsonObject] = []


class Drawing:
    """Elements of a display. Elements with NaN, infinite values or no size are left out, and told as problems.

    Attributes:
        problems: texts for the user about what is not drawn, the first few.
    """

    def __init__(self) -> None:
        self.problems: list[str] = []
        self._groups: dict[str, Group] = {}
        self._count = {"shapes": 0, "points": 0, "texts": 0}
        self._meshes: dict[str, Arrays] = {}

    def tell(self, problem: str) -> None:
        """Add a problem, if it is new and there are few."""
        if problem not in self.problems and len(self.problems) < _MOST_PROBLEMS:
            self.problems.append(problem)

    def shapes(self, shape: str, at: Placement, rows: Floats) -> None:
        """Add shapes.

        Args:
            shape: one of `SHAPES`.
            at: frame of the rows.
            rows: position [m], quaternion (w, x, y, z), size [m] and RGBA, shape (n, 14).
        """
        rows = np.asarray(rows, np.float64).reshape(-1, 14)
        rows = self._usable(rows, rows[:, :10])
        norms = np.linalg.norm(rows[:, 3:7], axis=1)
        if (norms == 0).any():  # RViz draws these without a rotation, too
            rows[norms == 0, 3:7] = (1.0, 0.0, 0.0, 0.0)
        rows = rows[: self._room("shapes", len(rows), _MOST_SHAPES)]
        if len(rows):
            self._group(at).shapes[shape].append(_moved_rows(rows, at.pose))

    def lines(self, at: Placement, ends: Floats, colours: Floats | Colour, width: float) -> None:
        """Add line segments: ends [m], shape (2 n, 3), and RGBA of each end or of all."""
        self._add_points("lines", at, ends, colours, width, 2)

    def strip(self, at: Placement, points: Floats, colours: Floats | Colour, width: float) -> None:
        """Add connected line segments: points [m], shape (n, 3)."""
        points = np.asarray(points, np.float64).reshape(-1, 3)
        index = np.repeat(np.arange(len(points)), 2)[1:-1]
        colours = np.asarray(colours, np.float64)
        self.lines(at, points[index], colours[index] if colours.ndim == 2 else colours, width)

    def points(self, at: Placement, points: Floats, colours: Floats | Colour, size: float) -> None:
        """Add points: shape (n, 3) [m], and their size [m]."""
        self._add_points("points", at, points, colours, size, 1)

    def triangles(self, at: Placement, corners: Floats, colours: Floats | Colour) -> None:
        """Add triangles: corners [m], shape (3 n, 3)."""
        self._add_points("triangles", at, corners, colours, 0.0, 3)

    def text(self, at: Placement, place: Sequence[float], text: str, height: float, colour: Colour) -> None:
        """Add a text that faces the viewer, with a height of its capital letters [m]."""
        values = np.array([[*place, height, *colour]], np.float64)
        if len(self._usable(values, values)) and self._room("texts", 1, _MOST_TEXTS):
            placed = at.pose.transform(place)
            self._group(at).texts.append([text[:_LONGEST_TEXT], *map(float, placed), float(height), *colour])

    def mesh(self, at: Placement, name: str, parts: Arrays, row: Floats) -> None:
        """Add a mesh: its corners and colours, and a row as for `shapes`."""
        rows = self._usable(row.reshape(1, 14), row.reshape(1, 14)[:, :10])
        if len(rows) and self._room("shapes", 1, _MOST_SHAPES):
            self._meshes[name] = parts
            self._group(at).meshes.append((name, _moved_rows(rows, at.pose)[0].tolist()))

    def grid(self, at: Placement, cells: npt.NDArray[np.uint8], resolution: float, origin: Pose, colours: str) -> None:
        """Add a grid: values of the cells, shape (rows along y, columns along x), and the pose of its corner."""
        pose = at.pose @ origin
        head = {"rows": cells.shape[0], "columns": cells.shape[1], "resolution": resolution, "colours": colours}
        self._group(at).grids.append(({**head, "pose": pose.as_list()}, cells))

    def handle(self, at: Placement, content: JsonObject) -> None:
        """Add a handle at a placement, by which a page moves or turns something."""
        self._group(at).handles.append({**content, "pose": at.pose.as_list()})

    # ------------------------------------------------------------------ limits

    def _usable(self, rows: Floats, numbers: Floats) -> Floats:
        """Return the rows whose numbers can be drawn; the others are told."""
        is_usable = (np.abs(numbers) <= _FARTHEST).all(axis=1)  # false for NaN, too
        if not is_usable.all():
            self.tell("NaN, infinite or very large values are not drawn")
        return rows[is_usable]

    def _room(self, kind: str, count: int, most: int) -> int:
        """Return how many of `count` elements there is room for."""
        left = most - self._count[kind]
        if count > left:
            self.tell(f"only {most} {kind} are drawn")
        self._count[kind] += min(count, left)
        return max(0, min(count, left))

    def _add_points(
        self, kind: str, at: Placement, points: Floats, colours: Floats | Colour, width: float, size: int
    ) -> None:
        points = np.asarray(points, np.float64).reshape(-1, 3)
        colours = np.broadcast_to(np.asarray(colours, np.float64), (len(points), 4))
        points, colours = points[: len(points) // size * size], colours[: len(points) // size * size]
        is_usable = (np.abs(points) <= _FARTHEST).all(axis=1).reshape(-1, size).all(axis=1).repeat(size)
        if not is_usable.all() or not 0 <= width <= _FARTHEST:
            self.tell("NaN, infinite or very large values are not drawn")
            if not 0 <= width <= _FARTHEST:
                return
        count = self._room("points", int(is_usable.sum()), _MOST_POINTS) // size * size
        drawn = np.flatnonzero(is_usable)[:count]
        if len(drawn) == 0:
            return
        placed = matmul(points[drawn], at.pose.matrix.T) + at.pose.position
        cloud, group = (placed, np.clip(np.nan_to_num(colours[drawn]), 0, 1)), self._group(at)
        if kind == "triangles":
            group.triangles.append(cloud)
        else:
            table = group.lines if kind == "lines" else group.points
            table.setdefault(round(float(width), 4), []).append(cloud)

    def _group(self, at: Placement) -> Group:
        return self._groups.setdefault(at.link, Group())

    # ------------------------------------------------------------------ content

    def pack(self, bodies: dict[str, tuple[int, Pose]]) -> tuple[JsonObject, Arrays]:
        """Return the head and the arrays of a packet with the drawing.

        Args:
            bodies: body of each link, and the link's pose in the body; a missing link is not drawn.
        """
        arrays: Arrays = {}
        names = list(self._meshes)
        for number, parts in enumerate(self._meshes.values()):
            arrays |= {f"mesh{number}.{name}": values for name, values in parts.items()}
        groups: list[JsonObject] = []
        for link, group in self._groups.items():
            body, offset = bodies.get(link, (0, Pose())) if link else (0, Pose())
            if link in bodies or not link:
                groups.append({"body": body, "pose": offset.as_list()} | _pack(group, f"g{len(groups)}", names, arrays))
        return {"groups": groups, "problems": self.problems}, arrays


def _pack(group: Group, prefix: str, meshes: list[str], arrays: Arrays) -> JsonObject:
    """Add the arrays of a group, and return its head."""
    for shape, rows in group.shapes.items():
        if rows:
            arrays[f"{prefix}.{shape}"] = np.concatenate(rows)
    head: JsonObject = {
        "texts": group.texts,
        "meshes": [[meshes.index(name), row] for name, row in group.meshes],
        "grids": [values for values, _ in group.grids],
        "handles": group.handles,
    }
    for number, (_, cells) in enumerate(group.grids):
        arrays[f"{prefix}.grid{number}"] = cells
    for kind, table in (("lines", group.lines), ("points", group.points), ("triangles", {0.0: group.triangles})):
        head[kind] = []
        for width, pieces in table.items():
            if pieces:
                name = f"{prefix}.{kind}{len(head[kind])}"
                head[kind].append(width)
                arrays[name] = np.concatenate([points for points, _ in pieces])
                colours = np.concatenate([colours for _, colours in pieces])
                arrays[f"{name}.colours"] = np.round(255 * colours).astype(np.uint8)
    return head


def _moved_rows(rows: Floats, pose: Pose) -> Floats:
    """Return rows of shapes with their poses in the parent frame of `pose`."""
    moved = rows.copy()
    moved[:, :3] = matmul(rows[:, :3], pose.matrix.T) + pose.position
    w, x, y, z = (float(v) for v in pose.quaternion)
    product = np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])  # left multiplication
    turned = matmul(rows[:, 3:7], product.T)
    moved[:, 3:7] = turned / np.linalg.norm(turned, axis=1, keepdims=True)
    return moved
