"""Options of the DWB controller and of its critics, with the defaults of `nav2_dwb_controller` (Jazzy)."""

from __future__ import annotations

from typing import Final

from simkit.extend import Options, boolean, choice, integer, number, text, texts, without_effect

_STANDARD: Final = ("dwb_plugins::StandardTrajectoryGenerator", "dwb_plugins/StandardTrajectoryGenerator")
LIMITED: Final = ("dwb_plugins::LimitedAccelGenerator", "dwb_plugins/LimitedAccelGenerator")
_LEAST: Final = 1e-3


class DwbOptions(Options):
    """Options of `DwbController`."""

    min_vel_x: float = number(0.0, "m/s")
    min_vel_y: float = number(0.0, "m/s")
    max_vel_x: float = number(0.0, "m/s")
    max_vel_y: float = number(0.0, "m/s")
    max_vel_theta: float = number(0.0, "rad/s", minimum=0)
    min_speed_xy: float = number(0.0, "m/s")
    max_speed_xy: float = number(0.0, "m/s")
    min_speed_theta: float = number(0.0, "rad/s")
    acc_lim_x: float = number(0.0, "m/s^2")
    acc_lim_y: float = number(0.0, "m/s^2")
    acc_lim_theta: float = number(0.0, "rad/s^2")
    decel_lim_x: float = number(0.0, "m/s^2")
    decel_lim_y: float = number(0.0, "m/s^2")
    decel_lim_theta: float = number(0.0, "rad/s^2")
    vx_samples: int = integer(20, minimum=0, maximum=1000)
    vy_samples: int = integer(5, minimum=0, maximum=1000)
    vtheta_samples: int = integer(20, minimum=0, maximum=1000)
    trajectory_generator_name: str = choice((*_STANDARD, *LIMITED), _STANDARD[0])
    sim_time: float = number(1.7, "s", minimum=_LEAST)
    sim_period: float = number(0.0, "s", minimum=0, description="0 for the control period")
    discretize_by_time: bool = boolean(False)
    time_granularity: float = number(0.5, "s", minimum=_LEAST)
    linear_granularity: float = number(0.5, "m", minimum=_LEAST)
    angular_granularity: float = number(0.025, "rad", minimum=_LEAST)
    limit_vel_cmd_in_traj: bool = boolean(False)
    prune_plan: bool = boolean(True)
    prune_distance: float = number(2.0, "m", minimum=0)
    forward_prune_distance: float = number(2.0, "m", description="negative for no limit")
    shorten_transformed_plan: bool = boolean(True)
    xy_goal_tolerance: float = number(0.25, "m", minimum=0)
    trans_stopped_velocity: float = number(0.25, "m/s", minimum=0)
    critics: tuple[str, ...] = texts()
    default_critic_namespaces: bool = without_effect()
    include_last_point: bool = without_effect()  # the last pose is rated in both cases
    short_circuit_trajectory_evaluation: bool = without_effect()  # it changes the time of a cycle, not its result
    debug_trajectory_details: bool = without_effect()
    publish_cost_grid_pc: bool = without_effect()
    stateful: bool = without_effect()  # DWB itself does not read it, either
    transform_tolerance: bool = without_effect()


class DwbCriticOptions(Options):
    """Options of the critics; each critic uses a few of them."""

    scale: float = number(1.0)
    sum_scores: bool = boolean(False)
    aggregation_type: str = text("last")
    forward_point_distance: float = number(0.325, "m")
    xy_goal_tolerance: float = number(0.25, "m", minimum=0)
    trans_stopped_velocity: float = number(0.25, "m/s", minimum=0)
    slowing_factor: float = number(5.0)
    lookahead_time: float = number(-1.0, "s")
    oscillation_reset_dist: float = number(0.05, "m")
    oscillation_reset_angle: float = number(0.2, "rad")
    oscillation_reset_time: float = number(-1.0, "s")
    x_only_threshold: float = number(0.05, "m/s")
    penalty: float = number(1.0)
    strafe_x: float = number(0.1, "m/s")
    strafe_theta: float = number(0.2, "rad/s")
    theta_scale: float = number(10.0)
