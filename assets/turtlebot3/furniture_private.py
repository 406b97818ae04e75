"""The furniture of bedroom, bathroom, study and hall; see `furniture.py` for how a piece is written."""

from __future__ import annotations

from furniture import Piece, box, legs, mesh, piece, tube

# ------------------------------------------------------------------ bedroom


def bed() -> Piece:
    """1.6 m wide, 2.05 m long; the head is at the back."""
    return piece(
        box("frame", (1.64, 2.05, 0.22), (0, 0, 0.20), "oak"),
        legs(0.76, 0.95, 0.09, "walnut", 0.08),
        box("head", (1.64, 0.06, 0.95), (0, -1.05, 0.475), "oak"),
        box("mattress", (1.58, 1.96, 0.18), (0, 0.02, 0.40), "linen"),
        mesh("blanket", "blanket", (0, 0.28, 0.47), "blanket"),
        mesh("pillow_1", "bed_pillow", (-0.40, -0.72, 0.53), "white"),
        mesh("pillow_2", "bed_pillow", (0.40, -0.72, 0.53), "white"),
    )


def night_stand() -> Piece:
    return piece(
        box("body", (0.42, 0.38, 0.36), (0, 0, 0.28), "oak"),
        legs(0.17, 0.15, 0.10, "walnut", 0.04),
        box("drawer", (0.38, 0.01, 0.13), (0, 0.195, 0.36), "white", felt=False),
        tube("lamp_foot", 0.05, 0.16, (0, 0, 0.54), "terracotta", felt=False),
        mesh("shade", "small_shade", (0, 0, 0.60), "lamp"),
    )


def wardrobe(width: float = 1.5) -> Piece:
    doors = [
        box(f"door_{i}", (width / 2 - 0.02, 0.02, 1.88), (s * width / 4, 0.29, 1.03), "white", felt=False)
        for i, s in ((1, -1), (2, 1))
    ]
    knobs = [
        box(f"knob_{i}", (0.02, 0.03, 0.20), (s * 0.05, 0.31, 1.05), "steel", felt=False) for i, s in ((1, -1), (2, 1))
    ]
    return piece(box("body", (width, 0.58, 2.00), (0, 0, 1.00), "oak"), doors, knobs)


# ------------------------------------------------------------------ bathroom


def bathtub() -> Piece:
    """1.7 m along x."""
    return piece(
        mesh("tub", "bathtub", (0, 0, 0), "ceramic"),
        box("felt_tub", (1.70, 0.75, 0.56), (0, 0, 0.28), "ceramic", seen=False),
        box("water", (1.50, 0.55, 0.01), (0, 0, 0.42), "water", felt=False),
        tube("tap", 0.015, 0.18, (-0.78, 0, 0.65), "steel", felt=False),
        box("spout", (0.14, 0.02, 0.02), (-0.71, 0, 0.73), "steel", felt=False),
    )


def toilet() -> Piece:
    return piece(
        mesh("bowl", "toilet", (0, 0.10, 0), "ceramic"),
        box("felt_bowl", (0.36, 0.50, 0.40), (0, 0.10, 0.20), "ceramic", seen=False),
        box("cistern", (0.40, 0.18, 0.40), (0, -0.22, 0.58), "ceramic"),
        box("foot", (0.22, 0.20, 0.38), (0, -0.20, 0.19), "ceramic", felt=False),
        box("button", (0.06, 0.04, 0.01), (0, -0.22, 0.785), "steel", felt=False),
    )


def wash_stand() -> Piece:
    return piece(
        box("body", (0.80, 0.44, 0.60), (0, 0, 0.52), "oak"),
        legs(0.36, 0.18, 0.22, "walnut", 0.04),
        box("top", (0.84, 0.48, 0.03), (0, 0, 0.835), "white"),
        mesh("basin", "bowl", (0, 0.02, 0.85), "ceramic"),
        tube("tap", 0.012, 0.20, (0, -0.18, 0.95), "steel", felt=False),
        box("mirror", (0.70, 0.02, 0.80), (0, -0.22, 1.45), "water", felt=False),
    )


def washing_machine() -> Piece:
    return piece(
        box("body", (0.60, 0.60, 0.85), (0, 0, 0.425), "white"),
        mesh("door", "porthole", (0, 0.30, 0.43), "steel"),
        box("panel", (0.56, 0.01, 0.10), (0, 0.301, 0.78), "worktop", felt=False),
    )


# ------------------------------------------------------------------ study and hall


def desk() -> Piece:
    return piece(
        box("top", (1.5, 0.70, 0.04), (0, 0, 0.73), "oak"),
        legs(0.70, 0.30, 0.71, "black"),
        box("drawers", (0.40, 0.55, 0.60), (0.50, 0, 0.41), "white"),
        box("monitor", (0.62, 0.03, 0.36), (-0.1, -0.18, 1.05), "black", felt=False),
        box("screen", (0.58, 0.01, 0.32), (-0.1, -0.162, 1.05), "screen", felt=False),
        box("stand", (0.06, 0.06, 0.14), (-0.1, -0.20, 0.82), "steel", felt=False),
        box("keyboard", (0.42, 0.14, 0.02), (-0.1, 0.14, 0.76), "linen", felt=False),
    )


def office_chair() -> Piece:
    return piece(
        mesh("star", "star", (0, 0, 0), "black"),
        box("felt_star", (0.46, 0.46, 0.06), (0, 0, 0.06), "black", seen=False),
        tube("column", 0.03, 0.36, (0, 0, 0.27), "steel"),
        mesh("seat", "round_seat", (0, 0, 0.46), "terracotta"),
        mesh("back", "chair_back", (0, -0.22, 0.78), "terracotta"),
        box("felt_seat", (0.46, 0.46, 0.08), (0, 0, 0.48), "terracotta", seen=False),
        box("bar", (0.05, 0.03, 0.40), (0, -0.24, 0.62), "black"),
    )


def shoe_bench() -> Piece:
    return piece(
        box("top", (0.9, 0.32, 0.04), (0, 0, 0.44), "oak"),
        box("shelf", (0.84, 0.30, 0.02), (0, 0, 0.16), "oak"),
        [box(f"side_{i}", (0.04, 0.32, 0.42), (s * 0.43, 0, 0.21), "walnut") for i, s in ((1, 1), (2, -1))],
        box("shoe_1", (0.09, 0.24, 0.08), (-0.22, 0, 0.21), "book_red", felt=False),
        box("shoe_2", (0.09, 0.24, 0.08), (-0.10, 0, 0.21), "book_red", felt=False),
    )


def coat_stand() -> Piece:
    pegs = [box(f"peg_{i}", (0.24, 0.02, 0.02), (0, 0, 1.50 + 0.12 * i), "walnut", felt=False) for i in range(2)]
    return piece(
        tube("foot", 0.18, 0.03, (0, 0, 0.015), "walnut"), tube("pole", 0.02, 1.70, (0, 0, 0.87), "walnut"), pegs
    )


def picture(look: str, width: float = 0.7, height: float = 0.5) -> Piece:
    """Hangs at eye level; for the eye."""
    return piece(
        box("frame", (width, 0.03, height), (0, 0.015, 1.45), "walnut", felt=False),
        box("canvas", (width - 0.08, 0.01, height - 0.08), (0, 0.030, 1.45), "linen", felt=False),
        box("shape_1", (width * 0.35, 0.01, height * 0.45), (-width * 0.12, 0.033, 1.42), look, felt=False),
        box("shape_2", (width * 0.28, 0.01, height * 0.30), (width * 0.18, 0.036, 1.50), "mustard", felt=False),
    )
