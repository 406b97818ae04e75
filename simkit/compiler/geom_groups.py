"""Geom groups: who sees what. Cameras see VISUAL; rays against collisions see COLLISION and COLLISION_RAY."""

from __future__ import annotations

from typing import Final

DRAWN_COLLISION: Final = 1
"""Drawn, and collides: one geom for both, seen by cameras and by every ray."""

VISUAL: Final = 2
"""Drawn, never collides."""

COLLISION: Final = 3
"""Collides, and is seen by rays against collisions."""

COLLISION_RAY: Final = 4
"""The exact copy of a non-convex static mesh: seen by rays against collisions, never collides."""

COLLISION_CONTACT: Final = 5
"""The convex pieces that collide in place of such a mesh; seen by no ray."""

SEEN_AS_COLLISIONS: Final = (COLLISION, COLLISION_RAY, DRAWN_COLLISION)
"""All that rays against collisions see."""
