"""The office's furniture: each piece stands on z = 0 and faces +x. Lengths m."""

from __future__ import annotations

import math
from collections.abc import Sequence

from office_parts import Part


def desk() -> list[Part]:
    """Whoever sits at it is on its +x side."""
    return [
        Part("top", (0.75, 1.5, 0.03), (0.0, 0.0, 0.725), "desk"),
        Part("leg_left", (0.65, 0.04, 0.71), (0.0, 0.70, 0.355), "metal"),
        Part("leg_right", (0.65, 0.04, 0.71), (0.0, -0.70, 0.355), "metal"),
        Part("back", (0.02, 1.36, 0.40), (-0.30, 0.0, 0.50), "metal"),
        Part("foot", (0.18, 0.24, 0.02), (-0.20, 0.0, 0.75), "chair", felt=False),
        Part("pole", (0.03, 0.05, 0.20), (-0.22, 0.0, 0.85), "chair", felt=False),
        Part("screen", (0.03, 0.56, 0.33), (-0.20, 0.0, 1.06), "chair"),
        Part("picture", (0.004, 0.53, 0.30), (-0.184, 0.0, 1.065), "blue", felt=False),
        Part("keyboard", (0.14, 0.42, 0.02), (0.14, 0.0, 0.75), "screen", felt=False),
        Part("papers", (0.21, 0.30, 0.02), (0.10, 0.48, 0.75), "paper", felt=False),
    ]


def chair() -> list[Part]:
    return [
        Part("base", (0.27, 0.05), (0.0, 0.0, 0.06), "chair", "cylinder"),
        Part("pole", (0.03, 0.34), (0.0, 0.0, 0.25), "metal", "cylinder"),
        Part("seat", (0.46, 0.46, 0.07), (0.0, 0.0, 0.44), "chair"),
        Part("back", (0.06, 0.44, 0.48), (-0.23, 0.0, 0.78), "chair"),
    ]


def shelf(colours: Sequence[str] = ("red", "blue", "yellow", "white")) -> list[Part]:
    found = [Part("body", (0.36, 1.0, 1.8), (0.0, 0.0, 0.9), "desk")]
    for row in range(4):
        z = 0.26 + 0.43 * row
        found.append(Part(f"gap_{row}", (0.01, 0.92, 0.34), (0.178, 0.0, z), "counter", felt=False))
        for i in range(5):
            at = (0.186, -0.36 + 0.12 * i + 0.03 * (row % 2), z - 0.03)
            found.append(
                Part(f"folder_{row}_{i}", (0.012, 0.075, 0.27), at, colours[(row + i) % len(colours)], felt=False)
            )
    return found


def plant() -> list[Part]:
    leaves = [
        Part(
            f"leaf_{i}",
            (0.10, 0.05, 0.30),
            (0.13 * math.cos(a), 0.13 * math.sin(a), 0.75),
            "leaf",
            "ellipsoid",
            False,
            True,
            a,
        )
        for i, a in enumerate(2 * math.pi * k / 6 for k in range(6))
    ]
    return [
        Part("pot", (0.17, 0.36), (0.0, 0.0, 0.18), "pot", "cylinder"),
        Part("crown", (0.19, 0.19, 0.34), (0.0, 0.0, 0.72), "leaf", "ellipsoid"),
        *leaves,
    ]


def meeting_table() -> list[Part]:
    return [
        Part("top", (2.0, 1.0, 0.04), (0.0, 0.0, 0.73), "desk"),
        Part("leg_1", (0.10, 0.60, 0.71), (0.70, 0.0, 0.355), "metal"),
        Part("leg_2", (0.10, 0.60, 0.71), (-0.70, 0.0, 0.355), "metal"),
        Part("laptop", (0.30, 0.22, 0.02), (0.30, 0.10, 0.76), "metal", felt=False),
    ]


def board() -> list[Part]:
    return [
        Part("frame", (0.03, 1.84, 1.04), (0.0, 0.0, 1.45), "metal"),
        Part("face", (0.01, 1.78, 0.98), (0.018, 0.0, 1.45), "white", felt=False),
        Part("line_1", (0.004, 0.80, 0.02), (0.025, -0.30, 1.70), "blue", felt=False),
        Part("line_2", (0.004, 0.60, 0.02), (0.025, -0.40, 1.58), "red", felt=False),
    ]


def sofa() -> list[Part]:
    return [
        Part("seat", (0.70, 1.7, 0.42), (0.05, 0.0, 0.21), "sofa"),
        Part("back", (0.20, 1.7, 0.80), (-0.30, 0.0, 0.40), "sofa"),
        Part("arm_left", (0.75, 0.18, 0.58), (0.02, 0.85, 0.29), "sofa"),
        Part("arm_right", (0.75, 0.18, 0.58), (0.02, -0.85, 0.29), "sofa"),
    ]


def counter() -> list[Part]:
    return [
        Part("body", (0.58, 2.6, 0.86), (0.0, 0.0, 0.43), "white"),
        Part("top", (0.62, 2.6, 0.04), (0.0, 0.0, 0.88), "counter"),
        Part("sink", (0.36, 0.50, 0.01), (0.02, 0.60, 0.902), "metal", felt=False),
        Part("machine", (0.30, 0.28, 0.36), (-0.08, -0.55, 1.08), "chair"),
        Part("cupboards", (0.34, 2.6, 0.60), (-0.12, 0.0, 1.80), "white"),
    ]


def fridge() -> list[Part]:
    return [
        Part("body", (0.62, 0.62, 1.85), (0.0, 0.0, 0.925), "metal"),
        Part("handle", (0.03, 0.03, 0.60), (0.325, 0.24, 1.15), "chair", felt=False),
    ]


def round_table() -> list[Part]:
    return [
        Part("top", (0.40, 0.03), (0.0, 0.0, 1.045), "white", "cylinder"),
        Part("pole", (0.04, 1.02), (0.0, 0.0, 0.51), "metal", "cylinder"),
        Part("foot", (0.24, 0.02), (0.0, 0.0, 0.01), "metal", "cylinder"),
    ]
