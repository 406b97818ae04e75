"""Handle of the world with the interface of gz-sim's Python class `World`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from simkit.scene import SphericalCoordinates as Place
from simkit_gz_python.math import Angle, Pose3d, SphericalCoordinates, Vector3d
from simkit_gz_python.math.simkit_conversion import gz_pose, gz_vector
from simkit_gz_python.math.spherical_coordinates import Surface
from simkit_gz_python.sdformat import Atmosphere
from simkit_gz_python.sim.entity_handle import EntityHandle, child_methods
from simkit_gz_python.sim.entity_table import K_NULL_ENTITY, WORLD_ENTITY
from simkit_gz_python.sim.entity_view import EntityView


class World(EntityHandle):
    """World of the simulation, with its lights, actors and models."""

    KIND = "world"
    lights, light_by_name, light_count = child_methods("light")
    """Lights that are not on a link."""
    actors, actor_by_name, actor_count = child_methods("actor")
    models, model_by_name, model_count = child_methods("model")
    """Models that are not nested."""

    def gravity(self, ecm: EntityView) -> Vector3d | None:
        """Return the gravity [m/s²]."""
        return gz_vector(ecm.simulation.mj_model.opt.gravity) if self.valid(ecm) else None

    def magnetic_field(self, ecm: EntityView) -> Vector3d | None:
        """Return the magnetic field [T] in world axes."""
        return gz_vector(ecm.simulation.world.magnetic_field) if self.valid(ecm) else None

    def atmosphere(self, ecm: EntityView) -> Atmosphere | None:
        if not self.valid(ecm):
            return None
        air = ecm.simulation.world.atmosphere
        return Atmosphere(air.temperature, air.temperature_gradient, air.pressure)

    def spherical_coordinates(self, ecm: EntityView) -> SphericalCoordinates | None:
        """Return the planet and location of the world's origin; None if the file has no `<spherical_coordinates>`."""
        return _coordinates(ecm.simulation.control.origin.place) if self.valid(ecm) else None

    def set_spherical_coordinates(self, ecm: EntityView, coordinates: SphericalCoordinates) -> None:
        """Move the world's origin to another location on the planet, immediately.

        From then on, NavSat sensors and magnetometers use the new location.
        """
        if not self.valid(ecm):
            return
        site = ecm.simulation.control.origin
        site.move(
            replace(
                site.place or Place(where=ecm.simulation.world.where),
                latitude=float(coordinates.latitude_reference().radian()),
                longitude=float(coordinates.longitude_reference().radian()),
                elevation=float(coordinates.elevation_reference()),
                heading=float(coordinates.heading_offset().radian()),
                surface=Surface(int(coordinates.surface())).name,
                equatorial=float(coordinates.surface_axis_equatorial()),
                polar=float(coordinates.surface_axis_polar()),
            )
        )


def _coordinates(place: Place | None) -> SphericalCoordinates | None:
    if place is None:
        return None
    surface = Surface[place.surface]
    angles = (Angle(place.latitude), Angle(place.longitude), place.elevation, Angle(place.heading))
    coordinates = SphericalCoordinates(surface, *angles)
    if surface is Surface.CUSTOM_SURFACE:
        coordinates.set_surface(surface, place.equatorial, place.polar)
    return coordinates


def world_entity(*values: Any) -> int:
    """Return the world's entity; 0 without a simulation.

    Args:
        values: the manager, or an entity (which has no effect) and the manager.
    """
    ecm = values[-1]
    return WORLD_ENTITY if ecm.record(WORLD_ENTITY, "world") is not None else K_NULL_ENTITY


def world_pose(entity: int, ecm: EntityView) -> Pose3d:
    """Return the pose of an entity in the world; the identity for an entity without a pose."""
    record = ecm.record(entity)
    if record is None or not record.kind or record.kind == "world":
        return Pose3d()
    if record.kind in ("model", "link"):
        return gz_pose(ecm.handle(entity, record.kind).pose)
    if record.kind == "light":
        return gz_pose(ecm.handle(entity, "light").pose)
    scene, parent = record.scene, ecm.record(record.parent)
    assert parent is not None
    if record.kind == "actor":
        return gz_pose(scene.pose_world)
    if record.kind == "joint":
        child = ecm.sync().link(scene.child_link)
        if child is None:
            return gz_pose(scene.pose_world)
        return gz_pose(ecm.handle(child.entity, "link").pose @ child.scene.pose_world.inverse() @ scene.pose_world)
    if record.kind == "sensor" and parent.kind == "joint":
        inner = parent.scene.pose_world.inverse() @ scene.pose_world
        return world_pose(parent.entity, ecm) * gz_pose(inner)
    return gz_pose(ecm.handle(parent.entity, "link").pose @ scene.pose_link)
