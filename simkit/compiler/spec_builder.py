"""Builder of MuJoCo's model specification from scenes and from the additions of sensors and plugins."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import mujoco

from simkit import progress
from simkit.compiler import mjcf_attachment
from simkit.compiler.assets import Assets
from simkit.compiler.bodies import remove_split_body
from simkit.compiler.engine_options import apply_options
from simkit.compiler.geoms import WorldGeoms
from simkit.compiler.kinematic_tree import WORLD, JointIndex
from simkit.compiler.lights import add_light, report_light, report_lights
from simkit.compiler.meshes.parallel_conversion import convert_meshes
from simkit.compiler.model_compilation import compile_spec, finish_model
from simkit.compiler.model_writer import FIRST_OWN_BIT, PAIRS_MOST, ModelWriter
from simkit.compiler.name_map import ActuatorRef, JointBinding, LightBinding, ModelRecord, NameMap, lookup
from simkit.compiler.overlapping_hulls import exclude_overlapping_hulls
from simkit.compiler.servo_gains import add_actuator, add_armature, add_drive_armature, set_effort_limit
from simkit.compiler.start_positions import place_joints
from simkit.compiler.state_transfer import transfer_state
from simkit.diagnostics import Diagnostics
from simkit.loaders.sdf.material_script import find_material, find_texture
from simkit.pose import Pose
from simkit.scene import SceneJoint, SceneModel, SceneVisual, SceneWorld

FileFinder = Callable[[str, Path | None], Path | None]


@dataclass(frozen=True, slots=True)
class Compiled:
    """Compiled model with its state, its names with their ids, and its builder."""

    model: mujoco.MjModel
    data: mujoco.MjData
    names: NameMap
    builder: SpecBuilder


def _existing_file(uri: str, folder: Path | None) -> Path | None:
    """Return a file by its path alone; None if it does not exist."""
    path = Path(uri) if folder is None else folder / uri
    return path if path.is_file() else None


class SpecBuilder:
    """Builder that creates and changes the specification of one world.

    Args:
        world: world to build: options, lights and all models.
        diagnostics: collection for approximations and errors.
        find_file: function that returns the file of a URI, relative to a folder; None for a missing one.
        parameter_files: parameter files of the run; only the control plugins read them.
        files_read: files that were read for plugins.

    Attributes:
        records: elements of each top-level model, by scoped name; those of the world under the empty name.
        find_file: function that returns the file of a URI, relative to a folder; None for a missing one.
        files_read: files that plugins have read.
        parameter_files: parameter files of the run; only the control plugins read them.
        shared_servos: servos that a further plugin requested, once for each request.
    """

    def __init__(
        self,
        world: SceneWorld,
        diagnostics: Diagnostics,
        *,
        find_file: FileFinder = _existing_file,
        parameter_files: tuple[Any, ...] = (),
        files_read: Iterable[Path] = (),
    ) -> None:
        self.world, self.diagnostics = world, diagnostics
        self.find_file, self.parameter_files, self.files_read = find_file, parameter_files, list(files_read)
        spec = mujoco.MjSpec()
        spec.modelname = world.name
        self._world_geoms, self.assets = WorldGeoms(spec), Assets(spec)
        self.records: dict[str, ModelRecord] = {"": ModelRecord(SceneModel(name="", scoped="", pose_world=Pose()))}
        self.shared_servos: list[ActuatorRef] = []
        self._names: NameMap | None = None
        self._cut: list[tuple[SceneJoint, bool]] = []
        self._world_joints = JointIndex(world.joints)
        apply_options(spec, world, diagnostics)
        models = mjcf_attachment.models_of_own_file(world)
        mjcf_attachment.adopt_settings(spec, world)
        for light in world.lights:
            if not models:
                add_light(spec.worldbody, light, light.pose_world, world.surroundings.shadows)
                report_light(light, world, diagnostics)
            self.records[""].lights[light.scoped] = LightBinding(light.scoped, light, "")
        if models:
            self.records.update({model.scoped: ModelRecord(model) for model in models})
            mjcf_attachment.attach_world(spec, [self.records[model.scoped] for model in models], world, diagnostics)
        convert_meshes(world.models)
        with progress.task("building models", len(world.models)) as task:
            for model in world.models:
                if model not in models:
                    self.add_model(model)
                task.advance()
        self._join_models()

    @property
    def spec(self) -> mujoco.MjSpec:
        """MuJoCo's specification. `copy` makes its element handles invalid, so look elements up by name."""
        self._world_geoms.attach_waiting()
        self.assets.add_waiting()
        return self._world_geoms.spec

    # ------------------------------------------------------------------ models

    def add_model(self, model: SceneModel, *, movable: bool = False) -> None:
        """Add a top-level model at its poses.

        Args:
            model: model to add.
            movable: True to make the links of a static model mocap bodies, which the user can move during the run.
        """
        movable = movable or model.moved_by is not None
        record = ModelRecord(model, movable)
        if model.scoped in self.records:
            raise ValueError(f"a model {model.scoped!r} exists already")
        self.records[model.scoped] = record
        self._names = None
        self.assets.used = record.assets
        if model.mjcf is not None:
            mjcf_attachment.attach_model(self.spec, record, model, self.diagnostics, ())
        else:
            links = len(list(model.all_links()))
            if links * (links - 1) // 2 > PAIRS_MOST:  # only large models, because there are only 15 bits
                record.own_bit = self._free_bit()
            self._write_model(record)
        if movable:
            self._rejoin_model(model)

    def _writer(self, record: ModelRecord) -> ModelWriter:
        return ModelWriter(self._world_geoms, self.assets, record, self.world, self.diagnostics)

    def _write_model(self, record: ModelRecord) -> None:
        """Write a model, then nested models with a specification of their own, then the joints between them."""
        model = record.scene
        joints = self._joints_of(model)
        attached = [nested for nested in model.all_models() if nested.mjcf is not None]
        inside = {link.scoped for nested in attached for link in nested.links}
        attached_joints = {joint.scoped for nested in attached for joint in nested.joints}
        rest = [j for j in joints if j.scoped not in attached_joints and {j.parent_link, j.child_link} & inside]
        record.scene = mjcf_attachment.without_attached(model)
        self._writer(record).write([j for j in joints if j.scoped not in attached_joints and j not in rest])
        record.scene = model
        for nested in attached:
            done = mjcf_attachment.attach_model(self.spec, record, nested, self.diagnostics, rest)
            rest = [j for j in rest if j not in done]
        if rest:
            links = dict(record.links)
            self._writer(record).join(rest, links)
            record.links.update(links)

    def remove_model(self, scoped: str) -> None:
        """Remove a top-level model with everything that was added to it; raise KeyError for an unknown one."""
        record = lookup(self.records, scoped, "model")
        self._cut_joints_to(record)
        spec = self.spec
        for ref in record.actuators:
            spec.delete(spec.actuator(ref.name))
        named = (spec.equality, record.equalities), (spec.exclude, record.excludes), (spec.site, record.world_sites)
        for element, names in named:
            for name in names:
                spec.delete(element(name))
        for light in record.lights.values():
            if light.body_name == WORLD:
                spec.delete(spec.light(light.scoped))
        self._world_geoms.remove(n for n, o in record.geoms.items() if record.links[o.link].body_name == WORLD)
        for name in record.root_bodies:
            spec.delete(spec.body(name))
        mjcf_attachment.detach_model(spec, record)
        del self.records[scoped]
        still = set().union(*(r.assets for r in self.records.values()))
        self.assets.drop(record.assets - still)
        self._names = None

    def replace_scenes(self, world: SceneWorld, models: Iterable[SceneModel]) -> None:
        """Refer to the descriptions of a world with other numbers.

        Args:
            world: changed world.
            models: its changed top-level models.
        """
        self.world = world
        for model in models:
            self.records[model.scoped].replace_scene(model)

    def _joints_of(self, model: SceneModel) -> list[SceneJoint]:
        """Return the joints of a model, and the joints of the world file that connect the model to the world."""
        links = {link.scoped for link in model.all_links()}
        return [*model.all_joints(), *self._world_joints.between(links)]

    def _join_models(self, only: set[str] | None = None) -> None:
        """Add the joints of the world file that connect two models as constraints; `only` limits them to some names."""
        record = self.records[""]
        done = {name for r in self.records.values() for name in r.joints}
        rest = [j for j in self.world.joints if j.scoped not in done and (only is None or j.scoped in only)]
        if rest:
            self._writer(record).join(rest, {n: b for r in self.records.values() for n, b in r.links.items()})
            self._names = None

    def _rejoin_model(self, model: SceneModel) -> None:
        """Connect a model that was removed and added again to the other models as before."""
        links = {link.scoped for link in model.all_links()}
        cut, self._cut = self._cut, []
        self._join_models({joint.scoped for joint, _ in cut})
        known = {j.scoped for j in self.world.joints}
        for joint, active in cut:
            if joint.scoped not in known and {joint.parent_link, joint.child_link} & links:
                self.add_weld(joint.scoped, joint.parent_link, joint.child_link, active=active)

    def _cut_joints_to(self, record: ModelRecord) -> None:
        world = self.records[""]
        self._cut = []
        for scoped, joint in list(world.joints.items()):
            if {joint.scene.parent_link, joint.scene.child_link} & set(record.links):
                active = all(bool(self.spec.equality(name).active) for name in joint.equalities)
                self._cut.append((joint.scene, active))
                for name in joint.equalities:
                    self.spec.delete(self.spec.equality(name))
                    world.equalities.remove(name)
                if scoped in world.excludes:
                    self.spec.delete(self.spec.exclude(scoped))
                    world.excludes.remove(scoped)
                if joint.twin:
                    remove_split_body(self.spec, joint.twin, self.names.link(joint.carried).body_name)
                    world.root_bodies = [b for b in world.root_bodies if b != joint.twin]
                del world.joints[scoped]

    def _free_bit(self) -> int:
        """Return a collision bit that no model has, above those of the files' masks; 0 if all are used."""
        taken = {record.own_bit for record in self.records.values()}
        return next((1 << i for i in range(FIRST_OWN_BIT, 31) if 1 << i not in taken), 0)

    # ------------------------------------------------------------------ additions of sensors and plugins

    @property
    def names(self) -> NameMap:
        """Names with their bindings, without ids (see `Compiled.names` for those)."""
        if self._names is None:
            self._names = NameMap.of(self.records.values())
        return self._names

    def add_site(self, link_scoped: str, pose_link: Pose, name: str) -> str:
        """Add a site to a link; raise KeyError for an unknown link. For a static link, the world body gets the site."""
        link = self.names.link(link_scoped)
        record = self.records[link.model]
        pose = link.offset @ pose_link
        self.spec.body(link.body_name).add_site(name=name, pos=pose.position, quat=pose.quaternion, group=5)
        record.sites.append(name)
        if link.body_name == WORLD:
            record.world_sites.append(name)
        return name

    def add_script_material(self, visual: SceneVisual, name: str) -> str:
        """Add another material for a visual, which `Visual.set_material` can show.

        Args:
            visual: visual of a model, whose material has a texture.
            name: name of a material with a texture, in a script beside that of the visual.

        Returns:
            Name of the material in the engine; empty if there is no such material.
        """
        look = visual.material
        if look is None or look.texture is None:
            return ""
        folder = look.texture.parent
        places = [folder.parent / "scripts", folder]

        def allows(path: Path) -> bool:
            return self.find_file(path.name, path.parent) is not None

        material = find_material(name, places, allows)
        texture = find_texture(material, places, allows) if material is not None and material.texture else None
        if texture is None:
            return ""
        self.files_read.append(texture)
        record = self.records[visual.scoped.split("::")[0]]
        self.assets.used = record.assets
        return self._writer(record).geoms.add_material(visual, replace(look, script=name, texture=texture))

    def add_velocity_servo(
        self,
        joint_scoped: str,
        *,
        axis: int = 0,
        max_effort: float,
        owner: str,
        kv: float | None = None,
        joint_limit: bool = True,
    ) -> ActuatorRef:
        """Add a servo whose control is a velocity [rad/s or m/s].

        A joint axis has one velocity motor, as in Gazebo: two drivers of one axis share the servo of the first one. The
        last command and the larger effort limit count.

        Args:
            joint_scoped: scoped name of the joint.
            axis: index of the axis.
            max_effort: effort limit [N·m or N].
            owner: name of the driver; part of the actuator's name.
            kv: requested gain. A load then slows the joint down. None uses the highest stable gain and integral action,
                which compensates a constant load.
            joint_limit: the joint's own effort limit counts too. False for the joint motors of Gazebo Classic
                (`SetParam("fmax")`), which know only their own limit.

        Raises:
            KeyError: no such joint or axis.
        """
        if kv is None:
            refs = self.records[self.names.joint(joint_scoped).model].actuators
            shared = (r for r in refs if (r.kind, r.joint, r.axis, r.kv) == ("velocity", joint_scoped, axis, None))
            if (ref := next(shared, None)) is not None:
                self._report_shared(ref, owner)
                self.shared_servos.append(ref)
                limit = self._effort_limit(joint_scoped, axis, max_effort) if joint_limit else max_effort
                if limit > ref.max_effort:
                    refs[refs.index(ref)] = ref = replace(ref, max_effort=limit)
                    set_effort_limit(self.spec.actuator(ref.name), limit)
                return ref
        return self._add_actuator(
            "velocity", joint_scoped, axis, max_effort, owner, None, kv, has_joint_limit=joint_limit
        )

    def add_position_servo(
        self,
        joint_scoped: str,
        *,
        axis: int = 0,
        max_effort: float,
        owner: str,
        kp: float | None = None,
        kv: float | None = None,
    ) -> ActuatorRef:
        """Add a servo whose control is a position [rad or m]; raise KeyError for an unknown joint or axis.

        Gains that would be unstable are limited.
        """
        return self._add_actuator("position", joint_scoped, axis, max_effort, owner, kp, kv)

    def add_drive(
        self,
        joint_scoped: str,
        *,
        axis: int = 0,
        max_effort: float,
        max_velocity: float = float("inf"),
        owner: str,
        has_rotor: bool = True,
    ) -> ActuatorRef:
        """Add an actuator that is a motor or a servo: its state is an effort, its control the rate of that effort.

        Its force is the state plus the terms of `actuator_biasprm` (-kp, -kv), within the limit. It raises KeyError for
        an unknown joint or axis.

        Args:
            joint_scoped: scoped name of the joint.
            axis: index of the axis.
            max_effort: effort limit [N·m or N]; the joint's own effort limit counts only if the caller includes it.
            max_velocity: velocity limit [rad/s or m/s]; with the effort it gives the inertia of the drive's rotor.
            owner: name of the driver; part of the actuator's name.
            has_rotor: True if the joint may get an armature, which servos need.
        """
        ref = self._add_actuator("drive", joint_scoped, axis, max_effort, owner, None, None)
        if has_rotor:
            joint = self.names.joint(joint_scoped)
            made = self.spec.joint(joint.joint_names[axis])
            add_drive_armature(made, ref.max_effort, max_velocity, joint_scoped, self.diagnostics, joint.scene.where)
        return ref

    def add_motor(
        self, joint_scoped: str, axis: int = 0, max_effort: float = float("inf"), owner: str = "motor"
    ) -> ActuatorRef:
        """Add an actuator whose control is an effort [N·m or N]; raise KeyError for an unknown joint or axis."""
        return self._add_actuator("motor", joint_scoped, axis, max_effort, owner, None, None)

    def _report_shared(self, ref: ActuatorRef, owner: str) -> None:
        """Warn that two plugins drive the same joints; the message is the same for all joints, so it appears once."""
        model = self.records[self.names.joint(ref.joint).model].scene
        if owner != ref.owner:
            text = f"plugins {ref.owner!r} and {owner!r} drive the same joints of {model.scoped!r}"
            hint = "remove one of them; Gazebo Classic and Gazebo each load only their own"
            self.diagnostics.warning("SK-JOINT-019", f"{text}; the last command of either counts", model.where, hint)

    def _effort_limit(self, scoped: str, axis: int, max_effort: float) -> float:
        """Return the smaller one of an effort limit and the limit of the joint [N·m or N]."""
        axes = self.names.joint(scoped).scene.axes
        return min(max_effort, axes[axis].effort) if axis < len(axes) else max_effort

    def _add_actuator(
        self,
        kind: str,
        scoped: str,
        axis: int,
        max_effort: float,
        owner: str,
        kp: float | None,
        kv: float | None,
        *,
        has_joint_limit: bool = True,
    ) -> ActuatorRef:
        joint = self.names.joint(scoped)
        if not 0 <= axis < len(joint.joint_names):
            raise KeyError(f"joint {scoped!r} ({joint.type}) has no axis {axis} to drive")
        record = self.records[joint.model]
        if has_joint_limit and kind != "drive":
            max_effort = self._effort_limit(scoped, axis, max_effort)
        if max_effort == 0.0:
            message = f"{owner} drives joint {scoped}, but the joint's effort limit is 0: it never moves"
            self.diagnostics.warning(
                "SK-JOINT-011", message, joint.scene.where, "remove <effort> for a joint without a limit"
            )
        base, k = f"{owner}/{joint.joint_names[axis]}/{kind}", 1
        taken = {ref.name for r in self.records.values() for ref in r.actuators}
        name = base
        while name in taken:
            k += 1
            name = f"{base}#{k}"
        ref = ActuatorRef(name, kind, scoped, axis, max_effort, owner, kp, kv)
        if kind in ("position", "velocity"):
            add_armature(self.spec.joint(joint.joint_names[axis]), scoped, self.diagnostics, joint.scene.where)
        add_actuator(self.spec, ref, joint.joint_names[axis])
        record.actuators.append(ref)
        return ref

    def add_weld(self, name: str, parent_link: str, child_link: str, *, active: bool = True) -> str:
        """Weld two links at their poses in the file; raise KeyError for unknown links.

        `active` is the state of the weld at the start.
        """
        parent, child = self.names.link(parent_link), self.names.link(child_link)
        record = self.records[parent.model if parent.model == child.model else ""]
        links = {n: b for r in self.records.values() for n, b in r.links.items()}
        self._writer(record).weld(name, parent_link, child_link, links, active)
        if record is self.records[""]:
            joint = SceneJoint(name, name, "fixed", parent_link, child_link, child.scene.pose_world)
            record.joints[name] = JointBinding(name, "fixed", joint, "", is_loop=True, equalities=(name,))
            self._names = None
        return name

    # ------------------------------------------------------------------ compilation

    def compile(self) -> Compiled:
        """Compile the model with its first state; raise LoadError if MuJoCo refuses it."""
        with warnings.catch_warnings(record=True) as engine_warnings:
            warnings.simplefilter("always")
            model = self._compile_model()
            self._finish(model)
            names = NameMap.of(self.records.values(), model)
            data = mujoco.MjData(model)
            place_joints(model, data, names.joints.values())
            report_lights(model, self.diagnostics, self.world.where)
        for text in dict.fromkeys(str(w.message) for w in engine_warnings):
            if not mjcf_attachment.is_expected_warning(text):
                self.diagnostics.warning("SK-PHYS-025", f"the engine warns: {text}", self.world.where)
        return Compiled(model, data, names, self)

    def recompile(self, compiled: Compiled, data: mujoco.MjData) -> Compiled:
        """Compile the model after a change, into new model and data objects.

        Elements that exist before and after the change keep their state bit for bit.

        Args:
            compiled: previous result of this builder, or of the builder from which it was copied.
            data: state to copy; this object stays unchanged.

        Raises:
            LoadError: MuJoCo refuses the changed model.
        """
        model = self._compile_model()
        fresh, names = mujoco.MjData(model), NameMap.of(self.records.values(), model)
        place_joints(model, fresh, names.joints.values())
        transfer_state(compiled.model, data, model, fresh)
        model.opt.gravity[:] = compiled.model.opt.gravity
        self._finish(model)
        return Compiled(model, fresh, names, self)

    def _compile_model(self) -> mujoco.MjModel:
        """Compile the specification; links of one model do not collide if their hulls overlap at the start."""
        records = list(self.records.values())
        model = compile_spec(self.spec, self.world, records, self.diagnostics)
        if exclude_overlapping_hulls(self.spec, model, records, self.diagnostics):
            model = compile_spec(self.spec, self.world, records, self.diagnostics)
        return model

    def _finish(self, model: mujoco.MjModel) -> None:
        finish_model(self.spec, model, self.world, list(self.records.values()), self.diagnostics)

    def copy(self) -> SpecBuilder:
        """Return an independent builder with the same content."""
        other = SpecBuilder.__new__(SpecBuilder)
        other.world, other.diagnostics = self.world, self.diagnostics
        other.find_file, other.files_read, other.parameter_files = self.find_file, self.files_read, self.parameter_files
        spec = self.spec.copy()
        other._world_geoms, other.assets = self._world_geoms.copy_to(spec), Assets(spec, self.assets.known)
        other.records = {name: record.copy() for name, record in self.records.items()}
        other.shared_servos = list(self.shared_servos)
        other._names, other._cut, other._world_joints = None, list(self._cut), self._world_joints
        return other
