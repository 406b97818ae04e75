"""Joints that follow other joints: `libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so` and its other names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.compiler.couplings import Couplings
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.joints.joint_axis import suggest_names
from simkit.plugins.options import Options, OptionsOf, number, text, without_effect

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneJoint, SceneModel


class MimicJointOptions(Options):
    """Options of `MimicJoint`."""

    joint: str = text(None, required=True)
    mimic_joint: str = text(None, element="mimicJoint", required=True)
    multiplier: float = number(1.0, minimum=-1e6, maximum=1e6)
    offset: float = number(0.0, "rad or m", minimum=-1e6, maximum=1e6)
    has_pid: bool = without_effect(element="hasPID")
    sensitiveness: bool = without_effect()
    max_effort: bool = without_effect(element="maxEffort")
    robot_namespace: bool = without_effect(element="robotNamespace")
    namespace: bool = without_effect()


class MimicJoint(ModelPlugin):
    """Makes `<mimicJoint>` follow `<joint>`: position = `<multiplier>` (1) · position of `<joint>` + `<offset>` (0).

    A stiff constraint of the engine couples the joints, as for a `<mimic>` in a URDF. `<hasPID>`, `<maxEffort>` and
    `<sensitiveness>` describe the servo of the original and have no effect. If the URDF has a `<mimic>` for the joint,
    the `<mimic>` counts; of several plugins for one joint, the first counts.
    """

    options = OptionsOf(MimicJointOptions)
    filenames = (
        "libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so",
        "libroboticsgroup_gazebo_mimic_joint_plugin.so",
        "libgazebo_mimic_joint_plugin.so",
        "libmimic_joint_plugin.so",
    )
    lets_sleep = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        named, mimicking = params.child("joint"), params.child("mimicJoint")
        if named is None or mimicking is None:
            return
        leader, follower = _find(scene, named), _find(scene, mimicking)
        if leader is None or follower is None or follower.axes[0].mimic is not None:
            return
        if leader.scoped == follower.scoped:
            mimicking.error("SK-PARAM-002", f"found joint {options.joint!r} twice; expected two different joints")
            return
        binding = builder.names.joint(follower.scoped)
        record, step = builder.records[binding.model], builder.world.physics.max_step_size
        couplings = Couplings(builder.spec, record, step, builder.diagnostics)
        if not couplings.tie(follower.scoped, leader.scoped, options.multiplier, options.offset):
            message = f"joint {options.mimic_joint!r} follows another joint already, so this plugin has no effect"
            mimicking.warning("SK-PLUGIN-003", message)

    def load(self, parent: Model, params: Params) -> None:
        """Do nothing: the engine keeps the joints together."""


def _find(scene: SceneModel, named: Params) -> SceneJoint | None:
    """Return the joint with one axis that an element names; None after a warning, because Gazebo goes on, too."""
    joints = {joint.name: joint for joint in reversed(scene.all_joints())}
    joint = joints.get(named.value)
    if joint is None:
        message = f"model {scene.scoped!r} has no joint {named.value!r}, so no joint mimics another one"
        named.warning("SK-PLUGIN-003", message, suggest_names(named.value, list(joints)))
    elif len(joint.axes) != 1:
        message = f"joint {named.value!r} is {joint.type}, so no joint mimics another one"
        named.warning("SK-PLUGIN-003", message, "a joint with one axis can follow another one")
        return None
    return joint
