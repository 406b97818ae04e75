"""Options of the MPPI controller and of its critics, with the defaults of `nav2_mppi_controller` (Jazzy)."""

from __future__ import annotations

from typing import Final

from simkit.extend import Options, block, boolean, choice, integer, number, text, texts, without_effect

MOTION_MODELS: Final = ("DiffDrive", "Omni", "Ackermann")
_LEAST: Final = 1e-6


class AckermannOptions(Options):
    """Options of the motion model `Ackermann`."""

    min_turning_r: float = number(0.2, "m", minimum=_LEAST)


class TrajectoryVisualizerOptions(Options):
    """Options of the markers on `/trajectories`."""

    trajectory_step: int = integer(5, minimum=1)
    time_step: int = integer(3, minimum=1)


class MppiOptions(Options):
    """Options of `MppiController`."""

    motion_model: str = choice(MOTION_MODELS, "DiffDrive")
    time_steps: int = integer(56, minimum=2, maximum=1000)
    model_dt: float = number(0.05, "s", minimum=1e-3)
    batch_size: int = integer(1000, minimum=1, maximum=100_000)
    iteration_count: int = integer(1, minimum=1, maximum=100)
    temperature: float = number(0.3, minimum=_LEAST)
    gamma: float = number(0.015, minimum=0)
    vx_max: float = number(0.5, "m/s", minimum=0)
    vx_min: float = number(-0.35, "m/s")
    vy_max: float = number(0.5, "m/s", minimum=0)
    wz_max: float = number(1.9, "rad/s", minimum=0)
    ax_max: float = number(3.0, "m/s^2")
    ax_min: float = number(-3.0, "m/s^2")
    ay_max: float = number(3.0, "m/s^2")
    ay_min: float = number(-3.0, "m/s^2")
    az_max: float = number(3.5, "rad/s^2")
    vx_std: float = number(0.2, "m/s", minimum=_LEAST)
    vy_std: float = number(0.2, "m/s", minimum=_LEAST)
    wz_std: float = number(0.4, "rad/s", minimum=_LEAST)
    retry_attempt_limit: int = integer(1, minimum=0, maximum=100)
    reset_period: float = number(1.0, "s", minimum=0)
    open_loop: bool = boolean(False)
    regenerate_noises: bool = boolean(False)
    prune_distance: float = number(1.5, "m", minimum=0)
    max_robot_pose_search_dist: float = number(-1.0, "m", description="negative for half of the costmap's side")
    enforce_path_inversion: bool = boolean(False)
    inversion_xy_tolerance: float = number(0.2, "m", minimum=0)
    inversion_yaw_tolerance: float = number(0.4, "rad", minimum=0)
    visualize: bool = boolean(False)
    TrajectoryVisualizer: TrajectoryVisualizerOptions = block(TrajectoryVisualizerOptions)
    AckermannConstraints: AckermannOptions = block(AckermannOptions)
    critics: tuple[str, ...] = texts()
    transform_tolerance: bool = without_effect()


class CriticOptions(Options):
    """Options of every critic."""

    enabled: bool = boolean(True)
    cost_power: int = integer(1, minimum=0, maximum=10)


class ConstraintOptions(CriticOptions):
    """Options of `ConstraintCritic`."""

    cost_weight: float = number(4.0)


class CostOptions(CriticOptions):
    """Options of `CostCritic`."""

    cost_weight: float = number(3.81)
    critical_cost: float = number(300.0)
    near_collision_cost: int = integer(253)
    collision_cost: float = number(1e6)
    near_goal_distance: float = number(0.5, "m")
    consider_footprint: bool = boolean(False)
    trajectory_point_step: int = integer(2, minimum=1)
    inflation_layer_name: bool = without_effect()


class ObstaclesOptions(CriticOptions):
    """Options of `ObstaclesCritic`."""

    repulsion_weight: float = number(1.5)
    critical_weight: float = number(20.0)
    collision_cost: float = number(1e5)
    collision_margin_distance: float = number(0.1, "m")
    near_goal_distance: float = number(0.5, "m")
    consider_footprint: bool = boolean(False)
    inflation_layer_name: bool = without_effect()
    cost_scaling_factor: float = number(0.0, description="0 for the one of the inflation layer")
    inflation_radius: float = number(0.0, "m", description="0 for the one of the inflation layer")


class GoalOptions(CriticOptions):
    """Options of `GoalCritic`."""

    cost_weight: float = number(5.0)
    threshold_to_consider: float = number(1.4, "m")


class GoalAngleOptions(CriticOptions):
    """Options of `GoalAngleCritic`."""

    cost_weight: float = number(3.0)
    threshold_to_consider: float = number(0.5, "m")
    symmetric_yaw_tolerance: bool = boolean(False)


class PathAlignOptions(CriticOptions):
    """Options of `PathAlignCritic`."""

    cost_weight: float = number(10.0)
    max_path_occupancy_ratio: float = number(0.07)
    offset_from_furthest: int = integer(20, minimum=0)
    trajectory_point_step: int = integer(4, minimum=1)
    threshold_to_consider: float = number(0.5, "m")
    use_path_orientations: bool = boolean(False)


class PathAngleOptions(CriticOptions):
    """Options of `PathAngleCritic`; the modes 0, 1 and 2 are those of Nav2."""

    cost_weight: float = number(2.2)
    offset_from_furthest: int = integer(4, minimum=0)
    threshold_to_consider: float = number(0.5, "m")
    max_angle_to_furthest: float = number(0.785398, "rad")
    mode: int = integer(0, minimum=0, maximum=2)
    forward_preference: bool = boolean(True)


class PathFollowOptions(CriticOptions):
    """Options of `PathFollowCritic`."""

    cost_weight: float = number(5.0)
    offset_from_furthest: int = integer(6, minimum=0)
    threshold_to_consider: float = number(1.4, "m")


class PreferForwardOptions(CriticOptions):
    """Options of `PreferForwardCritic`."""

    cost_weight: float = number(5.0)
    threshold_to_consider: float = number(0.5, "m")


class TwirlingOptions(CriticOptions):
    """Options of `TwirlingCritic`; the names with `twirling_` are those of the comments in Nav2's files."""

    cost_weight: float = number(10.0)
    cost_power: int = integer(1, minimum=0, maximum=10)
    twirling_cost_weight: bool = without_effect()
    twirling_cost_power: bool = without_effect()


class VelocityDeadbandOptions(CriticOptions):
    """Options of `VelocityDeadbandCritic`."""

    cost_weight: float = number(35.0)
    deadband_velocities: str = text("0 0 0")
