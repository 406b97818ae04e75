"""Rays from one point: against the engine's own geoms where they are few, by NumPy and Embree where they are many."""

from simkit.sensors.rays.ray_fan import MANY_RAYS, RayFan, fan_directions

__all__ = ["MANY_RAYS", "RayFan", "fan_directions"]
