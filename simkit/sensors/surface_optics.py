"""Optical properties of the surfaces that rays and cameras see, by geom of the compiled model."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from simkit.compiler import Compiled
from simkit.pose import Vector
from simkit.scene import DEFAULT_REFLECTIVITY, NO_OPTICS


class SurfaceOptics(NamedTuple):
    """Optical properties by geom id, each of shape (ngeom + 1,); the last entry is for no geom and is 0.

    Attributes:
        reflectivity: share of the light that the surface scatters.
        transmittance: share of the light that passes through the surface.
        specularity: share of the light that the surface reflects as a mirror.
    """

    reflectivity: Vector
    transmittance: Vector
    specularity: Vector


def surface_optics(compiled: Compiled, *, of_visuals: bool) -> SurfaceOptics:
    """Return the optical properties of all visuals, or of all collisions.

    A surface without a reflectivity scatters `DEFAULT_REFLECTIVITY` of the light that it neither transmits nor
    reflects as a mirror. The arrays are shared by all sensors and read-only.
    """
    kind = "visuals" if of_visuals else "collisions"
    optics: SurfaceOptics = compiled.names.shared(f"optics of {kind}", lambda: _table(compiled, of_visuals))
    return optics


def _table(compiled: Compiled, of_visuals: bool) -> SurfaceOptics:
    names = compiled.names
    optics = SurfaceOptics(*(np.zeros(compiled.model.ngeom + 1) for _ in range(3)))
    optics.reflectivity[:-1] = DEFAULT_REFLECTIVITY
    for link in names.links.values():
        shapes = link.scene.visuals if of_visuals else link.scene.collisions
        values = {shape.scoped: shape.optics for shape in shapes if shape.optics is not NO_OPTICS}
        for geom in (link.visuals if of_visuals else link.ray_geoms) if values else ():
            value = values.get(names.geom_owner(geom)[1], NO_OPTICS)
            rest = max(0.0, 1.0 - value.transmittance - value.specularity)
            optics.reflectivity[geom] = (
                DEFAULT_REFLECTIVITY * rest if value.reflectivity is None else value.reflectivity
            )
            optics.transmittance[geom], optics.specularity[geom] = value.transmittance, value.specularity
    for column in optics:
        column.flags.writeable = False
    return optics
