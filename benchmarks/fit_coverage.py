"""Coverage of the intervals of `simkit fit`: how often the 95 % interval holds the truth, and the errors of the values.

python benchmarks/fit_coverage.py [--case NAME,NAME] [--count N] [--json FILE]

Each case records a small world with true values and noise, N times with other seeds, and fits other first values to
each recording. A fit may use one core for about a second.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import measure  # noqa: F401  (finds simkit beside it)
import numpy as np

import simkit
from simkit.recording import Recorder

STEP = "<physics type='ignored'><max_step_size>0.005</max_step_size></physics>"
FORCE = "/model/{0}/joint/{1}/cmd_force"
JOINT_FORCE = """<plugin filename="gz-sim-apply-joint-force-system" name="gz::sim::systems::ApplyJointForce">
<joint_name>{0}</joint_name></plugin>"""


def imu(kind: str, axis: str, deviation: float) -> str:
    """Inertial sensor at 50 Hz with noise on one axis."""
    noise = f"<{axis}><noise type='gaussian'><stddev>{deviation}</stddev></noise></{axis}>"
    return f"""<sensor name="imu" type="imu"><update_rate>50</update_rate><topic>imu</topic>
<imu><{kind}>{noise}</{kind}></imu></sensor>"""


@dataclass(frozen=True)
class Case:
    """World with true values.

    Attributes:
        world: function from values to the world's text.
        truth: true values by path.
        first: first values, in the order of the truth.
        drive: function that runs the recorded world with commands.
        compare: topics.
    """

    world: Callable[..., str]
    truth: Mapping[str, float]
    first: tuple[float, ...]
    drive: Callable[[simkit.Simulation], None]
    compare: tuple[str, ...]


def slider(mass: float, damping: float) -> str:
    return f"""<sdf version="1.9"><world name="w">{STEP}<model name="cart"><link name="rail"/>
<joint name="fix" type="fixed"><parent>world</parent><child>rail</child></joint>
<link name="car"><inertial><mass>{mass}</mass></inertial>{imu("linear_acceleration", "x", 0.1)}</link>
<joint name="slide" type="prismatic"><parent>rail</parent><child>car</child>
<axis><xyz>1 0 0</xyz><dynamics><damping>{damping}</damping></dynamics></axis></joint>{JOINT_FORCE.format("slide")}
</model></world></sdf>"""


def push(sim: simkit.Simulation) -> None:
    for number in range(30):
        sim.publish(FORCE.format("cart", "slide"), {"data": 3.0 if number // 3 % 2 == 0 else -2.0})
        sim.run(0.1)


def pendulum(damping: float, centre: float) -> str:
    return f"""<sdf version="1.9"><world name="w">{STEP}<model name="swing"><link name="base"/>
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<link name="bob"><inertial><pose>0 0 {centre} 0 0 0</pose><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy>
<izz>0.01</izz></inertia></inertial>{imu("angular_velocity", "y", 0.05)}</link>
<joint name="hinge" type="revolute"><parent>base</parent><child>bob</child>
<axis><xyz>0 1 0</xyz><dynamics><damping>{damping}</damping></dynamics></axis></joint>{JOINT_FORCE.format("hinge")}
</model></world></sdf>"""


def swing(sim: simkit.Simulation) -> None:
    for torque, duration in ((2.0, 0.3), (0.0, 3.0)):
        sim.publish(FORCE.format("swing", "hinge"), {"data": torque})
        sim.run(duration)


def servo(p: float, d: float) -> str:
    return f"""<sdf version="1.9"><world name="w">{STEP}<gravity>0 0 0</gravity><model name="arm"><link name="base"/>
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<link name="rod"><inertial><mass>1</mass><inertia><ixx>0.2</ixx><iyy>0.2</iyy><izz>0.2</izz></inertia></inertial>
{imu("angular_velocity", "z", 0.05)}</link>
<joint name="turn" type="revolute"><parent>base</parent><child>rod</child><axis><xyz>0 0 1</xyz></axis></joint>
<plugin filename="gz-sim-joint-position-controller-system" name="pid"><joint_name>turn</joint_name><topic>/turn</topic>
<p_gain>{p}</p_gain><i_gain>0</i_gain><d_gain>{d}</d_gain></plugin></model></world></sdf>"""


def turn(sim: simkit.Simulation) -> None:
    for angle in (0.5, -0.3, 0.2):
        sim.publish("/turn", {"data": angle})
        sim.run(1.0)


def wheel(side: str, y: float) -> str:
    return f"""<link name="{side}"><pose relative_to="base">0 {y} 0 -1.5708 0 0</pose><inertial><mass>0.1</mass>
<inertia><ixx>0.0002</ixx><iyy>0.0002</iyy><izz>0.0002</izz></inertia></inertial>
<collision name="c"><geometry><cylinder><radius>0.05</radius>
<length>0.02</length></cylinder></geometry></collision></link><joint name="{side}_joint"
type="revolute"><parent>base</parent><child>{side}</child><axis><xyz>0 0 1</xyz></axis></joint>"""


def robot(radius: float, separation: float) -> str:
    return f"""<sdf version="1.9"><world name="w">{STEP}<model name="ground"><static>true</static><link name="l">
<collision name="c"><geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>
<model name="robot"><pose>0 0 0.05 0 0 0</pose><link name="base"><inertial><mass>1</mass><inertia><ixx>0.01</ixx>
<iyy>0.01</iyy><izz>0.01</izz></inertia></inertial><collision name="ball"><pose>-0.1 0 -0.03 0 0 0</pose><geometry>
<sphere><radius>0.02</radius></sphere></geometry><surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction>
</surface></collision></link>{wheel("left", 0.1)}{wheel("right", -0.1)}
<plugin filename="gz-sim-diff-drive-system" name="drive"><left_joint>left_joint</left_joint>
<right_joint>right_joint</right_joint><wheel_separation>{separation}</wheel_separation>
<wheel_radius>{radius}</wheel_radius><topic>/cmd_vel</topic><odom_topic>/wheel_odom</odom_topic></plugin>
<plugin filename="libgazebo_ros_p3d.so" name="pose"><body_name>base</body_name><update_rate>20</update_rate>
<gaussian_noise>0.002</gaussian_noise><ros><remapping>odom:=/pose</remapping></ros></plugin>
</model></world></sdf>"""


def drive(sim: simkit.Simulation) -> None:
    for linear, angular in ((0.2, 0.0), (0.2, 0.8), (0.0, -0.8), (0.2, -0.4)):
        sim.publish("/cmd_vel", {"linear": {"x": linear}, "angular": {"z": angular}})
        sim.run(1.0)


CASES = {
    "slider": Case(
        slider, {"cart::car.inertial.mass": 2.0, "cart::slide.axis.dynamics.damping": 1.5}, (1.0, 1.0), push,
        ("/imu.linear_acceleration",),
    ),
    "pendulum": Case(
        pendulum, {"swing::hinge.axis.dynamics.damping": 0.08, "swing::bob.inertial.com.z": -0.4}, (0.05, -0.5), swing,
        ("/imu.angular_velocity",),
    ),
    "servo": Case(
        servo, {"arm::pid.p_gain": 35.0, "arm::pid.d_gain": 3.0}, (20.0, 2.0), turn, ("/imu.angular_velocity",)
    ),
    "robot": Case(
        robot, {"robot::drive.wheel_radius": 0.052, "robot::drive.wheel_separation": 0.21}, (0.05, 0.2), drive,
        ("/pose",),
    ),
}  # fmt: skip


def run_case(case: Case, count: int, folder: Path) -> dict[str, dict[str, float]]:
    """Fit recordings with different noise; return figures by path."""
    names = list(case.truth)
    held = dict.fromkeys(names, 0)
    errors: dict[str, list[float]] = {name: [] for name in names}
    widths: dict[str, list[float]] = {name: [] for name in names}
    begun = time.perf_counter()
    for seed in range(1, count + 1):
        bag = folder / "run.mcap"
        with simkit.load(case.world(*case.truth.values()), seed=seed) as sim, Recorder(sim, bag, overwrite=True):
            case.drive(sim)
        result = simkit.fit(case.world(*case.first), bag, names, compare=case.compare)
        for name, truth in case.truth.items():
            low, high = result.intervals[name]
            held[name] += low <= truth <= high
            errors[name].append(abs(result.values[name] / truth - 1.0))
            widths[name].append((high - low) / abs(truth))
    seconds = (time.perf_counter() - begun) / count
    return {
        name: {
            "held": held[name], "count": count, "median_error": float(np.median(errors[name])),
            "largest_error": float(np.max(errors[name])), "width": float(np.median(widths[name])), "seconds": seconds,
        }
        for name in names
    }  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--case", default=",".join(CASES), metavar="NAME,NAME")
    parser.add_argument("--count", type=int, default=100, metavar="N")
    parser.add_argument("--json", type=Path, metavar="FILE")
    args = parser.parse_args()
    found = {}
    print("| case | parameter | held | median error | largest error | width of the interval | s a fit |")
    print("|---|---|---:|---:|---:|---:|---:|")
    for name in args.case.split(","):
        with tempfile.TemporaryDirectory() as folder:
            found[name] = run_case(CASES[name], args.count, Path(folder))
        for path, row in found[name].items():
            numbers = f"{100 * row['median_error']:.2f} % | {100 * row['largest_error']:.2f} %"
            print(
                f"| {name} | `{path}` | {row['held']:.0f} of {row['count']:.0f} | {numbers} | "
                f"{100 * row['width']:.2f} % | {row['seconds']:.2f} |",
                flush=True,
            )
    if args.json:
        args.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
