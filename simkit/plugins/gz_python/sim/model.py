"""Models as gz-sim's Python shows them."""

from __future__ import annotations

from simkit.plugins.gz_python.math.simkit_conversion import PoseLike, simkit_pose
from simkit.plugins.gz_python.sim.entity_handle import EntityHandle
from simkit.plugins.gz_python.sim.entity_table import K_NULL_ENTITY, WORLD_ENTITY
from simkit.plugins.gz_python.sim.entity_view import EntityView


class Model(EntityHandle):
    """A model."""

    KIND = "model"

    def static(self, ecm: EntityView) -> bool:
        record = self._record(ecm)
        return bool(record is not None and record.scene.static)

    def self_collide(self, ecm: EntityView) -> bool:
        record = self._record(ecm)
        return bool(record is not None and record.scene.self_collide)

    def wind_mode(self, ecm: EntityView) -> bool:
        """Check whether the wind pushes it: all of its links."""
        record = self._record(ecm)
        links = record.scene.links if record is not None else ()
        return bool(links) and all(link.enable_wind for link in links)

    def source_file_path(self, ecm: EntityView) -> str:
        """The file it stands in; empty where it came as a text."""
        record = self._record(ecm)
        return (record.scene.where.file or "") if record is not None else ""

    def joint_by_name(self, ecm: EntityView, name: str) -> int:
        """0 where there is none."""
        return self._named(ecm, "joint", name)

    def link_by_name(self, ecm: EntityView, name: str) -> int:
        """0 where there is none."""
        return self._named(ecm, "link", name)

    def model_by_name(self, ecm: EntityView, name: str) -> int:
        """A nested model; 0 where there is none."""
        return self._named(ecm, "model", name)

    def joints(self, ecm: EntityView) -> list[int]:
        return self._below(ecm, "joint")

    def links(self, ecm: EntityView) -> list[int]:
        return self._below(ecm, "link")

    def models(self, ecm: EntityView) -> list[int]:
        """The models directly in it."""
        return self._below(ecm, "model")

    def joint_count(self, ecm: EntityView) -> int:
        return len(self.joints(ecm))

    def link_count(self, ecm: EntityView) -> int:
        return len(self.links(ecm))

    def canonical_link(self, ecm: EntityView) -> int:
        """The link whose motion is the model's; it may be in a nested model. 0 where there is none."""
        record = self._record(ecm)
        if record is None:
            return K_NULL_ENTITY
        wanted = record.scene.canonical_link
        return next((r.entity for r in ecm.sync() if r.kind == "link" and r.scene.scoped == wanted), K_NULL_ENTITY)

    def set_world_pose_cmd(self, ecm: EntityView, pose: PoseLike) -> None:
        """Puts the model at a pose in the world, before the next step.

        A nested model stays where it is, as in gz-sim, and a warning says so.
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
