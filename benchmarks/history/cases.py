"""Workloads of the history: each is a part of simkit beside MuJoCo alone on the same compiled model.

They use only names that no version renames, such as `simkit.load`, `step` and `mj_model`, because the same workloads
measure old commits. The worlds are those of the checkout of this file.
"""

from __future__ import annotations

import copy
import re
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "benchmarks"))  # behind the measured checkout

Side = Callable[[int], object]  # one part of the work, by its number
Clock = Callable[[], float]
Sides = tuple[Side, Side]

_STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)
_SPAN = 200  # steps of a part: a lidar of 5 Hz takes one scan
_FORWARD = {"linear": {"x": 0.15}}
_STEPS = 2000  # in all parts of this drive
_PLACES = 10  # parts of a drive straight ahead, after which it begins again
_CAMERA_TYPES = ("Image", "CameraInfo", "PointCloud2")


@dataclass(frozen=True)
class Case:
    """One ratio.

    Attributes:
        title: what simkit does.
        beside: what MuJoCo alone does in the same run.
        make: function that prepares both sides, simkit's first, in a folder for files.
        rounds: how often each part is timed in a process.
        parts: number of parts of the work, which differ.
        units: number of steps, or of other units that the title names, in all parts together.
        clock: clock of both sides [s], or None if they return the value themselves.
    """

    title: str
    beside: str
    make: Callable[[Path], Sides]
    rounds: int
    parts: int = 1
    units: int = 1
    clock: Clock | None = time.process_time


def ignore(_: object) -> None:
    """Receive a message."""


def load(source: str) -> Any:
    """Load a world with the assets of this checkout."""
    import simkit

    return simkit.load(source, seed=1, resource_paths=[str(ROOT / "assets"), str(ROOT / "assets" / "turtlebot3")])


def bare_steps(sim: Any, count: int = _SPAN) -> Side:
    """Return steps of a copy of the model, always from the present state and with the present controls."""
    model, data = copy.copy(sim.mj_model), copy.copy(sim.mj_data)
    start = np.empty(mujoco.mj_stateSize(model, _STATE))
    mujoco.mj_getState(model, data, start, _STATE)

    def step(_: int) -> None:
        mujoco.mj_step(model, data, count)

    step.before = lambda _: mujoco.mj_setState(model, data, start, _STATE)  # type: ignore[attr-defined]
    return step


def turtlebot_world(keep: str = "") -> str:
    """Return the TurtleBot3 world with the plugin of the drive alone, and with the sensors of this type alone."""
    world = (ROOT / "worlds" / "turtlebot3_world.sdf").read_text(encoding="utf-8")
    model = (ROOT / "assets" / "turtlebot3" / "turtlebot3_waffle" / "model.sdf").read_text(encoding="utf-8")
    model = (
        model[model.index("<model") : model.rindex("</model>")].replace(">", "><pose>-2 -0.5 0 0 0 0</pose>", 1)
        + "</model>"
    )
    model = re.sub(r"<plugin(?![^>]*diff_drive).*?</plugin>", "", model, flags=re.DOTALL)
    sensors = r"<sensor name=\"[^\"]*\" type=\"(?!" + (keep or "none") + r"\").*?</sensor>"
    model = re.sub(sensors, "", model, flags=re.DOTALL)
    return re.sub(r"<include>.*?</include>", lambda _: model, world, flags=re.DOTALL)


def driving(sim: Any) -> Sides:
    """Let the robot drive straight ahead."""

    def begin(part: int = 0) -> None:
        if part == 0:
            sim.reset()
            sim.publish("/cmd_vel", _FORWARD)
            sim.step(500)

    def step(_: int) -> None:
        sim.step(_SPAN)

    begin()
    step.before = begin  # type: ignore[attr-defined]
    return step, bare_steps(sim)


def stripped(folder: Path) -> Sides:
    return driving(load(turtlebot_world()))


def compiled_model(folder: Path) -> Sides:
    """The engine's steps of the compiled model beside those of a model that no version changes."""
    sim = load(turtlebot_world())
    driving(sim)
    boxes = "".join(
        f'<body pos="{0.3 * i} 0 {0.1 + 0.21 * j}"><freejoint/><geom type="box" size=".1 .1 .1"/></body>'
        for i in range(2)
        for j in range(2)
    )
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="0.001"/><worldbody><geom type="plane" size="5 5 1"/>{boxes}</worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    return bare_steps(sim), lambda _: mujoco.mj_step(model, data, _SPAN)


def plugin(folder: Path) -> Sides:
    import simkit

    class Counter(simkit.WorldPlugin):
        def load(self, parent: object, params: object) -> None:
            self.calls = 0

        def after_step(self) -> None:
            self.calls += 1

    sim = simkit.load(
        turtlebot_world(), plugins=[Counter()], resource_paths=[str(ROOT / "assets"), str(ROOT / "assets/turtlebot3")]
    )
    return driving(sim)


def imu(callback: Callable[[object], None] | None) -> Callable[[Path], Sides]:
    def make(folder: Path) -> Sides:
        sim = load(turtlebot_world("imu"))
        (topic,) = (name for name, kind in sim.topics().items() if kind.endswith("/Imu"))
        sim.subscribe(topic, callback, keep=1)
        return driving(sim)

    return make


def all_sensors(folder: Path) -> Sides:
    sim = load("turtlebot3_world")
    for topic, kind in sorted(sim.topics().items()):
        if not kind.endswith(_CAMERA_TYPES):
            sim.subscribe(topic, ignore, keep=1)
    return driving(sim)


_DRIVE = {0.5: {"linear": {"x": 0.26}}, 4.1: {"linear": {"x": 0.26}, "angular": {"z": 0.47}}, 7.25: {}}
_PARTS = 32  # of a quarter of a second, so that a command falls on the start of one


def main_job(with_bag: bool) -> Callable[[Path], Sides]:
    """The first 8 s of the drive of `turtlebot3_world`, beside bare steps with the same states and controls."""

    def make(folder: Path) -> Sides:
        sim = load("turtlebot3_world")
        steps = round(0.25 / sim.timestep)
        starts, controls = [], []
        size = mujoco.mj_stateSize(sim.mj_model, _STATE)

        def command(part: int) -> None:
            for at, message in _DRIVE.items():
                if round(at * 4) == part:
                    sim.publish("/cmd_vel", message)

        for part in range(_PARTS):
            command(part)
            start = np.empty(size)
            mujoco.mj_getState(sim.mj_model, sim.mj_data, start, _STATE)
            row = []
            for _ in range(steps):
                sim.step()
                row.append(sim.mj_data.ctrl.copy())
            starts.append(start)
            controls.append(runs_of_equal(row))
        model, data = copy.copy(sim.mj_model), copy.copy(sim.mj_data)
        opened: list[Any] = []

        def ours(part: int) -> None:
            command(part)
            sim.step(steps)

        def before(part: int) -> None:
            if part == 0:
                while opened:
                    opened.pop().close()
                sim.reset()
                if with_bag:
                    from simkit.recording.bags.recorder import Recorder

                    opened.append(Recorder(sim, folder / "bag.mcap", overwrite=True, skip=["/camera/*"]))

        def bare(part: int) -> None:
            for control, count in controls[part]:
                data.ctrl[:] = control
                mujoco.mj_step(model, data, count)

        ours.before = before  # type: ignore[attr-defined]
        bare.before = lambda part: mujoco.mj_setState(model, data, starts[part], _STATE)  # type: ignore[attr-defined]
        return ours, bare

    return make


def runs_of_equal(rows: list[Any]) -> list[tuple[Any, int]]:
    """Return each control with the number of steps for which it holds."""
    runs: list[tuple[Any, int]] = []
    for row in rows:
        if runs and np.array_equal(runs[-1][0], row):
            runs[-1] = row, runs[-1][1] + 1
        else:
            runs.append((row, 1))
    return runs


def fleet_of_ten(folder: Path) -> Sides:
    import fleet

    sim = load(fleet.world(10, "gz"))
    for topic, kind in sorted(sim.topics().items()):
        if kind in fleet.READ:
            sim.subscribe(topic, ignore, keep=1)
    fleet.drive(sim)
    sim.step(300)
    bare = bare_steps(sim)
    return lambda _: sim.step(_SPAN), bare


_LIDAR = """<model name="m"><static>true</static><pose>0.1 0.2 {height} 0 0 0</pose><link name="l">
<sensor name="s" type="lidar"><update_rate>10</update_rate><topic>/scan</topic><lidar><scan>
<horizontal><samples>{columns}</samples><min_angle>-3.1</min_angle><max_angle>3.1</max_angle></horizontal>
<vertical><samples>{layers}</samples><min_angle>{low}</min_angle><max_angle>{high}</max_angle></vertical></scan>
<range><min>0.1</min><max>60</max></range><noise type="gaussian"><stddev>0.01</stddev></noise></lidar></sensor></link>
</model>"""
_SENSORS = '<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>'


def tilt_of(layers: int) -> float:
    """Return the angle of the highest layer [rad]."""
    return 0.3 if layers > 1 else 0.0


def lidar_world(columns: int, layers: int, height: float, things: str) -> str:
    """Return a world with a lidar of 10 Hz and steps of 0.1 s."""
    spread = tilt_of(layers)
    sensor = _LIDAR.format(height=height, columns=columns, layers=layers, low=-spread, high=spread)
    return (
        f'<sdf version="1.9"><world name="w"><physics type="ignored"><max_step_size>0.1</max_step_size></physics>'
        f"{_SENSORS}{things}{sensor}</world></sdf>"
    )


def lidar(columns: int, layers: int, height: float, things: Callable[[Path], str]) -> Callable[[Path], Sides]:
    """One scan a step of 0.1 s, with noise and message, beside `mj_multiRay` of the same rays."""

    def make(folder: Path) -> Sides:
        spread = tilt_of(layers)
        sim = load(lidar_world(columns, layers, height, things(folder)))
        received: list[object] = []
        sim.subscribe("/scan", lambda _: received.append(None), keep=1)
        sim.step(10)
        if not 9 <= len(received) <= 11:
            raise RuntimeError(f"{len(received)} scans in 10 steps")
        model, data = copy.copy(sim.mj_model), copy.copy(sim.mj_data)
        mujoco.mj_forward(model, data)
        turn, tilt = np.linspace(-3.1, 3.1, columns), np.linspace(-spread, spread, layers)[:, None]
        ways = np.stack(np.broadcast_arrays(np.cos(tilt) * np.cos(turn), np.cos(tilt) * np.sin(turn), np.sin(tilt)), -1)
        count = columns * layers
        ids, distances, origin = np.zeros(count, np.int32), np.zeros(count), np.array([0.1, 0.2, height])
        flat = np.ascontiguousarray(ways.reshape(-1))

        def bare(_: int) -> None:
            mujoco.mj_multiRay(model, data, origin, flat, None, 1, -1, ids, distances, None, count, 60.0)

        return lambda _: sim.step(1), bare

    return make


def pillars(folder: Path) -> str:
    shape = "<geometry><cylinder><radius>0.15</radius><length>2</length></cylinder></geometry>"
    wall = '<collision name="w{0}"><pose>{1}</pose><geometry><box><size>0.1 8 2</size></box></geometry></collision>'
    places = ("4 0 0 0 0 0", "-4 0 0 0 0 0", "0 4 0 0 0 1.5708", "0 -4 0 0 0 1.5708")
    walls = "".join(wall.format(number, place) for number, place in enumerate(places))
    return f'<model name="walls"><static>true</static><link name="l">{walls}</link></model>' + "".join(
        f'<model name="p{i}"><static>true</static><pose>{1.1 * (i % 5) - 1.5} {1.1 * (i // 5) - 1.5} 0 0 0 0</pose>'
        f'<link name="l"><collision name="c">{shape}</collision></link></model>'
        for i in range(25)
    )


def terrain_and_boxes(folder: Path) -> str:
    import scans

    mesh = scans.terrain(100, 0.0, folder)
    box = "<geometry><box><size>0.5 0.5 0.5</size></box></geometry>"
    boxes = "".join(
        f'<model name="b{i}"><pose>{2 + i % 5} {i // 5 - 2} 2 0 0 0.3</pose><link name="l"><gravity>false</gravity>'
        f'<collision name="c">{box}</collision></link></model>'
        for i in range(20)
    )
    ground = f'<collision name="c"><geometry><mesh><uri>{mesh}</uri></mesh></geometry></collision>'
    return f'<model name="ground"><static>true</static><link name="l">{ground}</link></model>{boxes}'


_CAMERA = """<model name="m"><static>true</static><pose>-2 -0.5 0.3 0 0 0</pose><link name="l">
<sensor name="s" type="rgbd_camera"><update_rate>10</update_rate><topic>/cam</topic><camera>
<horizontal_fov>1.2</horizontal_fov><image><width>640</width><height>480</height></image>
<clip><near>0.1</near><far>20</far></clip></camera></sensor></link></model>"""


def rgbd(folder: Path) -> Sides:
    """One RGB-D frame a step of 0.1 s, beside one colour picture of `mujoco.Renderer` without shadows."""
    text = turtlebot_world().replace("<max_step_size>0.001", "<max_step_size>0.1")
    text = re.sub(r'<model name="turtlebot3_waffle.*?</model>', "", text, flags=re.DOTALL)  # for the camera's view
    sim = load(text.replace("</world>", f"{_SENSORS}{_CAMERA}</world>"))
    for topic, kind in sim.topics().items():
        if kind.endswith("/Image"):
            sim.subscribe(topic, ignore, keep=1)
    sim.step(3)
    model, data = copy.copy(sim.mj_model), copy.copy(sim.mj_data)
    model.vis.quality.offsamples = 0
    model.vis.quality.shadowsize = 0
    mujoco.mj_forward(model, data)
    renderer = mujoco.Renderer(model, 480, 640)
    eye = mujoco.MjvCamera()
    eye.type, eye.lookat[:], eye.distance, eye.elevation, eye.azimuth = 0, (-1.0, -0.5, 0.3), 1.0, 0.0, 0.0

    def bare(_: int) -> None:
        renderer.update_scene(data, eye)
        renderer.render()

    return lambda _: sim.step(1), bare


def environment() -> Any:
    import simkit.gym

    options: dict[str, Any] = {
        "observation": "/scan",
        "action": {"/cmd_vel": {"linear.x": (0.0, 0.26), "angular.z": (-1.5, 1.5)}},
        "reward": lambda env: -float(np.hypot(*env.sim.model("turtlebot3").pose.position[:2])),
    }
    try:
        env = simkit.gym.make("turtlebot3_world", samples_all=False, **options)
    except TypeError:  # before there was the option
        env = simkit.gym.make("turtlebot3_world", **options)
    env.reset(seed=0)
    env.step((0.1, 0.4))
    return env


def learning_step(folder: Path) -> Sides:
    env = environment()
    bare = bare_steps(env.unwrapped.sim, 100)

    def step(part: int) -> None:
        env.step((0.1, 0.4))

    step.before = lambda part: env.reset() if part == 0 else None  # type: ignore[attr-defined]
    return step, bare


def learning_reset(folder: Path) -> Sides:
    env = environment()
    bare = bare_steps(env.unwrapped.sim, 100)
    return lambda _: env.reset(), bare


def converted(folder: Path, world: str) -> Path:
    """Write the world as MJCF with its files."""
    file = folder / "converted" / "world.xml"
    if not file.is_file():
        file.parent.mkdir(parents=True)
        subprocess.run(
            [sys.executable, "-m", "simkit", "convert", world, "-o", str(file)], check=True, capture_output=True
        )
    return file


def loading(folder: Path) -> Sides:
    load("turtlebot3_world").close()
    file = str(converted(folder, "turtlebot3_world"))

    def bare(_: int) -> object:
        model = mujoco.MjModel.from_xml_path(file)
        return model, mujoco.MjData(model)

    return lambda _: load("turtlebot3_world").close(), bare


def children_clock() -> float:
    """Return the CPU time of finished child processes [s]."""
    import resource  # Windows has none

    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def command(folder: Path) -> Sides:
    def run(*arguments: str) -> Side:
        return lambda _: subprocess.run([sys.executable, *arguments], check=True, capture_output=True)

    return run("-m", "simkit", "run", "empty", "--duration", "0"), run("-c", "import mujoco")


_RESIDENT = """
import os, sys
def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
"""
_OURS = (
    _RESIDENT
    + """
import simkit
with open(sys.argv[1], encoding="utf-8") as file:
    sim = simkit.load(file.read(), resource_paths=sys.argv[3:])
sim.run(0.3)
import mujoco
mujoco.mj_saveModel(sim.mj_model, sys.argv[2])
print(resident())
"""
)
_BARE = (
    _RESIDENT
    + """
import mujoco, numpy
model = mujoco.MjModel.from_binary_path(sys.argv[2])
data = mujoco.MjData(model)
mujoco.mj_step(model, data, 300)
print(resident())
"""
)


def memory(folder: Path) -> Sides:
    """Resident memory [bytes] of a process with 100 robots after 0.3 s, beside MuJoCo with the same compiled model."""
    import fleet

    world = folder / "fleet.sdf"
    world.write_text(fleet.world(100, "gz"), encoding="utf-8")
    arguments = [str(world), str(folder / "fleet.mjb"), str(ROOT / "assets"), str(ROOT / "assets" / "turtlebot3")]

    def run(code: str) -> Side:
        def measured(_: int) -> float:
            done = subprocess.run([sys.executable, "-c", code, *arguments], check=True, capture_output=True, text=True)
            return float(done.stdout.split()[-1])

        return measured

    return run(_OURS), run(_BARE)


STEPS = "`mj_step` of the same compiled model"
CASES = {
    "compiled_model": Case(
        "steps of MuJoCo on the compiled TurtleBot3 world", "steps of four boxes", compiled_model, 40, 1, _SPAN
    ),
    "step": Case("steps of a robot that drives, nobody listens", STEPS, stripped, 5, _PLACES, _STEPS),
    "plugin": Case("steps with a Python plugin after each", STEPS, plugin, 5, _PLACES, _STEPS),
    "imu_later": Case("steps with an IMU at 200 Hz, newest message kept", STEPS, imu(None), 5, _PLACES, _STEPS),
    "imu_messages": Case(
        "steps with an IMU at 200 Hz, a callback for each message", STEPS, imu(ignore), 5, _PLACES, _STEPS
    ),
    "all_sensors": Case(
        "all topics except images, a callback for each message", STEPS, all_sensors, 5, _PLACES, _STEPS
    ),
    "main_job": Case(
        "main job, nobody listens", "`mj_step` with the recorded controls", main_job(False), 12, _PARTS, 250 * _PARTS
    ),
    "main_job_bag": Case(
        "main job, recorded", "`mj_step` with the recorded controls", main_job(True), 12, _PARTS, 250 * _PARTS
    ),
    "fleet": Case("ten robots, a callback for each message", STEPS, fleet_of_ten, 16, 1, _SPAN),
    "scan": Case(
        "scan of 360 rays among 25 pillars", "`mj_multiRay` of the same rays", lidar(360, 1, 0.5, pillars), 200
    ),
    "dense_scan": Case(
        "scan of 16 × 900 rays over 20,000 triangles, among 20 boxes",
        "`mj_multiRay` of the same rays",
        lidar(900, 16, 1.5, terrain_and_boxes),
        20,
    ),
    "rgbd": Case("RGB-D frame of 640 × 480", "one colour picture of `mujoco.Renderer`, no shadows", rgbd, 16),
    "learning_step": Case("step of a Gymnasium environment, 0.1 s", "100 steps of `mj_step`", learning_step, 8, 16, 16),
    "learning_reset": Case("reset of a Gymnasium environment", "100 steps of `mj_step`", learning_reset, 200),
    "loading": Case("load of the TurtleBot3 world", "MuJoCo reads the converted MJCF", loading, 12),
    "command": Case("`simkit run empty --duration 0`", "`import mujoco`", command, 4, clock=children_clock),
    "memory": Case("memory of 100 robots", "MuJoCo with the compiled model", memory, 1, clock=None),
}
