"""Topics of the robot Baxter, and the parameters of its controllers as in a parameter file of baxter_simulator."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from simkit.extend import Where, acts, listens, offers, publishes
from simkit.plugins.endpoints import Endpoint
from simkit.plugins.ros_parameter_files import Entry
from simkit_robots.controllers.baxter_controllers import limb_joints
from simkit_robots.plugins.baxter.inverse_kinematics import IK_SERVICE, IK_TYPE

SIDES: Final = ("left", "right")
HOLD, POSITION_MODE, VELOCITY_MODE, TORQUE_MODE, RAW_POSITION_MODE = range(5)
LIMB_CONTROLLERS: Final = {
    HOLD: "trajectory_controller",
    POSITION_MODE: "joint_position_controller",
    RAW_POSITION_MODE: "joint_position_controller",
    VELOCITY_MODE: "joint_velocity_controller",
    TORQUE_MODE: "joint_effort_controller",
}
"""Controller of an arm in each mode, after the arm's side; `HOLD` is the mode without joint commands."""
_TYPES: Final = {
    "trajectory_controller": "baxter_interface/JointTrajectoryActionServer",
    "joint_position_controller": "baxter_sim_controllers/BaxterPositionController",
    "joint_velocity_controller": "baxter_sim_controllers/BaxterVelocityController",
    "joint_effort_controller": "baxter_sim_controllers/BaxterEffortController",
    "gripper_controller": "baxter_sim_controllers/BaxterGripperController",
    "head_position_controller": "baxter_sim_controllers/BaxterHeadController",
    "joint_state_controller": "joint_state_controller/JointStateController",
}
_PATH_TOLERANCE, _STOPPED_VELOCITY = "0.2", "0.25"  # [rad], [rad/s]: defaults of baxter_interface's action server

BOOL, EMPTY, FLOAT = "std_msgs/msg/Bool", "std_msgs/msg/Empty", "std_msgs/msg/Float64"
_CORE: Final = "baxter_core_msgs/msg/"
JOINT_COMMAND, HEAD_PAN, GRIPPER = f"{_CORE}JointCommand", f"{_CORE}HeadPanCommand", f"{_CORE}EndEffectorCommand"


def baxter_endpoints() -> Iterator[Endpoint]:
    """Yield the topics and actions below `/robot`."""
    for side in SIDES:
        limb, gripper = f"/robot/limb/{side}", f"/robot/end_effector/{side}_gripper"
        yield listens(f"{limb}/joint_command", JOINT_COMMAND)
        yield listens(f"{limb}/joint_command_timeout", FLOAT)
        yield listens(f"{limb}/set_speed_ratio", FLOAT)
        yield listens(f"{limb}/suppress_gravity_compensation", EMPTY)
        yield listens(f"{limb}/joint_trajectory", "trajectory_msgs/msg/JointTrajectory")
        yield acts(f"{limb}/follow_joint_trajectory", "control_msgs/action/FollowJointTrajectory")
        yield offers(f"/{IK_SERVICE.format(side)}", IK_TYPE)
        yield publishes(f"{limb}/endpoint_state", f"{_CORE}EndpointState")
        yield publishes(f"{limb}/gravity_compensation_torques", f"{_CORE}SEAJointState")
        yield listens(f"{gripper}/command", GRIPPER)
        yield publishes(f"{gripper}/state", f"{_CORE}EndEffectorState")
        yield publishes(f"{gripper}/properties", f"{_CORE}EndEffectorProperties")
    yield listens("/robot/head/command_head_pan", HEAD_PAN)
    yield listens("/robot/head/command_head_nod", BOOL)
    yield publishes("/robot/head/head_state", f"{_CORE}HeadState")
    yield publishes("/robot/joint_states", "sensor_msgs/msg/JointState")
    yield publishes("/robot/state", f"{_CORE}AssemblyState")
    yield listens("/robot/set_super_enable", BOOL)
    yield listens("/robot/set_super_stop", EMPTY)
    yield listens("/robot/set_super_reset", EMPTY)


def kind_of(name: str) -> str:
    """Return the name of a controller without the side of the robot."""
    side, _, rest = name.partition("_")
    return rest if side in SIDES else name


def declaration(name: str, where: Where) -> Entry:
    """Return the parameters of a controller as in a parameter file."""
    kind = kind_of(name)

    def text(value: str) -> Entry:
        return Entry(where, value, is_text=True)

    below = {"type": text(_TYPES[kind])}
    if kind == "trajectory_controller":
        joints = limb_joints(name.partition("_")[0])
        limits = {joint: Entry(where, below={"trajectory": text(_PATH_TOLERANCE)}) for joint in joints}
        stopped = {"stopped_velocity_tolerance": text(_STOPPED_VELOCITY)}
        below["joints"] = Entry(where, items=[text(joint) for joint in joints])
        below["constraints"] = Entry(where, below={**limits, **stopped})
    return Entry(where, below=below)
