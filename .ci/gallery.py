"""Open, draw, drive and move public robots and worlds, and write docs/gallery.md.

    python .ci/gallery.py [--files DIR] [NAME ...]

gallery.txt is the table of entries. The robots come from packages of the index (PACKAGES), which are unpacked into
DIR (default: build/gallery), not installed. The worlds of Gazebo come from public repositories: DIR holds their
clones as OWNER+REPOSITORY. An entry whose file is missing keeps its old result. With names, the script measures only
these entries again.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import math
import re
import subprocess
import sys
import tempfile
import time
import zipfile
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from simkit.number_text import counted

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))
IMAGES = ROOT / "docs" / "images" / "gallery"
PAGE = ROOT / "docs" / "gallery.md"

PACKAGES = {
    "dm_control": "1.0.50",
    "example_robot_data": "6.0.0",
    "gym_aloha": "0.1.5",
    "gym_hil": "0.1.14",
    "gymnasium": "1.4.0",
    "hello_robot_stretch_urdf": "0.1.2",
    "icub_models": "3.2.0",
    "pybullet": "3.2.7",
    "robosuite": "1.5.2",
    "rtb_data": "2.0.0",
}


CONTROLLERS = """mobile_base_controller:
  type: diff_drive_controller/DiffDriveController
  left_wheel: wheel_left_joint
  right_wheel: wheel_right_joint
"""  # controllers.yaml of the TIAGos: a ROS launch file would load it

SPEED, TURN, ARC = 0.25, 0.5, 0.25  # m/s, rad/s in place, rad/s in the circle
BANDWIDTH, TRAVEL, MOVE_TIME = 12.0, 0.5, 4.0  # rad/s of the controllers, rad or m of a joint, s


@dataclass(frozen=True)
class Entry:
    """Row of the table: `file` is relative to the folder of files."""

    name: str
    file: str
    kind: str
    parameters: tuple[str, ...]

    @property
    def slug(self) -> str:
        return re.sub(r"[^a-z0-9]+", "_", self.name.lower()).strip("_")


def entries() -> Iterator[Entry]:
    folders: dict[str, str] = {}
    for line in Path(__file__).with_suffix(".txt").read_text().splitlines():
        if line.startswith("#"):
            continue
        if " = " in line:
            folders.update([line.split(" = ")])
            continue
        name, file, kind, *rest = (cell.strip() for cell in line.split("|"))
        first, _, tail = file.partition("/")
        yield Entry(name, f"{folders.get(first, first)}/{tail}", kind, tuple(rest[0].split()) if rest else ())


def file_of(entry: Entry, folder: Path) -> Path:
    """Return the file of an entry: below the folder of files, or below the repository for simkit's own robots."""
    first, _, tail = entry.file.partition("/")
    return ROOT / tail if first == "simkit" else (folder / entry.file).resolve()


def unpack_packages(folder: Path) -> None:
    """Download and unpack the packages that the folder does not contain."""
    for name, version in PACKAGES.items():
        if (folder / name).is_dir():
            continue
        with tempfile.TemporaryDirectory() as wheels:
            options = ["--no-deps", "--only-binary=:all:", "--python-version", "3.11", "-d", wheels]
            subprocess.run([sys.executable, "-m", "pip", "download", *options, f"{name}=={version}"], check=True)
            for wheel in Path(wheels).glob("*.whl"):
                zipfile.ZipFile(wheel).extractall(folder / name)


# ---------------------------------------------------------------------- measurements of one entry


def measure(entry: Entry, file: Path) -> dict[str, Any]:
    """Open an entry and return its figures; a robot is driven, moved or held."""
    import simkit

    with controller_file(CONTROLLERS if "controllers.yaml" in entry.parameters else "") as parameters:
        start = time.process_time()
        sim = simkit.load(str(file), model_world="ground", params_files=parameters)
    found: dict[str, Any] = {"load": time.process_time() - start}
    found["warnings"] = dict(Counter(d.code for d in sim.diagnostics if d.severity == "warning"))
    if entry.kind == "world":
        start = time.process_time()
        sim.run(2.0)
        found["rate"] = 2.0 / (time.process_time() - start)
        found["models"], found["sensors"] = len(sim.models), len(sim.contents.sensors)
        return found
    name = next(n for n, m in sim.models.items() if not m.static)
    if entry.kind == "own":
        return found | drive(sim, name, entry)
    loops = control_loops(sim, name, entry)
    if entry.kind == "legs":
        return found | {"joints": len(loops)}
    is_free = int(sim.mj_model.jnt_type[0]) == 0
    if entry.parameters[:1] == ("position",):
        base = "fixed" if entry.kind == "arm" and is_free else "auto"
        with controller_file(controller_text(entry.parameters[0], loops)) as parameters:
            sim = simkit.load(str(file), model_world="ground", params_files=parameters, base=base)
        return found | move(sim, name, next(t for t in sim.topics() if t.endswith("/arm_controller/command")), loops)
    with tempfile.NamedTemporaryFile("w", suffix=".sdf", dir=file.parent) as world:
        world.write(world_text(sim, name, entry, file, loops, entry.kind == "arm" and is_free))
        world.flush()
        sim = simkit.load(world.name)
    if entry.kind == "diff":
        return found | drive(sim, "robot", entry)
    return found | move(sim, "robot", "/model/robot/joint_trajectory", loops)


@contextlib.contextmanager
def controller_file(text: str) -> Iterator[list[str]]:
    """Write a controller file and return its path in a list; without a text, the list is empty."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "controllers.yaml"
        file.write_text(text)
        yield [str(file)] if text else []


@dataclass(frozen=True)
class Loop:
    """Position loop of a joint: first position and goal [rad or m], gains."""

    begin: float
    goal: float
    p: float
    i: float
    d: float


def control_loops(sim: Any, name: str, entry: Entry) -> dict[str, Loop]:
    """Return the loops of all joints that no drive and no other joint moves, with three equal poles at `BANDWIDTH`."""
    goals, sign = {}, -1.0 if "down" in entry.parameters else 1.0
    for joint in sim.model(name).joints.values():
        is_driven = any(joint.name in p.split("+") for p in entry.parameters)
        mimics = any(axis.mimic for axis in joint.scene.axes)
        if joint.dof != 1 or is_driven or mimics or re.search("wheel|caster", joint.name):
            continue
        begin = min(max(float(joint.position), joint.lower), joint.upper)
        up, down = joint.upper - begin, begin - joint.lower
        step = min(TRAVEL, 0.4 * max(up, down)) if entry.kind == "arm" else 0.0
        goals[joint.name] = begin, begin + sign * math.copysign(step, up - down if math.isfinite(up - down) else 1.0)
    inertias = inertia(sim)
    sim.model(name).set_joint_positions({joint: goal for joint, (_, goal) in goals.items()})
    inertias = [max(pair) for pair in zip(inertias, inertia(sim), strict=True)]
    loops = {}
    for joint, (begin, goal) in goals.items():
        handle = sim.model(name).joints[joint]
        value, damping = inertias[handle.mj_dofs[0]], handle.scene.axes[0].damping
        p = 3 * value * BANDWIDTH**2 + damping * BANDWIDTH
        loops[joint] = Loop(begin, goal, p, p * BANDWIDTH / 3, 3 * value * BANDWIDTH)
    return loops


def inertia(sim: Any) -> list[float]:
    """Return the inertia of each degree of freedom in the present pose [kg·m² or kg]."""
    import mujoco
    import numpy as np

    mass = np.zeros((sim.mj_model.nv, sim.mj_model.nv))
    mujoco.mj_forward(sim.mj_model, sim.mj_data)
    mujoco.mj_fullM(sim.mj_model, sim.mj_data, mass)
    return [float(value) for value in np.diag(mass)]


def controller_text(interface: str, joints: Iterable[str]) -> str:
    """Return the file of a trajectory controller for a robot that has ros_control."""
    return (
        f"arm_controller:\n  type: {interface}_controllers/JointTrajectoryController\n  joints: [{', '.join(joints)}]\n"
    )


def world_text(sim: Any, name: str, entry: Entry, file: Path, loops: dict[str, Loop], is_mounted: bool) -> str:
    """Return a world with the robot, a trajectory controller for its joints and a drive."""
    blocks = [
        f"<joint_name>{joint}</joint_name><initial_position>{loop.begin!r}</initial_position>"
        f"<position_p_gain>{loop.p!r}</position_p_gain><position_i_gain>{loop.i!r}</position_i_gain>"
        f"<position_d_gain>{loop.d!r}</position_d_gain>"
        for joint, loop in loops.items()
    ]
    plugins = differential(sim, name, entry.parameters) if entry.kind == "diff" else ""
    if loops:
        plugins += f"""<plugin filename="gz-sim-joint-trajectory-controller-system" name="arm">{"".join(blocks)}
<simkit:interpolation>cubic</simkit:interpolation></plugin>"""
    mount = '<joint name="mount" type="fixed"><parent>world</parent><child>robot</child></joint>'
    return f"""<sdf version="1.9"><world name="gallery">
<include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>
<include><uri>{file.name}</uri><name>robot</name><pose>0 0 {float(sim.model(name).pose.position[2])!r} 0 0 0</pose>
{plugins}</include>{mount if is_mounted else ""}</world></sdf>"""


def anchors(sim: Any, name: str, joints: str) -> list[float]:
    """Return the mean position [m] of joints that are separated by `+`."""
    import numpy as np

    found = [sim.mj_data.joint(f"{name}::{joint}").xanchor for joint in joints.split("+")]
    return [float(value) for value in np.mean(found, axis=0)]


def tags(name: str, joints: str) -> str:
    return "".join(f"<{name}>{joint}</{name}>" for joint in joints.split("+"))


def differential(sim: Any, name: str, parameters: tuple[str, ...]) -> str:
    left, right, factor = parameters
    a, b = anchors(sim, name, left), anchors(sim, name, right)
    return (
        f'<plugin filename="gz-sim-diff-drive-system" name="drive">{tags("left_joint", left)}'
        f"{tags('right_joint', right)}<wheel_separation>{math.dist(a[:2], b[:2]) * float(factor)!r}</wheel_separation>"
        f"<wheel_radius>{a[2]!r}</wheel_radius>"
        "<max_acceleration>1</max_acceleration><min_acceleration>-1</min_acceleration></plugin>"
    )


def drive(sim: Any, name: str, entry: Entry) -> dict[str, Any]:
    """Drive straight, in place and in a circle; return what was asked and what was reached."""
    topic = entry.parameters[0] if entry.kind == "own" else f"/model/{name}/cmd_vel"
    sim.run(1.0)
    parts = {
        "straight": (SPEED, 0.0, 1.0 / SPEED),
        "circle": (SPEED, ARC, 2 * math.pi / ARC),
        "in place": (0.0, TURN, math.pi / TURN),
    }
    found = {}
    for part, (linear, angular, duration) in parts.items():
        poses = [planar_pose(sim, name)]
        for tick in range(round(duration / 0.1) + 10):
            moves = tick < round(duration / 0.1)
            sim.publish(topic, {"linear": {"x": linear * moves}, "angular": {"z": angular * moves}})
            sim.run(0.1)
            poses.append(planar_pose(sim, name))
        pairs = list(itertools.pairwise(poses))
        yaw = sum(math.remainder(b[2] - a[2], math.tau) for a, b in pairs)
        travel = sum(math.dist(a[:2], b[:2]) for a, b in pairs)
        asked = linear * duration, math.degrees(angular * duration)
        found[part] = {"asked": asked, "got": (travel, math.degrees(yaw))}
    return {"drive": found}


def planar_pose(sim: Any, name: str) -> tuple[float, float, float]:
    pose = sim.model(name).pose
    return float(pose.position[0]), float(pose.position[1]), float(pose.rpy[2])


def move(sim: Any, name: str, topic: str, loops: dict[str, Loop]) -> dict[str, Any]:
    """Send a trajectory to all joints; return the largest final error."""
    points = [{"positions": [loop.goal for loop in loops.values()], "time_from_start": {"sec": int(MOVE_TIME)}}]
    sim.model(name).set_joint_positions({joint: loop.begin for joint, loop in loops.items()})
    sim.run(0.1)
    sim.publish(topic, {"joint_names": list(loops), "points": points})
    sim.run(MOVE_TIME + 2.0)
    model = sim.model(name)
    errors = {joint: abs(float(model.joints[joint].position) - loop.goal) for joint, loop in loops.items()}
    worst = max(errors, key=errors.__getitem__)
    return {"joints": len(errors), "error": errors[worst], "worst": worst}


def picture(entry: Entry, file: Path) -> str:
    """Run the command of the page and keep its picture as a small image; return the problem if it fails."""
    import cv2

    with tempfile.TemporaryDirectory() as folder:
        png = Path(folder) / "picture.png"
        with controller_file(CONTROLLERS if "controllers.yaml" in entry.parameters else "") as parameters:
            options = [option for parameter in parameters for option in ("--params-file", parameter)]
            command = [sys.executable, "-m", "simkit", "run", str(file), *options]
            command += ["--duration", "0.1", "--picture", str(png), "-q"]
            done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        if done.returncode:
            return done.stderr.strip()[-600:]
        small = cv2.resize(cv2.imread(str(png)), (320, 200), interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(IMAGES / f"{entry.slug}.webp"), small, [cv2.IMWRITE_WEBP_QUALITY, 70])
    return ""


# ---------------------------------------------------------------------- the page


def motion(result: dict[str, Any]) -> str:
    """Return the text of what works, for one entry."""
    if "rate" in result:
        return counted(result["models"], "model")
    if "drive" in result:
        texts = []
        for part, r in sorted(result["drive"].items(), reverse=True):
            got, turned = r["got"]
            metres = f"{got:.2f} m, " if r["asked"][0] else ""
            texts.append(f"{part} {metres}{turned:.0f}°")
        return "; ".join(texts)
    if "error" not in result:
        return f"{result['joints']} joints"
    error = 1000 * result["error"]
    return f"{result['joints']} joints, error {f'{error:.2g}' if error > 0.01 else '< 0.01'}"


def write_page(results: dict[str, Any]) -> None:
    """Write the page from the results of all entries."""
    rows = {entry: results[entry.slug] for entry in entries() if entry.slug in results}
    lines = [
        HEAD.read_text().format(
            packages=", ".join(f"`{name}` {version}" for name, version in PACKAGES.items()),
            controllers=CONTROLLERS,
        )
    ]
    groups = {
        "Mobile robots": ("own", "diff"),
        "Arms and hands": ("arm",),
        "Legged robots": ("legs",),
        "Worlds": ("world",),
    }
    for title, kinds in groups.items():
        lines += [f"\n## {title}\n", "| | result |", "|---|---|"]
        for entry, result in rows.items():
            if entry.kind in kinds:
                text = motion(result)
                image = f"![](images/gallery/{entry.slug}.webp)"
                text += f"; {NOTES[entry.slug]}" if entry.slug in NOTES else ""
                cells = [image, f"**{entry.name}** `{entry.file}`: {text}"]
                lines.append(f"| {' | '.join(cells)} |")
    PAGE.write_text("\n".join(lines) + "\n")


NOTES = dict.fromkeys(("stretch_re1", "stretch_re2", "stretch_se3"), "the collisions of its wheels are cubes")
NOTES["abb_irb_140"] = "its file limits the efforts to 0"
NOTES["so_101"] = "its gripper does not reach the goal"
NOTES["turtlebot3_waffle"] = "some of its meshes were not in the folder"

HEAD = Path(__file__).with_name("gallery_head.txt")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="entries to measure; default: all")
    parser.add_argument("--files", type=Path, default=ROOT / "build" / "gallery", help="folder of packages and clones")
    parser.add_argument("--one", action="store_true", help="measure one entry and print it as JSON")
    arguments = parser.parse_args()
    chosen = [e for e in entries() if not arguments.names or e.name in arguments.names]
    if arguments.one:
        print(json.dumps(measure(chosen[0], file_of(chosen[0], arguments.files))))
        return
    IMAGES.mkdir(parents=True, exist_ok=True)
    arguments.files.mkdir(parents=True, exist_ok=True)
    if any(not entry.file.startswith("simkit/") for entry in chosen):
        unpack_packages(arguments.files)
    store = IMAGES / "results.json"
    results = json.loads(store.read_text()) if store.is_file() else {}
    for entry in chosen:
        file = file_of(entry, arguments.files)
        if not file.is_file():
            print(f"{entry.name}: {file} is missing; the entry is left out")
            continue
        command = [sys.executable, __file__, "--one", "--files", str(arguments.files), entry.name]
        answer = subprocess.run(command, capture_output=True, text=True, check=False)
        if answer.returncode:
            print(f"{entry.name}: {answer.stderr.strip()[-600:]}")
            continue
        problem = picture(entry, file)
        if problem:
            print(f"{entry.name}: {problem}")
            continue
        results[entry.slug] = json.loads(answer.stdout.splitlines()[-1])
        print(f"{entry.name}: {motion(results[entry.slug])}", flush=True)
        results = {e.slug: results[e.slug] for e in entries() if e.slug in results}
        store.write_text(json.dumps(results, indent=1, sort_keys=True) + "\n")
    write_page(results)


if __name__ == "__main__":
    main()
