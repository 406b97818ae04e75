"""One rover, one drive, twelve seeds: where its odometry says it went, and how far off it says it may be."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from plots import BLUE, ORANGE, TRUTH, figure, run, save

import simkit

SEEDS, SECONDS, STEP = 12, 8.0, 0.004
WHEEL = """
      <link name="{side}">
        <pose>0 {y} 0.1 0 0 0</pose>
        <inertial><mass>0.5</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
        <collision name="tyre"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
      </link>
      <joint name="{side}_joint" type="revolute">
        <parent>base</parent><child>{side}</child><axis><xyz>0 1 0</xyz></axis>
      </joint>
"""
CASTER = """
        <collision name="{name}">
          <pose>{x} 0 -0.05 0 0 0</pose><geometry><sphere><radius>0.05</radius></sphere></geometry>
          <surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface>
        </collision>
"""
WORLD = f"""
<sdf version="1.9" xmlns:simkit="simkit">
  <world name="yard">
    <physics name="step" type="ode"><max_step_size>{STEP}</max_step_size></physics>
    <include><uri>model://ground_plane</uri></include>
    <model name="rover">
      <link name="base">
        <pose>0 0 0.1 0 0 0</pose>
        <inertial><mass>5</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
        {CASTER.format(name="front", x=0.2)}{CASTER.format(name="rear", x=-0.2)}
      </link>
      {WHEEL.format(side="left", y=0.2)}{WHEEL.format(side="right", y=-0.2)}
      <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
        <left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>
        <wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius>
        <topic>cmd_vel</topic><odom_topic>odom</odom_topic><odom_publish_frequency>25</odom_publish_frequency>
        <simkit:odometry_noise><wheel_variance>4e-4</wheel_variance></simkit:odometry_noise>
      </plugin>
    </model>
  </world>
</sdf>
"""


def drive(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What the odometry says (n, 2) [m], the true track (n, 2) [m], and the covariance at the end (2, 2) [m²]."""
    with simkit.load(WORLD, seed=seed) as sim:
        odometry = sim.subscribe("odom")
        sim.publish("/cmd_vel", {"linear": {"x": 0.6}, "angular": {"z": 0.15}})
        true = []
        while sim.time < SECONDS:
            sim.run(0.2)
            true.append(sim.link("rover::base").pose.position[:2])
        told = [(m.pose.pose.position.x, m.pose.pose.position.y) for m in odometry.messages]
        covariance = np.reshape(odometry.latest.pose.covariance, (6, 6))[:2, :2]
    return np.array(told), np.array(true), covariance


def ellipse(centre: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """Where nine of ten end, shape (2, n), for a normal distribution."""
    angle = np.linspace(0, 2 * np.pi, 80)
    circle = np.array((np.cos(angle), np.sin(angle))) * np.sqrt(-2 * np.log(0.1))
    return centre[:, None] + np.linalg.cholesky(covariance) @ circle


def main(out: Path) -> None:
    runs = [drive(seed) for seed in range(SEEDS)]
    fig, ax = figure(f"Odometry of one drive with {SEEDS} seeds: 2 cm per √m on each wheel")
    for told, _, _ in runs:
        ax.plot(*told.T, color=BLUE, lw=0.7, alpha=0.7)
        ax.plot(*told[-1], "o", ms=3, color=BLUE)
    true, covariance = runs[0][1], runs[0][2]
    ax.plot([], [], color=BLUE, lw=0.7, label="odometry")
    ax.plot(*true.T, color=TRUTH, label="the rover")
    ax.plot(*ellipse(true[-1], covariance), color=ORANGE, label="where its covariance expects nine of ten")
    ax.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    ax.legend(loc="upper left", fontsize="small")
    save(fig, out)


if __name__ == "__main__":
    run(main, "odometry.png")
