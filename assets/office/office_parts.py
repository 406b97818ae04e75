"""What the office is made of: simple shapes in its looks, and their text. Lengths m."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

LOOKS = {
    "wall": (0.92, 0.91, 0.87), "accent": (0.42, 0.56, 0.60), "door": (0.55, 0.40, 0.27), "carpet": (0.47, 0.50, 0.54),
    "corridor": (0.72, 0.68, 0.60), "tiles": (0.80, 0.82, 0.82), "desk": (0.83, 0.72, 0.55),
    "metal": (0.62, 0.64, 0.66),
    "chair": (0.17, 0.19, 0.22), "screen": (0.06, 0.08, 0.12), "white": (0.95, 0.95, 0.94), "leaf": (0.22, 0.46, 0.23),
    "pot": (0.72, 0.42, 0.30), "sofa": (0.24, 0.40, 0.45), "counter": (0.30, 0.30, 0.32), "red": (0.66, 0.20, 0.18),
    "blue": (0.20, 0.32, 0.58), "yellow": (0.86, 0.68, 0.22), "paper": (0.97, 0.96, 0.92), "glass": (0.65, 0.80, 0.88),
}  # fmt: skip


@dataclass(frozen=True)
class Part:
    """A box (x, y, z), a cylinder (radius, length) or an ellipsoid (radii), its middle at `at`."""

    name: str
    size: tuple[float, ...]
    at: tuple[float, float, float]
    look: str
    kind: str = "box"
    felt: bool = True
    seen: bool = True
    yaw: float = 0.0


def piece(name: str, parts: Iterable[Part], x: float, y: float, degrees: float = 0.0) -> list[Part]:
    """Parts of a piece of furniture in the room; a piece stands on z = 0 and faces +x."""
    turn = math.radians(degrees)
    c, s = math.cos(turn), math.sin(turn)
    return [
        replace(
            p,
            name=f"{name}_{p.name}",
            at=(x + c * p.at[0] - s * p.at[1], y + s * p.at[0] + c * p.at[1], p.at[2]),
            yaw=p.yaw + turn,
        )
        for p in parts
    ]


def number(value: float) -> str:
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def numbers(values: Iterable[float]) -> str:
    return " ".join(number(v) for v in values)


def looks_of(parts: Iterable[Part]) -> dict[str, list[Part]]:
    found: dict[str, list[Part]] = {}
    for part in parts:
        if part.seen:
            found.setdefault(part.look, []).append(part)
    return found
