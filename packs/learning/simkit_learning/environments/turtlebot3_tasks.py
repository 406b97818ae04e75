"""Tasks of a TurtleBot3: reach a goal among pillars, and reach a goal in a maze.

An observation has 36 scan sectors, the goal in polar coordinates of the robot, and the robot's velocity.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Pose, RunSpec
from simkit.elementary_functions import arctan2
from simkit_learning.environments.specification import Batched, Environment, EnvironmentSpec, Observation

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from simkit_learning.environments.array_view import ArrayView, Bools, Floats

    Point = tuple[float, float]

ROBOT: Final = "turtlebot3"
FAST_CONTACTS: Final = ("physics.contact_law=mujoco",)
"""Override for MuJoCo's own contacts, which all environments of a batch can compute in one call."""

GOAL_RADIUS: Final = 0.25  # [m]
_TOUCHES: Final = f"contact('{ROBOT}')"
SECTORS: Final = 36
FARTHEST: Final = 6.0  # [m]; upper limit of the observed distance
_PILLARS: Final = [(x, y) for x in (-1.1, 0.0, 1.1) for y in (-1.1, 0.0, 1.1)]
_PILLAR_CLEARANCE: Final = 0.42  # [m] from a pillar's axis to the robot's origin
_ARENA: Final = 2.05  # [m] from the centre to the free side of the walls
_NEAREST_GOAL: Final = 1.0  # [m] from the start to the goal

CELL: Final = 1.0  # [m]
_MAZE: Final = (
    "+--+--+--+--+",
    "|     |     |",
    "+  +--+  +  +",
    "|  |     |  |",
    "+  +  +--+  +",
    "|     |     |",
    "+--+  +  +--+",
    "|        |  |",
    "+--+--+--+--+",
)
"""Maze of 4 × 4 cells; `--` and `|` are walls."""


def goal_spec() -> EnvironmentSpec:
    """Return the environment `simkit/TurtleBot3Goal-v0`."""
    return _spec(RunSpec("turtlebot3_world", overrides=FAST_CONTACTS), _place_among_pillars, 40.0)


def maze_spec() -> EnvironmentSpec:
    """Return the environment `simkit/TurtleBot3Maze-v0`."""
    return _spec(RunSpec(maze_world(), name="turtlebot3_maze", overrides=FAST_CONTACTS), _place_in_maze, 90.0)


def _spec(run: RunSpec, on_reset: Callable[[Environment], None], time_limit: float) -> EnvironmentSpec:
    farthest = FARTHEST
    observation = {
        "scan": Observation("/scan", sectors=SECTORS),
        "goal": Observation(Batched(observe_goal, _observe_goals), low=(0.0, -1.0, -1.0), high=(farthest, 1.0, 1.0)),
        "velocity": Observation(Batched(_observe_velocity, _observe_velocities), low=(-1.0, -4.0), high=(1.0, 4.0)),
    }
    return EnvironmentSpec(
        run,
        observation,
        {"/cmd_vel": {"linear.x": (0.0, 0.26), "angular.z": (-1.5, 1.5)}},
        reward=Batched(_reward, _rewards),
        terminated=Batched(_has_ended, _have_ended),
        success=Batched(_has_reached, _have_reached),
        on_reset=on_reset,
        control_period=0.1,
        time_limit=time_limit,
        scaled_actions=True,
        samples_all=False,
    )


# ---------------------------------------------------------------------- observations and reward


def goal_in_robot_frame(pose: Pose, goal: Sequence[float]) -> tuple[float, float, float]:
    """Return the distance [m] of a goal, and cosine and sine of its bearing in the robot's frame."""
    x, y = goal[0] - pose.position[0], goal[1] - pose.position[1]
    bearing = math.atan2(y, x) - float(pose.rpy[2])
    return min(math.hypot(x, y), FARTHEST), math.cos(bearing), math.sin(bearing)


def observe_goal(env: Environment) -> tuple[float, float, float]:
    """Return the goal in polar coordinates of the robot."""
    return goal_in_robot_frame(env.sim.model(ROBOT).pose, env.memory["goal"])


def _observe_velocity(env: Environment) -> tuple[float, float]:
    """Return the robot's forward speed [m/s] and yaw rate [rad/s]."""
    link = env.sim.link(f"{ROBOT}::base_footprint")
    yaw = float(link.pose.rpy[2])
    velocity = link.linear_velocity
    return float(velocity[0] * math.cos(yaw) + velocity[1] * math.sin(yaw)), float(link.angular_velocity[2])


def _reward(env: Environment) -> float:
    """Return 4 for each metre of approach, −0.01 for each step, 10 at the goal and −10 for a collision."""
    memory = env.memory
    x, y = (env.sim.model(ROBOT).pose.position[:2] - memory["goal"]).tolist()
    distance = math.hypot(x, y)
    approach = memory["distance"] - distance
    memory["distance"] = distance
    memory["reached"] = distance < GOAL_RADIUS
    memory["collided"] = bool(env.expression(_TOUCHES)())
    return float(4.0 * approach - 0.01 + 10.0 * memory["reached"] - 10.0 * memory["collided"])


def _has_reached(env: Environment) -> bool:
    return bool(env.memory["reached"])


def _has_ended(env: Environment) -> bool:
    return bool(env.memory["reached"] or env.memory["collided"])


# ---------------------------------------------------------------------- the same for all environments of a batch


def _observe_goals(view: ArrayView) -> Floats:
    x, y = (view.memory["goal"] - view.position(ROBOT)[:, :2]).T
    bearing = arctan2(y, x) - view.yaw(ROBOT)
    return np.stack((np.minimum(np.hypot(x, y), FARTHEST), np.cos(bearing), np.sin(bearing)), axis=1)


def _observe_velocities(view: ArrayView) -> Floats:
    link = f"{ROBOT}::base_footprint"
    yaw, velocity = view.yaw(link), view.linear_velocity(link)
    forward = velocity[:, 0] * np.cos(yaw) + velocity[:, 1] * np.sin(yaw)
    return np.stack((forward, view.angular_velocity(link)[:, 2]), axis=1)


def _rewards(view: ArrayView) -> Floats:
    memory = view.memory
    distance = np.hypot(*(view.position(ROBOT)[:, :2] - memory["goal"]).T)
    approach, memory["distance"] = memory["distance"] - distance, distance
    memory["reached"], memory["collided"] = distance < GOAL_RADIUS, view.contact(ROBOT)
    reward: Floats = 4.0 * approach - 0.01 + 10.0 * memory["reached"] - 10.0 * memory["collided"]
    return reward


def _have_reached(view: ArrayView) -> Bools:
    return np.asarray(view.memory["reached"])


def _have_ended(view: ArrayView) -> Bools:
    ended: Bools = view.memory["reached"] | view.memory["collided"]
    return ended


# ---------------------------------------------------------------------- starts and goals


def _begin(env: Environment, start: Point, goal: Point) -> None:
    """Place the robot with a random yaw, and set the goal."""
    robot = env.sim.model(ROBOT)
    yaw = float(env.np_random.uniform(-math.pi, math.pi))
    robot.set_pose(Pose.from_rpy(*start, float(robot.pose.position[2]), 0.0, 0.0, yaw))
    distance = math.dist(start, goal)
    env.memory |= {
        "goal": np.array(goal),
        "distance": distance,
        "reached": False,
        "collided": False,
    }


def _place_among_pillars(env: Environment) -> None:
    """Draw a start and a goal that are free of pillars and walls."""
    start = _free_point(env)
    goal = _free_point(env)
    while math.dist(start, goal) < _NEAREST_GOAL:
        goal = _free_point(env)
    _begin(env, start, goal)


def _free_point(env: Environment) -> Point:
    while True:
        x, y = env.np_random.uniform(-2.3, 2.3, 2).tolist()
        # the walls are the sides of a hexagon, whose normals are 60° apart
        to_wall = max(abs(x * math.cos(a) + y * math.sin(a)) for a in (math.pi / 6, math.pi / 2, 5 * math.pi / 6))
        if to_wall < _ARENA and all(math.dist((x, y), pillar) > _PILLAR_CLEARANCE for pillar in _PILLARS):
            return x, y


def _place_in_maze(env: Environment) -> None:
    """Draw two different cells of the maze."""
    start, goal = env.np_random.choice(16, 2, replace=False).tolist()
    _begin(env, _cell_centre(start), _cell_centre(goal))


def _cell_centre(cell: int) -> Point:
    row, column = divmod(cell, 4)
    return (column - 1.5) * CELL, (1.5 - row) * CELL


def maze_world() -> str:
    """Return the world of the maze as SDF text."""
    walls: list[str] = []
    for line, text in enumerate(_MAZE):
        y = (4 - line) / 2 * CELL
        if line % 2 == 0:
            columns = [column for column in range(4) if text[3 * column + 1] == "-"]
            walls += [
                _wall(len(walls) + n, (column - 1.5) * CELL, y, CELL + 0.1, 0.1) for n, column in enumerate(columns)
            ]
        else:
            columns = [column for column in range(5) if text[3 * column] == "|"]
            walls += [
                _wall(len(walls) + n, (column - 2) * CELL, y, 0.1, CELL + 0.1) for n, column in enumerate(columns)
            ]
    ground = _shape("plane", "<plane><normal>0 0 1</normal><size>20 20</size></plane>")
    return f"""<sdf version="1.9"><world name="turtlebot3_maze">
      <physics type="ignored"><max_step_size>0.001</max_step_size></physics>
      <light name="sun" type="directional"><direction>0.3 0.4 -0.8</direction><cast_shadows>true</cast_shadows></light>
      <model name="ground_plane"><static>true</static><link name="link">{ground}</link></model>
      <model name="maze"><static>true</static><link name="walls">{"".join(walls)}</link></model>
      <include><name>{ROBOT}</name><uri>model://turtlebot3</uri></include></world></sdf>"""


def _wall(number: int, x: float, y: float, width: float, depth: float) -> str:
    box = f"<box><size>{width} {depth} 0.4</size></box>"
    return _shape(f"wall_{number}", box, f"<pose>{x} {y} 0.2 0 0 0</pose>")


def _shape(name: str, geometry: str, pose: str = "") -> str:
    inside = f"{pose}<geometry>{geometry}</geometry>"
    return f'<collision name="{name}">{inside}</collision><visual name="{name}">{inside}</visual>'
