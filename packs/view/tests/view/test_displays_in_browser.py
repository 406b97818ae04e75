"""Displays in a real browser: switched on by topic, drawn where they belong, removed again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import simkit
from packs.view.tests.view.conftest import YARD
from packs.view.tests.view.test_browser import TIMEOUT, Session, browser, session  # noqa: F401 - fixtures
from packs.view.tests.view.test_displays import MAP, marker, points
from simkit.recording import Recorder
from simkit.recording.bags.reader import open_bag_to_read
from simkit_view.view.bag_recording import make_recording
from simkit_view.view.html_file import html_file
from simkit_view.view.scene_packet import make_scene_packet

pytestmark = pytest.mark.browser


def test_a_topic_is_drawn_while_its_box_is_checked(session: Callable[..., Session]) -> None:  # noqa: F811
    found = session()
    sim = found.sim
    path = [{"pose": {"position": {"x": -1 + 0.1 * i, "y": 0.05 * i * i}, "orientation": {"w": 1.0}}} for i in range(9)]
    corners = points(*((0.2 * i, -1.0, 0.3 * (i % 2)) for i in range(6)))
    yellow = {"r": 1.0, "g": 0.8, "b": 0.1, "a": 1.0}
    markers = [marker(k, k, points=corners[: 2 if k == 0 else 6], color=yellow, text="station") for k in (0, 4, 8, 11)]
    markers += [marker(k, k, pose=_pose(-1.5 + 0.4 * k, 1.0, 0.2)) for k in (1, 2, 3)]
    sign = marker(9, 9, pose=_pose(-1.5, -1.0, 0.6), text="station", scale={"z": 0.2})
    cells = [0] * 20 + [100] * 20 + [-1] * 20 + list(range(0, 100, 5)) + [99] * 20
    grid = {"resolution": 0.1, "width": 20, "height": 5, "origin": _pose(-2.5, -2.5, 0.0)}
    for topic, type_name, message in (
        ("/plan", "nav_msgs/msg/Path", {"header": MAP, "poses": path}),
        ("/markers", "visualization_msgs/msg/MarkerArray", {"markers": [*markers, sign]}),
        ("/map", "nav_msgs/msg/OccupancyGrid", {"header": MAP, "info": grid, "data": cells}),
        ("/costmap", "nav_msgs/msg/OccupancyGrid", {"header": MAP, "info": {**grid, "width": 10}, "data": cells[:50]}),
        ("/particles", "geometry_msgs/msg/PoseArray", {"header": MAP, "poses": [_pose(0.2, 1.5, 0.0)] * 3}),
        ("/goal", "geometry_msgs/msg/PoseStamped", {"header": MAP, "pose": _pose(1.0, 1.5, 0.0)}),
        ("/lost", "geometry_msgs/msg/PoseStamped", {"header": {"frame_id": "nowhere"}, "pose": _pose(0, 0, 0)}),
    ):
        sim.advertise(topic, type_name, latched=True).publish(message)
    for topic in ("/plan", "/markers", "/map", "/particles", "/goal", "/lost"):
        found.page.locator(f"[id='display-{topic}']").check()
        found.until(f"app.displays.shown.has('{topic}')")
    children = "app.displays.shown.get('/%s').root.children[0].children.map(found => found.type).sort().join()"
    assert found.get(children % "map") == "Mesh"
    assert found.get(children % "markers").endswith("Mesh,Mesh,Mesh,Points,Sprite")
    found.page.locator(".problem", has_text="the frame 'nowhere' is unknown").wait_for(timeout=TIMEOUT)
    found.until("app.stage.draws > 3")
    found.picture("view_displays")
    found.do(lambda: sim.spawn(SPHERE))
    found.until("app.models.has('ball') && app.displays.shown.has('/plan')")
    found.page.locator("[id='display-/map']").uncheck()
    found.until("!app.displays.shown.has('/map')")
    found.until_here(lambda: not sim.communication.bus.wanted("/map"))
    assert found.errors == []


SPHERE = """<sdf version="1.9"><model name="ball"><pose>4 4 1 0 0 0</pose><link name="l"><visual name="v"><geometry>
<sphere><radius>0.1</radius></sphere></geometry></visual></link></model></sdf>"""


def _pose(x: float, y: float, z: float) -> dict[str, Any]:
    return {"position": {"x": x, "y": y, "z": z}, "orientation": {"w": 1.0}}


def test_a_recording_plays_its_displays(browser: Any, tmp_path: Path) -> None:  # noqa: F811
    with simkit.load(YARD) as sim, Recorder(sim, tmp_path / "a.mcap"):
        markers = sim.advertise("/m", "visualization_msgs/msg/Marker")
        sim.run(1.0)
        markers.publish(marker(1))
        sim.run(1.0)
    with open_bag_to_read(tmp_path / "a.mcap") as bag, simkit.load(YARD) as sim:
        recording = make_recording(sim, bag)
        text = html_file("a", make_scene_packet(sim, 1, {"recording": True, "seed": 0}), recording)
    (tmp_path / "a.html").write_text(text, encoding="utf-8")
    page = browser.new_page()
    page.goto((tmp_path / "a.html").as_uri())
    page.locator("#seek").wait_for(timeout=TIMEOUT)
    page.locator("[id='display-/m']").check()
    number = "simkitView.displays.shown.get('/m').root.children.length"
    page.wait_for_function("simkitView.displays.shown.has('/m')", timeout=TIMEOUT)
    assert page.evaluate(number) == 0
    page.locator("#seek").fill("1.5")
    page.wait_for_function(f"{number} === 1", timeout=TIMEOUT)
    page.locator("#seek").fill("0.2")
    page.wait_for_function(f"{number} === 0", timeout=TIMEOUT)
    page.close()
