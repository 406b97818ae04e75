"""Maps as arrays."""

from __future__ import annotations

from simkit_nodes.message_arrays import (
    numpy_to_occupancy_grid,
    occupancygrid_to_numpy,
)

__all__ = [
    "numpy_to_occupancy_grid",
    "occupancygrid_to_numpy",
]
