"""Tasks of TIAGo: reach a point with the hand, and pick up a cube from a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import RunSpec
from simkit.linear_algebra import norm
from simkit_learning.environments.specification import Environment, EnvironmentSpec, JointVelocities, Observation

if TYPE_CHECKING:
    from simkit import Pose
    from simkit.extend import Vector

ROBOT: Final = "tiago"
HAND: Final = "tiago::gripper_grasping_frame"
ARM: Final = tuple(f"arm_{number}_joint" for number in range(1, 8))
FINGERS: Final = ("gripper_left_finger_joint", "gripper_right_finger_joint")
REACHED: Final = 0.05  # [m] between the hand and the goal
LIFTED: Final = 0.10  # [m] above the start of the cube
_LOST: Final = 0.10  # [m] below the start of the cube
_READY: Final = (1.6, 0.2, -0.5, 1.4, 0.0, 0.3, 0.0)
_ABOVE_TABLE: Final = (2.19, 0.576, 1.534, 1.478, -0.492, 1.414, 1.709)
_TORSO_HEIGHT: Final = 0.25  # [m] with this height and `_ABOVE_TABLE`, the hand points down, 0.15 m above the cube


def reach_spec() -> EnvironmentSpec:
    """Return the environment `simkit/TiagoReach-v0`."""
    run = RunSpec("empty", spawn=("tiago:0,0,0",), name="tiago_reach")
    return EnvironmentSpec(
        run,
        {
            "joints": Observation(_arm_positions, low=-4.0, high=4.0),
            "to_goal": Observation(lambda env: env.memory["goal"] - _hand(env).position, low=-3.0, high=3.0),
        },
        {"/arm_controller/joint_trajectory": JointVelocities(ARM, 1.0)},
        reward=_reach_reward,
        terminated=lambda env: env.memory["reached"],
        success=lambda env: env.memory["reached"],
        on_reset=_place_goal,
        control_period=0.1,
        time_limit=10.0,
        scaled_actions=True,
        samples_all=False,
    )


def pick_spec() -> EnvironmentSpec:
    """Return the environment `simkit/TiagoPick-v0`."""
    return EnvironmentSpec(
        RunSpec("tiago_table", name="tiago_pick"),
        {
            "joints": Observation(_arm_positions, low=-4.0, high=4.0),
            "fingers": Observation(_finger_positions, low=-0.05, high=0.1),
            "to_cube": Observation(lambda env: _cube(env) - _hand(env).position, low=-3.0, high=3.0),
            "hand": Observation(lambda env: _hand(env).matrix[:, 0], low=-1.0, high=1.0),
            "height": Observation(lambda env: _cube(env)[2] - env.memory["cube"][2], low=-1.0, high=1.0),
        },
        {
            "/arm_controller/joint_trajectory": JointVelocities(ARM, 0.5),
            "/gripper_controller/joint_trajectory": JointVelocities(FINGERS),
        },
        reward=_pick_reward,
        terminated=lambda env: env.memory["reached"] or env.memory["lost"],
        success=lambda env: env.memory["reached"],
        on_reset=_place_cube,
        control_period=0.1,
        time_limit=20.0,
        scaled_actions=True,
        samples_all=False,
    )


def _hand(env: Environment) -> Pose:
    pose: Pose = env.sim.link(HAND).pose
    return pose


def _positions(env: Environment, names: tuple[str, ...]) -> Vector:
    return np.array([float(env.sim.joint(f"{ROBOT}::{name}").position) for name in names])


def _arm_positions(env: Environment) -> Vector:
    return _positions(env, ARM)


def _finger_positions(env: Environment) -> Vector:
    return _positions(env, FINGERS)


def _set_arm(env: Environment, positions: npt.ArrayLike) -> None:
    env.sim.model(ROBOT).set_joint_positions(dict(zip(ARM, np.asarray(positions).tolist(), strict=True)))


def _command(env: Environment, controller: str, names: tuple[str, ...], positions: npt.ArrayLike) -> None:
    """Make a controller hold positions that its joints have already."""
    point = {"positions": np.asarray(positions).tolist(), "time_from_start": {"nanosec": 10_000_000}}
    env.sim.publish(f"/{controller}/joint_trajectory", {"joint_names": list(names), "points": [point]})


# ---------------------------------------------------------------------- reach


def _place_goal(env: Environment) -> None:
    """Draw a goal that the hand reaches in a random posture, and move the arm to its start."""
    spread = np.array((0.6, 0.4, 0.6, 0.5, 0.5, 0.5, 0.5))
    _set_arm(env, _READY + env.np_random.uniform(-spread, spread))
    goal = _hand(env).position.copy()
    _set_arm(env, _READY)
    _command(env, "arm_controller", ARM, _READY)
    env.memory |= {"goal": goal, "distance": _distance_to(env, goal), "reached": False}


def _distance_to(env: Environment, goal: Vector) -> float:
    return norm(goal - _hand(env).position)


def _reach_reward(env: Environment) -> float:
    """Return 10 for each metre of approach, −0.01 for each step, and 10 at the goal."""
    memory = env.memory
    before, memory["distance"] = memory["distance"], _distance_to(env, memory["goal"])
    memory["reached"] = memory["distance"] < REACHED
    return float(10.0 * (before - memory["distance"]) - 0.01 + 10.0 * memory["reached"])


# ---------------------------------------------------------------------- pick


def _cube(env: Environment) -> Vector:
    position: Vector = env.sim.model("cube").pose.position
    return position


def _place_cube(env: Environment) -> None:
    """Move the cube a little, and the open hand above its usual place."""
    robot, cube = env.sim.model(ROBOT), env.sim.model("cube")
    robot.set_joint_positions({"torso_lift_joint": _TORSO_HEIGHT, FINGERS[0]: 0.04, FINGERS[1]: 0.04})
    _set_arm(env, _ABOVE_TABLE)
    _command(env, "torso_controller", ("torso_lift_joint",), (_TORSO_HEIGHT,))
    _command(env, "arm_controller", ARM, _ABOVE_TABLE)
    _command(env, "gripper_controller", FINGERS, (0.04, 0.04))
    x, y = env.np_random.uniform(-0.04, 0.04, 2).tolist()
    cube.set_pose(type(cube.pose)((0.70 + x, y, float(cube.pose.position[2]))))
    place = _cube(env).copy()
    env.memory |= {"cube": place, "distance": _distance_to(env, place), "height": 0.0, "reached": False, "lost": False}


def _pick_reward(env: Environment) -> float:
    """Return 5 for each metre of approach, 50 for each metre of height, −0.01 for each step, and ±10 at the end."""
    memory, place = env.memory, _cube(env)
    distance, height = _distance_to(env, place), float(place[2] - memory["cube"][2])
    reward = 5.0 * (memory["distance"] - distance) + 50.0 * (height - memory["height"]) - 0.01
    memory["distance"], memory["height"] = distance, height
    memory["reached"], memory["lost"] = height > LIFTED, height < -_LOST
    return float(reward + 10.0 * memory["reached"] - 10.0 * memory["lost"])
