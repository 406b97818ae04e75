"""Geom groups for cameras and rays: cameras see VISUAL; rays against collisions see COLLISION and COLLISION_RAY."""

from __future__ import annotations

from typing import Final

DRAWN_COLLISION: Final = 1
"""Group of geoms that are drawn and collide; cameras and all rays see them."""

VISUAL: Final = 2
"""Group of geoms that are drawn and never collide."""

COLLISION: Final = 3
"""Group of geoms that collide; rays against collisions see them."""

COLLISION_RAY: Final = 4
"""Group of exact copies of meshes that collide as other shapes: rays against collisions see them, but they never
collide."""

COLLISION_CONTACT: Final = 5
"""Group of hulls, convex pieces and wheel cylinders that collide instead of a mesh; no ray sees them."""

SEEN_AS_COLLISIONS: Final = (COLLISION, COLLISION_RAY, DRAWN_COLLISION)
"""Groups that rays against collisions see."""
