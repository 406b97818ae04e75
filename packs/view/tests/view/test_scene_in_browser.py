"""The scene in a real browser: reset, selection, viewpoints, floors, names of frames and the quality of the drawing."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import simkit
from packs.view.tests.view.conftest import YARD
from packs.view.tests.view.test_browser import Session, browser, session  # noqa: F401 - fixtures

pytestmark = pytest.mark.browser
Open = Callable[..., Session]

SLIDE = """<sdf version="1.9"><model name="slide"><pose>-2 1 0.1 0 0 0</pose>
<link name="rail"><inertial><mass>5</mass></inertial>
<visual name="v"><geometry><box><size>0.5 0.1 0.1</size></box></geometry></visual></link>
<link name="car"><pose>0 0 0.1 0 0 0</pose><inertial><mass>0.1</mass></inertial></link>
<joint name="travel" type="prismatic"><parent>rail</parent><child>car</child>
<axis><xyz>1 0 0</xyz><limit><lower>-0.2</lower><upper>0.2</upper></limit></axis></joint></model></sdf>"""
ODOMETRY = """<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
<odom_topic>/odom</odom_topic><odom_frame>world</odom_frame><odom_publish_frequency>50</odom_publish_frequency></plugin></model></world>"""


def test_a_reset_while_paused_clears_scans_and_arrows_and_fills_the_joints(session: Open) -> None:  # noqa: F811
    found = session(YARD.replace("</model></world>", ODOMETRY))
    found.get("app.displays.set('/odom', true)")
    found.page.evaluate("simkitView.send('drive', {topic: '/cmd_vel', ahead: 0.3, turn: 0.3})")
    found.do(lambda: found.sim.spawn(SLIDE))
    found.until("app.models.has('slide') && document.querySelectorAll('[data-joint]').length === 2")
    arrows = """(() => { let n = 0;
      app.displays.shown.get('/odom')?.root.traverse(o => { n += o.count ?? 0; }); return n; })()"""
    found.until(f"{arrows} > 2 && app.sensors.fan.geometry.attributes.position?.count > 2")
    found.page.locator("#play").click()
    found.until("app.state.paused")

    found.page.locator("#reset").click()
    found.until("app.state.tick === 0 && !app.models.has('slide')")
    found.until("app.sensors.fan.geometry.attributes.position.count === 0")
    found.until(f"app.sensors.points.geometry.attributes.position.count === 0 && {arrows} === 0")
    texts = "[...document.querySelectorAll('#joints output')].map(box => box.textContent)"
    found.until(f"{texts}.join() === '0.0°'")
    assert found.get("[...app.layers.paths.values()].map(path => path.points.length > 1)").count(True) == 0
    assert found.errors == []
    found.picture("reset")


def test_a_click_on_the_name_of_a_model_selects_it_and_flies_to_it(session: Open) -> None:  # noqa: F811
    found = session(paused=True)
    found.until("app.stage.draws > 1 && app.state")
    before = found.get("app.stage.camera.position.toArray()")
    found.page.locator("[data-model='stone']").click()
    assert found.get("app.selected") == "stone"
    assert found.page.locator("[data-model='stone'].selected").count() == 1
    assert found.page.evaluate(YELLOW) > 20  # the outline
    assert "pose of l" in found.page.locator("#selection").inner_text()  # its first link
    assert "stone" in found.page.locator("#edited").inner_text()  # the model that the buttons move and delete
    found.until("app.views.flight === null")
    assert found.get("app.stage.controls.target.toArray()") == pytest.approx([-1.0, 0.0, 0.05], abs=0.01)
    assert found.get("app.stage.camera.position.toArray()") != pytest.approx(before, abs=0.5)
    size = """(() => { const box = app.world.boxOf(geom => app.world.modelOf(geom) === 'stone'), c = app.stage.camera;
      return Math.abs(box.max.clone().project(c).y - box.min.clone().project(c).y); })()"""
    assert 0.2 < found.get(size) < 1.5  # of 2, the height of the picture
    assert found.get("app.world.modelOf(app.pickAt(...CENTRE).geom)".replace("CENTRE", CENTRE)) == "stone"
    assert found.errors == []
    found.picture("fly")


PIXELS = """const app = window.simkitView, c = document.createElement('canvas'), s = app.stage.canvas;
  c.width = s.width; c.height = s.height; app.stage.draw(); c.getContext('2d').drawImage(s, 0, 0);
  const { data } = c.getContext('2d').getImageData(0, 0, c.width, c.height);"""
YELLOW = f"""(() => {{ {PIXELS} let n = 0;
  for (let i = 0; i < data.length; i += 4) n += data[i] > 180 && data[i + 1] > 140 && data[i + 2] < 130;
  return n; }})()"""
COLOURS = f"""(() => {{ {PIXELS} const found = new Set();
  for (let i = 0; i < data.length; i += 4) found.add(data[i] * 65536 + data[i + 1] * 256 + data[i + 2]);
  return found.size; }})()"""
CENTRE = """(() => { const b = app.stage.canvas.getBoundingClientRect();
  return [b.left + b.width / 2, b.top + b.height / 2]; })()"""


def wall(name: str, place: str, size: str) -> str:
    return f"""<model name="{name}"><static>true</static><pose>{place} 0 0 0</pose><link name="l">
    <visual name="v"><geometry><box><size>{size}</size></box></geometry></visual></link></model>"""


CORRIDOR = YARD.replace(
    '<model name="wall">',
    wall("left", "0 0.6 1", "12 0.1 2") + wall("right", "0 -0.6 1", "12 0.1 2") + '<model name="wall">',
)
SEEN = """(() => { const app = window.simkitView, { camera, controls } = app.stage;
  const from = controls.target, way = camera.position.clone().sub(from), reach = way.length();
  return app.world.sight(from, way.normalize(), reach, 'rover') >= reach; })()"""


def test_a_camera_that_follows_comes_closer_or_rises_where_a_wall_would_hide_the_robot(session: Open) -> None:  # noqa: F811
    found = session(CORRIDOR)
    found.until("app.stage.draws > 1 && app.state?.tick > 0")
    found.get("app.stage.camera.position.set(-2, -2, 1.8)")  # the wall on the right is between
    found.get("app.views.follow(app.bodyOf.get('rover'))")
    found.get("app.stage.draw()")
    assert found.page.evaluate(SEEN)
    near = "app.stage.camera.position.distanceTo(app.stage.controls.target)"
    assert found.get(near) < found.get("app.views.wanted.length()")  # a corridor of 1.1 m leaves no room for it
    hidden = """(() => { const d = app.views.wanted, reach = d.length();
      return app.world.sight(app.stage.controls.target, d.clone().normalize(), reach, 'rover') < reach; })()"""
    assert found.get(hidden)
    found.page.evaluate("simkitView.send('drive', {topic: '/cmd_vel', ahead: 0.5, turn: 0.2})")
    for place in (0.2, 0.4, 0.6):
        found.until(f"app.world.bodies[app.bodyOf.get('rover')].elements[12] > {place}")
        found.get("app.stage.draw()")
        assert found.page.evaluate(SEEN)
    found.picture("follow_in_corridor")
    found.do(lambda: found.sim.model("rover").set_pose(simkit.Pose((0.0, 3.0, 0.1))))
    found.until("app.world.bodies[app.bodyOf.get('rover')].elements[13] > 2")
    found.get("app.stage.draw()")
    assert found.page.evaluate(SEEN)
    assert found.errors == []


def test_the_orbit_ends_at_the_floor(session: Open) -> None:  # noqa: F811
    found = session(paused=True)
    found.until("app.stage.draws > 1 && app.state")
    found.get("(app.lowest = 1e9, 1)")
    found.get("app.stage.after.push(() => { app.lowest = Math.min(app.lowest, app.stage.camera.position.z); })")
    box = found.page.locator("#canvas").bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    start = found.get("app.stage.camera.position.z")
    for button in ("left", "right", "left"):  # turn below the floor, move what is looked at below it, turn again
        found.page.mouse.move(*middle)
        found.page.mouse.down(button=button)
        found.page.mouse.move(middle[0], box["y"] + 5, steps=6)
        found.page.mouse.up(button=button)
    for _ in range(8):
        found.page.mouse.wheel(0, -400)
    found.until("app.stage.isFull")  # nothing moves any more
    assert start > 1.0
    assert 0.0 < found.get("app.lowest") < 0.2  # it went down, and ended above the floor
    assert found.get("app.stage.controls.target.z") >= -1e-6
    assert found.errors == []
    found.picture("orbit_at_floor")


HILL = """<sdf version="1.9"><world name="w"><model name="hill"><static>true</static><link name="l"><visual name="v">
<geometry><heightmap><uri>hill.png</uri><size>40 40 5</size></heightmap></geometry></visual></link></model>
<model name="cart"><static>true</static><pose>8 0 3 0 0 0</pose><link name="l"><visual name="v">
<geometry><box><size>1 1 1</size></box></geometry></visual></link></model></world></sdf>"""


def test_the_orbit_ends_at_terrain(session: Open, tmp_path: Path) -> None:  # noqa: F811
    across = np.linspace(-1, 1, 65)
    heights = np.exp(-4 * (across[:, None] ** 2 + across[None, :] ** 2))  # 5 m high in the middle
    cv2.imwrite(str(tmp_path / "hill.png"), (255 * heights).astype(np.uint8))
    (tmp_path / "hill.sdf").write_text(HILL)
    found = session(str(tmp_path / "hill.sdf"), paused=True)
    found.until("app.stage.draws > 1 && app.state")
    found.get("(app.stage.controls.target.set(8, 0, 3), app.stage.camera.position.set(2, 0, 1), app.stage.draw())")
    found.get("app.stage.draw()")
    x, y, z = found.get("app.stage.camera.position.toArray()")
    assert z > 5 * np.exp(-4 * ((x / 20) ** 2 + (y / 20) ** 2))
    assert found.get("app.stage.controls.target.toArray()") == pytest.approx([8, 0, 3], abs=0.1)


ROBOT = """<robot name="cart"><link name="base">
<visual><origin xyz="0 0 -0.2"/><geometry><box size="1 0.6 0.2"/></geometry></visual>
<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""


def test_a_robot_without_a_world_has_a_floor_that_only_the_page_draws(session: Open) -> None:  # noqa: F811
    bare = session(ROBOT, paused=True)
    bare.until("app.stage.draws > 1 && app.state")
    assert bare.get("[app.layers.floor.visible, app.layers.grid.visible]") == [True, True]
    assert bare.get("app.layers.floor.position.z") == pytest.approx(-0.3, abs=1e-4)  # where the robot stands
    assert bare.get("app.layers.floor.parent === app.stage.helpers")  # which cameras do not see
    assert bare.sim.mj_model.ngeom == 1
    bare.page.locator("#show-grid").uncheck()
    assert bare.get("app.layers.floor.visible") is False
    bare.page.locator("#show-grid").check()
    bare.until("app.stage.isFull")
    bare.picture("bare_robot")
    in_world = session(paused=True)
    in_world.until("app.stage.draws > 1")
    assert in_world.get("app.layers.floor.visible") is False
    assert bare.errors == [] and in_world.errors == []


def test_what_is_at_rest_is_drawn_in_full_and_what_moves_is_drawn_fast(session: Open) -> None:  # noqa: F811
    found = session(YARD.replace("<diffuse>0.8", "<cast_shadows>true</cast_shadows><diffuse>0.8", 1), paused=True)
    assert found.page.locator("#quality").is_visible()
    found.until("app.stage.isFull")
    pixels = "app.stage.canvas.width / app.stage.canvas.clientWidth"
    assert found.get(f"[app.stage.isSoftware, {pixels}, app.stage.lights.children.some(l => l.castShadow)]") == [
        True,
        1,
        True,
    ]
    assert found.page.locator("#quality-now").inner_text() == "now full"
    found.picture("quality_full")
    box = found.page.locator("#canvas").bounding_box()
    found.page.mouse.move(box["x"] + 300, box["y"] + 300)
    found.page.mouse.down()
    found.page.mouse.move(box["x"] + 330, box["y"] + 300, steps=4)
    found.until("app.stage.isFull === false")
    found.page.mouse.up()
    assert found.page.locator("#quality-now").inner_text() == "now fast"
    found.until("app.stage.isFull")

    found.page.locator("#quality").select_option("fast")
    found.until("app.stage.isFull === false")
    assert found.get(pixels) == pytest.approx(0.75, abs=0.01)
    assert not found.get("app.stage.lights.children.some(l => l.castShadow)")
    fast = found.page.evaluate(COLOURS)
    found.picture("quality_fast")
    found.page.locator("#quality").select_option("full")
    found.until("app.stage.isFull")
    found.get("app.stage.move()")
    full = found.page.evaluate(COLOURS)
    assert found.get("app.stage.isFull")
    assert full > fast + 4  # in the same view, there are the colours of shadows and of smooth edges
    assert found.errors == []


def test_frames_have_their_names_where_they_are(session: Open) -> None:  # noqa: F811
    found = session(paused=True)
    found.page.locator("#show-frames").check()
    found.until("document.querySelectorAll('#labels .frame').length === 3")
    names = "[...document.querySelectorAll('#labels .frame')].map(box => [box.dataset.frame, box.textContent]).sort()"
    assert found.get(names) == [["rover::base", "base"], ["rover::mast", "mast"], ["stone::l", "l"]]
    offsets = """[...document.querySelectorAll('#labels .frame')].map(box => {
      const body = app.scene.frames.find(([name]) => name === box.dataset.frame)[1];
      const m = app.world.bodies[body].elements;
      const p = app.stage.camera.position.clone().set(m[12], m[13], m[14]).project(app.stage.camera);
      const c = app.stage.canvas.getBoundingClientRect(), b = box.getBoundingClientRect();
      return [b.left - c.left - (p.x + 1) / 2 * c.width,
        (b.top + b.bottom) / 2 - c.top - (1 - p.y) / 2 * c.height]; })"""
    for across, down in found.get(offsets):
        assert across == pytest.approx(5.0, abs=1.0) and down == pytest.approx(0.0, abs=1.0)
    found.picture("frames")
    found.page.locator("#show-frames").uncheck()
    found.until("document.querySelectorAll('#labels .frame').length === 0")
    assert found.errors == []


PERSON = """<actor name="walker"><simkit:person/><script><trajectory id="0" type="walk">
<waypoint><time>0</time><pose>-2 -2 0 0 0 0</pose></waypoint>
<waypoint><time>4</time><pose>2 -2 0 0 0 0</pose></waypoint>
</trajectory></script></actor></world>"""


def test_paths_of_people_do_not_have_the_colour_of_those_of_robots(session: Open) -> None:  # noqa: F811
    world = YARD.replace('version="1.9"', 'version="1.9" xmlns:simkit="https://simkit"').replace("</world>", PERSON)
    found = session(world)
    found.page.evaluate("simkitView.send('drive', {topic: '/cmd_vel', ahead: 0.3, turn: 0})")
    found.until("app.layers.paths.get('walker')?.points.length > 5 && app.layers.paths.get('rover').points.length > 5")
    hue = "[...app.layers.paths].map(([name, { mesh }]) => [name, mesh.material.color.getHSL({}).h])"
    hues: dict[str, Any] = dict(found.get(hue))
    assert 0.5 < hues["rover"] < 0.7  # blue
    assert hues["walker"] < 0.15  # orange
    selected = found.get("app.stage.helpers.children.find(o => o.type === 'Box3Helper').material.color.getHSL({}).h")
    assert 0.1 < selected < 0.2 and abs(selected - hues["walker"]) > 0.04  # yellow
    assert found.errors == []
    found.picture("people")
