"""Lab 3: the solar sensor of the solution against pvlib, the README's terminals with `--watch`, and the picture."""

from __future__ import annotations

import math
import shutil
import tempfile
from contextlib import ExitStack
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
import pytest

import simkit
from simkit.sensors.cameras.overview_image import render_view
from tests.cli.course_page import Desk, blocks

LAB = Path(__file__).parents[2] / "labs" / "03_gazebo"
README = (LAB / "README.md").read_text("utf-8")
PLACE = (43.56, 1.48, 150.0)  # latitude, longitude [deg], elevation [m] of solar.world
SCALE = 14400.0  # seconds of the sun's time per simulated second: a step of 0.1 s is 24 min
DAYS = {"June": "2026-06-21T04:00:00Z", "September": "2026-09-23T05:40:00Z", "December": "2026-12-21T07:12:00Z"}
LENGTHS = {"June": 3.9, "September": 3.0, "December": 2.3}  # [s]
COLOURS = {"June": (40, 90, 220), "September": (60, 150, 60), "December": (200, 110, 40)}  # blue, green, red


@pytest.fixture
def solved(tmp_path: Path) -> Path:
    folder = tmp_path / "lab"
    shutil.copytree(LAB, folder, ignore=shutil.ignore_patterns("solution", "__pycache__"))
    shutil.copytree(LAB / "solution", folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


def opened(folder: Path, **more: Any) -> simkit.Simulation:
    return simkit.load(folder / "worlds" / "solar.world", plugin_paths=[folder / "plugins", folder], **more)


def day(folder: Path, name: str) -> npt.NDArray[np.float64]:
    """Drive on a circle for a day; rows of hour since the start, and measured azimuth and elevation [deg]."""
    overrides = [f"sun.start={DAYS[name]}", f"sun.time_scale={SCALE}", "solar_waffle::solar_sensor.gaussian_noise=0"]
    rows = []
    with opened(folder, overrides=overrides) as sim:

        def take(message: Any) -> None:
            q = message.orientation
            seen = simkit.Pose(quaternion=(q.w, q.x, q.y, q.z)).rotate((1.0, 0.0, 0.0))
            east, north, up = sim.link("solar_waffle::base_solar_sensor").pose.rotate(seen)
            azimuth = math.degrees(math.atan2(east, north)) % 360.0
            rows.append((sim.time * SCALE / 3600.0, azimuth, math.degrees(math.asin(up))))

        sim.subscribe("/sunloin_imu", take)
        sim.publish("/cmd_vel", {"linear": {"x": 0.1}, "angular": {"z": 1.2}})
        sim.run(LENGTHS[name])
    return np.array(rows)


def true_sun(name: str, hours: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return azimuth and apparent elevation [deg] of NREL's algorithm in pvlib."""
    pandas, pvlib = pytest.importorskip("pandas"), pytest.importorskip("pvlib")
    start = datetime.fromisoformat(DAYS[name].replace("Z", "+00:00"))
    times = pandas.DatetimeIndex([start + timedelta(hours=float(hour)) for hour in hours])
    latitude, longitude, elevation = PLACE
    pressure = pvlib.atmosphere.alt2pres(elevation)
    found = pvlib.solarposition.spa_python(times, latitude, longitude, elevation, pressure, 12.0)
    return np.stack([found["azimuth"], found["apparent_elevation"]], axis=1)


def unit_vectors(angles: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    azimuth, elevation = np.radians(angles).T
    return np.stack(
        [np.cos(elevation) * np.sin(azimuth), np.cos(elevation) * np.cos(azimuth), np.sin(elevation)], axis=1
    )


def sky(days: dict[str, tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]], size: int) -> npt.NDArray[np.uint8]:
    """Draw the sky as a disc, north above and east on the right: true paths as lines, measurements as dots."""
    scale, radius = 4, size * 0.40
    image = np.full((scale * size, scale * size, 3), 255, np.uint8)
    middle = scale * size // 2

    def point(azimuth: float, elevation: float) -> tuple[int, int]:
        r = scale * radius * (90.0 - elevation) / 90.0
        a = math.radians(azimuth)
        return round(middle + r * math.sin(a)), round(middle - r * math.cos(a))

    for elevation in (0, 30, 60):
        cv2.circle(image, (middle, middle), round(scale * radius * (90 - elevation) / 90), (200, 200, 200), scale)
    for azimuth, letter in ((0, "N"), (90, "E"), (180, "S"), (270, "W")):
        cv2.line(image, (middle, middle), point(azimuth, 0), (225, 225, 225), scale)
        x, y = point(azimuth, -12)
        cv2.putText(image, letter, (x - 36, y + 36), cv2.FONT_HERSHEY_SIMPLEX, 0.8 * scale, (60, 60, 60), 2 * scale)
    for line, (name, (truth, measured)) in enumerate(days.items()):
        path = np.array([point(*row) for row in truth], np.int32)
        cv2.polylines(image, [path], False, COLOURS[name], scale, cv2.LINE_AA)
        for row in measured:
            cv2.circle(image, point(*row), 4 * scale, COLOURS[name], -1, cv2.LINE_AA)
        place = (scale * 12, scale * (24 + 22 * line))
        cv2.putText(
            image, name, place, cv2.FONT_HERSHEY_SIMPLEX, 0.55 * scale, COLOURS[name], round(1.5 * scale), cv2.LINE_AA
        )
    return np.asarray(cv2.resize(image, (size, size), interpolation=cv2.INTER_AREA), np.uint8)


@pytest.mark.labs
def test_the_sensor_of_the_solution_agrees_with_pvlib_and_is_in_the_picture(solved: Path, tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    days = {}
    for name in DAYS:
        rows = day(solved, name)
        truth = true_sun(name, rows[:, 0])
        is_up = truth[:, 1] > 0.5
        assert is_up.sum() > 15
        cosines = np.sum(unit_vectors(truth) * unit_vectors(rows[:, 1:]), axis=1)
        errors = np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))[is_up]
        assert errors.max() < 0.1, (name, errors.max())
        days[name] = truth[is_up], rows[is_up, 1:]
    with opened(solved) as sim:
        sim.run(0.5)
        x, y, z = sim.link("solar_waffle::base_solar_sensor").pose.position
        robot = render_view(
            sim, 420, 420, eye=(x - 0.35, y + 0.30, z + 0.25), target=(x + 0.08, y - 0.04, z - 0.03), passes=8
        )
    picture = np.hstack([np.asarray(robot)[:, :, ::-1], sky(days, 420)])
    cv2.imwrite(str(tmp_path / "solar.png"), picture)
    shown = cv2.imread(str(LAB / "solar.png"))
    assert shown is not None and shown.shape == picture.shape, tmp_path / "solar.png"
    difference = np.abs(shown.astype(float) - picture)
    assert difference[:, 420:].mean() < 0.5, tmp_path / "solar.png"  # a dot moved by its radius is more than 0.5
    assert difference[:, :420].mean() < 5.0, tmp_path / "solar.png"  # renderers differ in shadows and edges


GREETING = 'params.text("greeting", "Hello World!")'
SAVED = README.index("simkit has called `load` of the new class")
EDITED = README.index("hello_world.py: 'gazebo_tutorials' reloaded")
EDITED = README.rindex("Change the text", 0, EDITED)
CHECKS = """
The edited text is in the log. Terminal 2:

```console title="Terminal 2"
$ simkit log --node /gazebo_tutorials --timeout 1 --filter "and again"
[INFO] [12.345000000] [gazebo_tutorials]: Hello World, from hello.world! and again
```
"""


@pytest.mark.labs
def test_an_edit_is_reloaded_in_the_terminals_of_the_readme(solved: Path) -> None:
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as sockets, ExitStack() as stack:
        desk = Desk(solved, stack, {"TMPDIR": sockets, "XDG_RUNTIME_DIR": sockets})
        desk.play(README[:EDITED])
        file = solved / "plugins" / "hello_world.py"
        text = file.read_text("utf-8")
        assert text.count(GREETING) == 1
        file.write_text(text.replace(GREETING, f"{GREETING} + ' and again'"), "utf-8")
        desk.play(README[EDITED:SAVED])
        desk.play(CHECKS)
        desk.play(README[SAVED:])
        desk.finish()


TUTORIAL = """<sdf version="1.4"><world name="default">
<include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>
<plugin name="gazebo_tutorials" filename="libgazebo_tutorials.so"/></world></sdf>"""


@pytest.mark.labs
def test_a_world_of_the_tutorial_runs_with_the_plugin(solved: Path) -> None:
    with simkit.load(TUTORIAL, plugin_paths=[solved / "plugins"]) as sim:
        log = sim.subscribe("/rosout")
        sim.step()
        assert [message.name for message in log.messages if message.msg == "Hello World!"] == ["gazebo_tutorials"]
        assert [d for d in sim.diagnostics if d.severity != "note"] == []


def inlined(folder: Path) -> Path:
    """Write a world that contains the model's text in the place of its <include>; return its file."""
    world = (folder / "worlds" / "solar.world").read_text("utf-8")
    model = (folder / "models" / "solar_waffle" / "model.sdf").read_text("utf-8")
    element = model[model.index("<model ") : model.index("</sdf>")]
    start = world.rindex("<include>", 0, world.index("model://solar_waffle"))
    end = world.index("</include>", start) + len("</include>")
    placed = element.replace(">", "><pose>-2.0 -0.5 0.01 0 0 0</pose>", 1)
    text = (world[:start] + placed + world[end:]).replace('<sdf version="1.6"', '<sdf version="1.9"', 1)
    file = folder / "worlds" / "inlined.world"
    file.write_text(text, "utf-8")
    return file


@pytest.mark.labs
def test_a_world_with_the_model_inlined_measures_the_same_bits(solved: Path) -> None:
    found = []
    for world in (solved / "worlds" / "solar.world", inlined(solved)):
        with simkit.load(world, plugin_paths=[solved / "plugins", solved]) as sim:
            readings = sim.subscribe("/sunloin_imu")
            sim.publish("/cmd_vel", {"linear": {"x": 0.1}, "angular": {"z": 1.2}})
            sim.run(1.0)
            found.append([(m.orientation.x, m.orientation.y, m.orientation.z) for m in readings.messages])
            assert [d for d in sim.diagnostics if d.severity != "note"] == []
    assert len(found[0]) == 10
    assert found[0] == found[1]


def test_each_block_of_the_readme_has_its_terminal_in_the_paragraph_before() -> None:
    found = blocks(README)
    assert len(found) == 5
    assert all(block.kind == "console" and block.paragraph.endswith(f"{block.title}:") for block in found)
