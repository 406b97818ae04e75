"""Handle of a model with the interface of gz-sim's Python class `Model`."""

from __future__ import annotations

from simkit_gz_python.math.simkit_conversion import PoseLike, simkit_pose
from simkit_gz_python.sim.entity_handle import EntityHandle, child_methods
from simkit_gz_python.sim.entity_table import K_NULL_ENTITY, WORLD_ENTITY
from simkit_gz_python.sim.entity_view import EntityView


class Model(EntityHandle):
    """Model of the world, or model nested in another model."""

    KIND = "model"
    joints, joint_by_name, joint_count = child_methods("joint")
    links, link_by_name, link_count = child_methods("link")
    models, model_by_name = child_methods("model")[:2]
    """Direct child models."""

    def static(self, ecm: EntityView) -> bool:
        scene = self._scene(ecm)
        return bool(scene is not None and scene.static)

    def self_collide(self, ecm: EntityView) -> bool:
        scene = self._scene(ecm)
        return bool(scene is not None and scene.self_collide)

    def wind_mode(self, ecm: EntityView) -> bool:
        """Check whether the wind acts on all links of the model."""
        scene = self._scene(ecm)
        links = scene.links if scene is not None else ()
        return bool(links) and all(link.enable_wind for link in links)

    def source_file_path(self, ecm: EntityView) -> str:
        """Return the path of the model's file; empty if the model was loaded from a text."""
        scene = self._scene(ecm)
        return (scene.where.file or "") if scene is not None else ""

    def canonical_link(self, ecm: EntityView) -> int:
        """Return the canonical link, which may be in a nested model; 0 if there is none.

        Its motion is the model's motion.
        """
        scene = self._scene(ecm)
        link = ecm.sync().link(scene.canonical_link) if scene is not None else None
        return link.entity if link is not None else K_NULL_ENTITY

    def set_world_pose_cmd(self, ecm: EntityView, pose: PoseLike) -> None:
        """Set the pose of the model in the world before the next step.

        As in gz-sim, the command has no effect on a nested model; a warning reports that.
        """
        record = self._record(ecm)
        if record is None:
            return
        if record.parent != WORLD_ENTITY:
            sim = ecm.simulation
            if ("nested", record.scene.scoped) not in ecm.warned:
                ecm.warned.add(("nested", record.scene.scoped))
                message = f"set_world_pose_cmd of the nested model {record.scene.scoped!r} has no effect"
                outer = record.scene.scoped.split("::")[0]
                sim.engine.reports.warning("SK-PLUGIN-085", message, record.scene.where, f"set the pose of {outer!r}")
            return
        ecm.commands.pose[self._entity] = simkit_pose(pose)


class PartOfModel(EntityHandle):
    """Base class of `Link` and `Joint`, which belong to a model and may have sensors."""

    sensors, sensor_by_name, sensor_count = child_methods("sensor")

    def parent_model(self, ecm: EntityView) -> Model | None:
        parent = self._parent(ecm)
        return Model(parent) if parent is not None else None
