"""Small intact inputs of every kind, which simkit makes itself, and the commands and readers that open them."""

from __future__ import annotations

import contextlib
import os
import struct
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import simkit

Files = Mapping[str, bytes]
INPUTS = Path(__file__).with_name("inputs")


def intact(name: str) -> bytes:
    """Return a file of the folder `inputs`."""
    return (INPUTS / name).read_bytes()


WORLD_FILES: Files = {name: intact(name) for name in ("w.sdf", "ball.sdf")}
COMMANDS = intact("commands.txt").decode().splitlines()


@dataclass(frozen=True)
class Target:
    """Files of one kind and the ways to open them.

    Attributes:
        kind: name of the kind.
        files: path -> content.
        broken: paths of the files that mutations change.
        commands: command lines; `*` before one of them: a reader of the worker instead of a command.
    """

    kind: str
    files: Files
    broken: tuple[str, ...]
    commands: tuple[tuple[str, ...], ...]


@cache
def targets() -> tuple[Target, ...]:
    """All kinds; the bags, bundles and golden runs are recorded anew."""
    made = recorded()
    run, arm = ("run", "w.sdf", "--duration", "0.05"), {name: intact(name) for name in ("arm.urdf", "controllers.yaml")}
    scenario, golden = intact("scenario.yaml"), {n: c for n, c in made.items() if n.startswith("golden/")}
    return (
        *bag_targets(made),
        Target(
            "script",
            {**WORLD_FILES, "s.yaml": intact("script.yaml")},
            ("s.yaml",),
            ((*run, "--script", "s.yaml"), ("*script", "s.yaml")),
        ),
        Target(
            "parameters",
            {**arm, "p.yaml": arm["controllers.yaml"]},
            ("p.yaml", "controllers.yaml"),
            (
                ("run", "arm.urdf", "--duration", "0.05", "--params-file", "p.yaml"),
                ("check", "arm.urdf"),
                ("*world", "arm.urdf"),
            ),
        ),
        Target(
            "motions",
            {**arm, "m.yaml": intact("motions.yaml")},
            ("m.yaml",),
            (
                ("motion", "list", "--motions", "m.yaml", "arm.urdf"),
                *(("*motions", "m.yaml"),) * 10,
                ("motion", "play", "bow", "--world", "arm.urdf", "--motions", "m.yaml", "--skip-planning"),
            ),
        ),
        Target(
            "scenario",
            {**WORLD_FILES, "s.yaml": scenario},
            ("s.yaml",),
            (("*scenario", "s.yaml"),) * 20
            + (("*scenario_run", "s.yaml"),) * 2
            + (
                ("golden", "record", "s.yaml", "-o", "new"),
                ("bundle", "s.yaml", "-o", "new.zip"),
                ("plot", "s.yaml", "/odom.pose.pose.position.x", "-o", "new.svg"),
            ),
        ),
        Target(
            "exercise",
            {**WORLD_FILES, "e.yaml": scenario + intact("exercise.yaml"), "drive.py": intact("drive.py")},
            ("e.yaml",),
            (("*exercise", "e.yaml"),) * 150 + (("*exercise_run", "e.yaml"),) * 10 + (("grade", "e.yaml", "drive.py"),),
        ),
        Target(
            "bundle",
            {"b.zip": made["b.zip"]},
            ("b.zip",),
            (("*bundle", "b.zip"),) * 8
            + (
                ("replay", "b.zip"),
                ("replay", "b.zip", "--json"),
                ("replay", "b.zip", "--list"),
                ("replay", "b.zip", "--extract", "new"),
                ("replay", "b.zip", "--record", "new.mcap"),
            ),
        ),
        Target(
            "bundle with code",
            {"c.zip": made["c.zip"]},
            ("c.zip",),
            (("replay", "c.zip"), ("replay", "c.zip", "--list")),
        ),
        Target(
            "golden",
            {**WORLD_FILES, "s.yaml": scenario, **golden},
            tuple(golden),
            (("*golden", "golden"),) * 12
            + (
                ("golden", "check", "golden", "--no-causes"),
                ("golden", "check", "golden", "--json"),
                ("golden", "check", "golden", "--html", "new.html", "--junit", "new.xml"),
            ),
        ),
        Target("packets", {"p.bin": packets()}, ("p.bin",), (("*packets", "p.bin"),)),
        Target(
            "condition",
            {**WORLD_FILES, "c.lines": intact("conditions.lines")},
            ("c.lines",),
            (("*condition", "c.lines"),),
        ),
        *(
            Target(
                "command",
                {**WORLD_FILES, "b.mcap": made["b.mcap"], "a.txt": "\n".join(line.split()).encode()},
                ("a.txt",),
                (("*command", "a.txt"),),
            )
            for line in COMMANDS
        ),
    )


def packets() -> bytes:
    """Packets of ArduPilot with 16 and 32 channels, and frames of PX4."""
    from simkit_water_and_air.plugins.autopilots.mavlink import encode

    servo = struct.pack("<HHI16H", 18458, 400, 1, *[1500] * 16) + struct.pack("<HHI32H", 29569, 400, 2, *[1500] * 32)
    names = ("HEARTBEAT", "HIL_SENSOR", "HIL_GPS", "HIL_STATE_QUATERNION", "HIL_ACTUATOR_CONTROLS")
    fields = {"time_usec": 1234567, "controls": (0.5,) * 16, "mode": 129, "xacc": 1.0, "lat": 473977420}
    return servo + b"".join(encode(name, fields, number) for number, name in enumerate(names)) * 3


def bag_targets(made: Files) -> tuple[Target, ...]:
    """Bags as files and folders of rosbag2, with both of its storages."""

    def commands(bag: str) -> tuple[tuple[str, ...], ...]:
        of_bag = ("--bag", bag)
        return (
            ("*bag", bag),
            ("*bag", bag),
            ("bag", "info", bag),
            ("bag", "info", bag, "--json"),
            ("bag", "info", bag, "-t"),
            ("bag", "recover", bag, "new.mcap"),
            ("bag", "recover", bag, "new"),
            ("bag", "export", bag, "-o", "new"),
            ("bag", "export", bag, "-o", "new", "--format", "npz", "--images", "npz", "--clouds", "ply"),
            ("topic", "list", *of_bag),
            ("topic", "list", "-t", *of_bag),
            ("topic", "hz", "/imu", *of_bag),
            ("topic", "echo", "/imu", *of_bag),
            ("topic", "echo", "/image", *of_bag, "--json"),
            ("topic", "info", "/imu", *of_bag),
            ("tf", "tree", *of_bag),
            ("plot", bag, "/odom.pose.pose.position.x", "-o", "new.svg"),
            ("run", "w.sdf", "--duration", "0.02", "--play", bag),
        )

    file = {**WORLD_FILES, "b.mcap": made["b.mcap"]}
    folder = {n: c for n, c in made.items() if n.startswith("bag/")}
    sqlite = {n: c for n, c in made.items() if n.startswith("sqlite/")}
    return (
        Target("bag", file, ("b.mcap",), commands("b.mcap")),
        Target("bag folder", {**WORLD_FILES, **folder}, ("bag/metadata.yaml",), commands("bag")),
        Target("sqlite bag", {**WORLD_FILES, **sqlite}, tuple(sqlite), commands("sqlite")),
    )


@cache
def recorded() -> dict[str, bytes]:
    """Record a bag in each layout, two bundles and a golden run of the rover."""
    with tempfile.TemporaryDirectory(prefix="simkit_fuzz_inputs_") as name:
        folder = Path(name)
        for path, content in {
            **WORLD_FILES,
            "s.yaml": intact("scenario.yaml"),
            "script.yaml": intact("script.yaml"),
        }.items():
            (folder / path).write_bytes(content)
        short = ("w.sdf", "--duration", "0.12")
        _simkit(folder, "run", *short, "--script", "script.yaml", "--record", "run.mcap")
        _simkit(folder, "bundle", *short, "--script", "script.yaml", "-o", "b.zip")
        _simkit(folder, "golden", "record", "s.yaml", "-o", "golden")
        (folder / "p").mkdir()
        (folder / "p" / "canary.py").write_bytes(intact("drive.py"))
        with_plugin = b'<plugin filename="canary.py" name="Drive"/></model>'
        coded = intact("w.sdf").replace(b"</model>", with_plugin, 1)
        (folder / "coded.sdf").write_bytes(coded)
        _simkit(folder, "bundle", "coded.sdf", "--duration", "0.02", "--plugin-path", "p", "-o", "c.zip")
        _write_bags(folder)
        found = [
            p
            for p in folder.rglob("*")
            if p.is_file() and p.relative_to(folder).parts[0] in ("golden", "bag", "sqlite")
        ]
        found += [folder / n for n in ("b.mcap", "b.zip", "c.zip")]
        assert any(n.startswith("code/") for n in zipfile.ZipFile(folder / "c.zip").namelist())
        return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(found)}


def _write_bags(folder: Path) -> None:
    """Write the messages of the recorded run, an image, a point cloud and a type of another package in each layout."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    from simkit import msgs
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.recording.bags.writer import McapBag, Rosbag2Folder

    with open_bag_to_read(folder / "run.mcap") as bag:
        messages = [(m.topic, m.type_name, m.data, m.time_ns) for m in bag.messages()][:40]
    field = {"name": "x", "offset": 0, "datatype": 7, "count": 1}
    pictures = {
        "/image": ("sensor_msgs/msg/Image", {"height": 2, "width": 2, "encoding": "rgb8", "step": 6, "data": [7] * 12}),
        "/cloud": (
            "sensor_msgs/msg/PointCloud2",
            {
                "height": 1,
                "width": 3,
                "point_step": 12,
                "row_step": 36,
                "is_dense": True,
                "data": [0] * 36,
                "fields": [{**field, "name": n, "offset": 4 * i} for i, n in enumerate("xyz")],
            },
        ),
        "/jpeg": ("sensor_msgs/msg/CompressedImage", {"format": "jpeg", "data": list(b"\xff\xd8\xff")}),
    }
    for topic, (type_name, values) in pictures.items():
        messages.append((topic, type_name, msgs.serialize(msgs.from_dict([type_name], values)), 10**8))
    for made in (McapBag(folder / "b.mcap"), Rosbag2Folder(folder / "bag")):
        for topic, type_name, data, time_ns in messages:
            made.write_raw(made.channel(topic, type_name, topic == "/tf_static"), data, time_ns)
        made.close()
    store = get_typestore(Stores.ROS2_HUMBLE)
    with Writer(folder / "sqlite", version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        known = {}
        for topic, type_name, data, time_ns in messages:
            if type_name in store.types:
                known.setdefault(topic, None)
                known[topic] = known[topic] or writer.add_connection(topic, type_name, typestore=store)
                writer.write(known[topic], time_ns, data)


def _simkit(folder: Path, *arguments: str) -> None:
    """Run a command in a folder; an error fails the test."""
    from typer.testing import CliRunner

    from simkit.cli import app

    with contextlib.chdir(folder):
        done = CliRunner().invoke(app, list(arguments))
    assert done.exit_code == 0, f"{arguments}: {done.output}{done.exception!r}"


def environment() -> dict[str, str]:
    """Environment of a child process that imports the same simkit."""
    return {**os.environ, "PYTHONPATH": str(Path(simkit.__file__).resolve().parents[1])}
