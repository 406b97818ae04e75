"""Controllers of joints, and what is commanded to them."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import INERTIAL, model, python

_ROTOR = f"""
<link name="rotor">{INERTIAL}</link>
<joint name="spin" type="revolute"><parent>world</parent><child>rotor</child><axis><xyz>0 0 1</xyz></axis></joint>
"""


def _rotor(system: str, name: str, content: str) -> str:
    plugin = f'<plugin filename="gz-sim-{system}-system" name="gz::sim::systems::{name}">\n  {content}\n</plugin>'
    return f"{_ROTOR.strip()}\n{plugin}"


def _run(system: str, name: str, content: str, script: str) -> Example:
    """A script on a rotor with a plugin."""
    return python(
        f'import simkit\n\nsim = simkit.load("rotor.sdf")\n{script}', {"rotor.sdf": _world(system, name, content)}
    )


def _world(system: str, name: str, content: str) -> str:
    return model(_rotor(system, name, content)).text


_POSITION = ("joint-position-controller", "JointPositionController")
_VELOCITY = ("joint-controller", "JointController")
_TRAJECTORY = ("joint-trajectory-controller", "JointTrajectoryController")
_SPIN = "<joint_name>spin</joint_name>"

CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-040",
        "warning",
        "the PID of a joint is not stable: its error swings ever wider, or from one bound of the effort to the other",
        "smaller gains, a smaller `max_step_size`, or damping in the joint",
        _run(
            *_POSITION,
            f"{_SPIN}<p_gain>1e6</p_gain><initial_position>1</initial_position>",
            "sim.run(1.0)",
        ),
    ),
    Code(
        "SK-PLUGIN-041",
        "warning",
        "a command that a plugin cannot use is left out: a number that is not finite, too few numbers, a joint that is "
        "not there, times that go back; said once for each",
        "",
        _run(
            *_TRAJECTORY,
            f"{_SPIN}<position_p_gain>1</position_p_gain>",
            'points = [{"positions": [1.0]}]\n'
            'sim.publish("/model/robot/joint_trajectory", {"joint_names": ["spinn"], "points": points})\n'
            "sim.step()",
        ),
    ),
    Code(
        "SK-PLUGIN-042",
        "warning",
        "`<use_actuator_msg>` without `<actuator_number>`: commands are taken as single numbers, as in Gazebo",
        "give the number of the actuator, from 0 on",
        model(_rotor(*_VELOCITY, f"{_SPIN}<use_actuator_msg>true</use_actuator_msg>")),
    ),
    Code(
        "SK-PLUGIN-043",
        "warning",
        "numbers of a PID that has no part in how the joint is moved",
        "`<use_force_commands>` for a JointController, no `<use_velocity_commands>` for a JointPositionController",
        model(_rotor(*_VELOCITY, f"{_SPIN}<p_gain>3</p_gain>")),
    ),
    Code(
        "SK-PLUGIN-044",
        "warning",
        "more elements than joints that they are for, or a joint twice; those too many have no effect",
        "",
        model(_rotor(*_TRAJECTORY, f"{_SPIN}<position_p_gain>3</position_p_gain><position_p_gain>3</position_p_gain>")),
    ),
    Code(
        "SK-PLUGIN-045",
        "warning",
        "accelerations of a trajectory, which gz does not use either",
        "`<simkit:interpolation>quintic</simkit:interpolation>`",
        _run(
            *_TRAJECTORY,
            f"{_SPIN}<position_p_gain>1</position_p_gain>",
            'points = [{"positions": [1.0], "accelerations": [0.5]}]\n'
            'sim.publish("/model/robot/joint_trajectory", {"joint_names": ["spin"], "points": points})\n'
            "sim.step()",
        ),
    ),
    Code(
        "SK-PLUGIN-046",
        "note",
        "`libgazebo_ros_joint_pose_trajectory.so` of ROS 1, which stops the physics while a trajectory plays; here it "
        "goes on",
        "",
        model(
            f"{_ROTOR.strip()}\n"
            '<plugin name="poses" filename="libgazebo_ros_joint_pose_trajectory.so">'
            "<topicName>poses</topicName></plugin>"
        ),
    ),
)
