"""Optical properties of a collision or visual, which are simkit's own elements."""

from __future__ import annotations

from simkit.params import Params
from simkit.scene import NO_OPTICS, Optics

_MOST_REFLECTIVE = 1000.0  # a retro-reflector returns some hundred times the light of a white wall


def read_optics(block: Params, default: Optics = NO_OPTICS) -> Optics:
    """Return the optical properties in a `<collision>` or `<visual>`; `default` for those that it does not name."""
    reflectivity = default.reflectivity
    if block.has("reflectivity"):
        reflectivity = block.number("reflectivity", reflectivity, minimum=0.0, maximum=_MOST_REFLECTIVE)
    transmittance = block.number("transmittance", default.transmittance, minimum=0.0, maximum=1.0)
    specularity = block.number("specularity", default.specularity, minimum=0.0, maximum=1.0)
    optics = Optics(reflectivity, transmittance, specularity)
    return default if optics == default else optics
