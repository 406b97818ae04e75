"""The page in a real browser: what it draws, and that each control does what it says."""

from __future__ import annotations

import io
import os
import queue
import shutil
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pytest
from PIL import Image

import simkit
from packs.view.tests.view.conftest import YARD
from simkit_view.view.html_file import html_file
from simkit_view.view.live_view import LiveView
from simkit_view.view.packet import make_packet
from simkit_view.view.scene_packet import make_scene_packet, moving_bodies

pytestmark = pytest.mark.browser
T = TypeVar("T")
TIMEOUT = 30_000  # [ms]; a browser without a graphics card draws slowly
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
PICTURES = os.environ.get("SIMKIT_BROWSER_PICTURES", "")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Chromium of the system; nothing is downloaded."""
    playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install playwright")
    program = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if program is None:
        pytest.skip("there is no Chromium; install it with `apt-get install chromium`")
    software = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=program, args=software)
        yield opened
        opened.close()


class Session:
    """Simulation in a thread that keeps it running, and its page in a browser."""

    def __init__(
        self,
        browser: Any,
        stack: ExitStack,
        world: str,
        *,
        checks_policy: bool = False,
        more: str = "",
        size: tuple[int, int] = (1200, 720),
        theme: str = "dark",
        paused: bool = False,
        tour: bool = False,
    ) -> None:
        self.sim = stack.enter_context(simkit.load(world, sleep=False))  # a body asleep has no contacts
        self.sim.paused = paused
        self.view = stack.enter_context(LiveView(self.sim))
        self._ends = threading.Event()
        self._calls: queue.SimpleQueue[tuple[Callable[[], Any], queue.SimpleQueue[Any]]] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()
        stack.callback(self._end)
        # Playwright's waiting functions need `eval`, which the page's policy forbids
        viewport = {"width": size[0], "height": size[1]}
        context = browser.new_context(viewport=viewport, bypass_csp=not checks_policy, color_scheme=theme)
        stack.callback(context.close)
        if not tour:
            context.add_cookies([{"name": "simkit-tour", "value": "off", "url": self.view.address}])
        self.page = context.new_page()
        self.outside: list[str] = []
        self.errors: list[str] = []
        self.page.on("request", lambda request: self._note(request.url))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", lambda m: self.errors.append(m.text) if m.type == "error" else None)
        self.page.goto(self.view.address + more)
        self.has_drawn = self.page.locator("#link.on")
        self.has_drawn.wait_for(timeout=TIMEOUT)
        if not checks_policy:
            self.until("app.stage.fitted !== undefined")  # the camera then stays where it is

    def _note(self, url: str) -> None:
        if not url.startswith((f"http://127.0.0.1:{self.view.server.port}/", "blob:", "data:")):
            self.outside.append(url)

    def _run(self) -> None:
        pausing = self.sim.control.pausing
        with pausing.served():
            while not self._ends.wait(0.01):
                self.view.update()
                self.view.driving.send_due()
                while not self._calls.empty():
                    function, answer = self._calls.get()
                    answer.put(function())
                if not self.sim.paused:
                    pausing.advance(5)

    def _end(self) -> None:
        self._ends.set()
        self._thread.join()

    def until(self, expression: str) -> Any:
        """Wait until an expression of the page is true; `app` is its main object."""
        text = f"(() => {{ const app = window.simkitView; return {expression}; }})()"
        return self.page.wait_for_function(text, timeout=TIMEOUT).json_value()

    def do(self, function: Callable[[], T]) -> T:
        """Call a function in the simulation's thread, between two steps; other threads must not use a simulation."""
        answer: queue.SimpleQueue[T] = queue.SimpleQueue()
        self._calls.put((function, answer))
        return answer.get(timeout=TIMEOUT / 1000)

    def until_here(self, condition: Callable[[], bool]) -> None:
        """Wait until the simulation fulfils a condition; a question to it passes in between."""
        end = time.monotonic() + TIMEOUT / 1000
        while not self.do(condition):
            assert time.monotonic() < end
            self.get("app.ask('travel')")

    def get(self, expression: str) -> Any:
        return self.page.evaluate(f"(() => {{ const app = window.simkitView; return {expression}; }})()")

    def picture(self, name: str) -> Path | None:
        """Keep a picture where SIMKIT_BROWSER_PICTURES names a folder."""
        if not PICTURES:
            return None
        path = Path(PICTURES) / f"{name}.jpg"
        path.parent.mkdir(parents=True, exist_ok=True)
        self.page.screenshot(path=path, timeout=4 * TIMEOUT, quality=85)
        return path


@pytest.fixture
def session(browser: Any) -> Iterator[Callable[..., Session]]:
    with ExitStack() as stack:
        yield lambda world=YARD, **more: Session(browser, stack, world, **more)


COLOURS = """(() => { const app = window.simkitView, c = document.createElement('canvas'); c.width = c.height = 64;
  app.stage.draw(); c.getContext('2d').drawImage(app.stage.canvas, 0, 0, 64, 64);
  const d = c.getContext('2d').getImageData(0, 0, 64, 64).data, found = new Set();
  for (let i = 0; i < d.length; i += 4) found.add((d[i] >> 4) * 256 + (d[i + 1] >> 4) * 16 + (d[i + 2] >> 4));
  return found.size; })()"""


def test_the_page_draws_the_world_and_loads_nothing_from_outside(session: Callable[..., Session]) -> None:
    found = session()
    found.until("app.stage.draws > 1 && app.state.tick > 20")
    assert found.page.evaluate(COLOURS) > 12
    assert found.get("app.robots.map(robot => robot.name)") == ["rover"]
    corners = """(() => { const box = app.views.robotBox(), out = [];
      for (const x of [box.min.x, box.max.x]) for (const y of [box.min.y, box.max.y])
        for (const z of [box.min.z, box.max.z]) {
        const p = box.min.clone().set(x, y, z).project(app.stage.camera);
        out.push(Math.max(Math.abs(p.x), Math.abs(p.y)));
      } return Math.max(...out); })()"""
    assert found.get(corners) < 1.0
    assert found.outside == [] and found.errors == []
    found.picture("yard")


@pytest.mark.parametrize(
    "world", ["turtlebot3_world", "turtlebot3_house", "tiago_table", "simple_office_with_people", "sensor_bench"]
)
def test_the_worlds_of_simkit_are_drawn_with_shadows(session: Callable[..., Session], world: str) -> None:
    found = session(world, more="&quality=full")
    if "/cmd_vel" in found.sim.topics():
        found.page.evaluate("simkitView.send('drive', {topic: '/cmd_vel', ahead: 0.2, turn: 0.3})")
    found.until("app.stage.draws > 3 && app.state.time > 3")
    assert found.get("app.stage.gl.shadowMap.enabled") and found.page.evaluate(COLOURS) > 20
    assert found.errors == [] and found.outside == []
    found.picture(f"view_{world}")


def test_the_page_works_with_its_security_policy(session: Callable[..., Session]) -> None:
    found = session(checks_policy=True)
    found.page.locator("#show-frames").check(timeout=TIMEOUT)
    assert found.errors == []


def test_the_bar_pauses_steps_resets_and_sets_the_speed(session: Callable[..., Session]) -> None:
    found = session()
    found.until("app.state?.tick > 0")
    found.page.locator("#play").click()
    found.until("app.state.paused")
    tick = found.sim.tick
    found.page.locator("#count").fill("7")
    found.page.locator("#step").click()
    found.until(f"app.state.tick === {tick + 7}")
    found.page.locator("#speed").select_option("0.5 ×")
    found.until("app.state.pace === 0.5")
    found.page.locator("#reset").click()
    found.until("app.state.tick < 7")
    found.page.locator("#play").click()
    found.until("!app.state.paused")
    assert not found.sim.paused


def test_keys_and_the_pad_drive(session: Callable[..., Session]) -> None:
    found = session()
    sent = found.sim.subscribe("/cmd_vel")
    found.until("document.getElementById('drive').hidden === false")
    found.page.locator("#canvas").press("w")
    found.until("document.getElementById('speeds').textContent.startsWith('0.0')")
    found.until_here(lambda: sent.latest is not None and sent.latest.linear.x > 0)
    found.page.locator("#stop").click()
    pad = found.page.locator("#pad").bounding_box()
    middle = pad["x"] + pad["width"] / 2, pad["y"] + pad["height"] / 2
    found.page.mouse.move(*middle)
    found.page.mouse.down()
    found.page.mouse.move(middle[0], pad["y"] + 2)
    found.until("parseFloat(document.getElementById('speeds').textContent) > 0.5")
    found.page.mouse.up()
    found.until("parseFloat(document.getElementById('speeds').textContent) === 0")
    found.until_here(lambda: sent.latest.linear.x == 0)


def test_a_click_on_the_ground_sends_a_goal(session: Callable[..., Session]) -> None:
    found = session()
    goals = found.sim.subscribe("/goal_pose")
    found.until("app.stage.draws > 1")
    found.page.locator("#go").click()
    box = found.page.locator("#canvas").bounding_box()
    place = box["x"] + 0.3 * box["width"], box["y"] + 0.8 * box["height"]
    x, y = found.get(f"(() => {{ const p = app.pickAt({place[0]}, {place[1]}).point; return [p.x, p.y]; }})()")
    found.page.mouse.click(*place)
    found.until("app.aiming === null")
    found.until_here(lambda: goals.latest is not None)
    assert (goals.latest.pose.position.x, goals.latest.pose.position.y) == pytest.approx((x, y), abs=0.02)


def test_layers_show_what_they_say(session: Callable[..., Session]) -> None:
    found = session()
    found.until("app.sensors.points.geometry.attributes.position?.count === 9")
    for name in ("collisions", "frames", "joints", "inertia", "mass", "contacts"):
        found.page.locator(f"#show-{name}").check()
    found.until("app.world.collisions.visible && app.layers.contacts?.arrays.position.length > 0")
    found.until("app.layers.frames.points.length === 3 * 3 * 3 * 2")  # three moving links, three axes
    found.until("app.layers.inertia.points.length === 3 * 12 * 6 && app.layers.mass.mesh.count === 3")
    found.until("app.layers.joints.points.length === 6")
    found.page.locator("#show-visuals").uncheck()
    assert found.get("app.world.visuals.visible") is False
    found.page.locator("#show-lidar").uncheck()
    found.until("!('lidar' in app.connection.wants)")
    found.picture("layers")


def test_a_spawned_model_appears_and_a_click_in_the_tree_selects(session: Callable[..., Session]) -> None:
    found = session()
    found.until("app.state?.tick > 0")
    xml = "<sdf version='1.9'><model name='ball'><link name='l'><visual name='v'><geometry><sphere><radius>0.2</radius>"
    found.get(
        f'app.send("spawn", {{source: "{xml}</sphere></geometry></visual></link></model></sdf>", x: 1, y: 1, z: 1}})'
    )
    found.until("app.models.has('ball')")
    found.page.locator("#tree summary", has_text="rover").click()
    found.page.locator("[data-link='rover::mast']").click()
    found.until("app.selected === 'rover::mast'")
    assert "yaw" in found.page.locator("#selection").inner_text()


def test_a_colour_and_a_light_change_in_the_scene(session: Callable[..., Session]) -> None:
    found = session()
    found.until("app.state?.tick > 0")
    number = found.get("app.stage.lights.children.length")
    found.sim.visual("wall::l::v").set_colour(1.0, 0.0, 0.0)
    found.until("app.world.arrays.geom_rgba.join().includes('1,0,0,1')")
    found.sim.light("sun").switch(False)
    found.until("app.world.arrays.light_active[0] === 0")
    assert found.get("app.stage.lights.children.length") <= number
    assert found.errors == []


def test_sliders_move_joints_of_a_paused_world(session: Callable[..., Session]) -> None:
    found = session()
    found.until("document.querySelector('[data-joint]') !== null")
    found.page.locator("#play").click()
    found.until("app.state.paused && !document.querySelector('[data-joint]').disabled")
    found.page.locator("[data-joint='rover::turn']").fill("0.5")
    found.until("document.querySelector('[data-joint]').previousSibling.textContent === '28.6°'")
    assert found.do(lambda: found.sim.joint("rover::turn").position) == pytest.approx(0.5, abs=0.003)


def test_a_hidden_page_costs_nothing(session: Callable[..., Session]) -> None:
    found = session()
    found.until("app.state?.tick > 0")
    hide = "Object.defineProperty(document, 'hidden', {get: () => %s, configurable: true})"
    found.page.evaluate(hide % "true")
    found.page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
    found.page.locator("#link.off").wait_for(timeout=TIMEOUT)
    assert found.get("app.connection.socket") is None
    found.page.evaluate(hide % "false")
    found.page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
    found.page.locator("#link.on").wait_for(timeout=TIMEOUT)


def boxes(*models: tuple[str, str, str, bool]) -> str:
    """Return a world of boxes: name, position, size, static."""
    text = "".join(
        f"""<model name="{name}"><static>{str(fixed).lower()}</static><pose>{place} 0 0 0</pose><link name="l">
        <visual name="v"><geometry><box><size>{size}</size></box></geometry></visual></link></model>"""
        for name, place, size, fixed in models
    )
    return f'<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>{text}</world></sdf>'


HOUSE = (
    ("floor", "0 0 -0.05", "16 16 0.1", True),
    ("north", "0 8 1", "16 0.1 2", True),
    ("south", "0 -8 1", "16 0.1 2", True),
    ("east", "8 0 1", "0.1 16 2", True),
    ("west", "-8 0 1", "0.1 16 2", True),
)
ROOF = ("roof", "0 0 2.05", "17 17 0.1", True)
CART = ("cart", "1 1 0.2", "0.6 0.4 0.4", False)


def test_the_first_view_leaves_out_models_that_are_far_away(session: Callable[..., Session]) -> None:
    page = session(boxes(*HOUSE, CART, ("book", "0 0 343582", "0.2 0.2 0.2", False)))
    assert page.get("[...app.views.strays()]") == ["book"]
    assert page.get("app.stage.camera.position.length()") < 60.0
    assert "book" in page.get("document.getElementById('notice').textContent")
    page.do(lambda: page.sim.model("cart").set_pose(simkit.Pose((0.0, 0.0, -490.0))))
    page.until("app.state && app.world.boxesByModel().get('cart').min.z < -400")
    assert page.get("[...app.views.strays()].sort()") == ["book", "cart"]


def test_the_first_view_of_a_house_is_open_above_the_robots(session: Callable[..., Session]) -> None:
    plain = session(boxes(*HOUSE, CART))
    assert plain.get("app.stage.cuts.length") == 0
    roofed = session(boxes(*HOUSE, CART, ROOF))
    assert roofed.get("app.stage.cuts.map(cut => cut.constant)") == pytest.approx([0.45], abs=1e-3)
    roofed.get("app.views.top()")
    assert roofed.get("app.stage.cuts.length") == 0


def test_one_file_opens_without_simkit_and_seeks(browser: Any, tmp_path: Path) -> None:
    lidar = {"topic": "/scan", "count": 3, "low": -0.1, "step": 0.1}
    scan = {
        "lidar0.times": np.array([0.002]),
        "lidar0.poses": np.array([[0, 0, 0.2, 1, 0, 0, 0]], np.float32),
        "lidar0.ranges": np.full((1, 3), 1500, np.uint16),
    }
    with simkit.load(YARD) as sim:
        poses = make_packet(
            {"kind": "recording", "name": "drive.mcap", "begin": 0.0, "lidars": [lidar]},
            {"times": np.arange(31) / 15, "poses": _moving_poses(sim), **scan},
        )
        text = html_file("drive", make_scene_packet(sim, 1, {"recording": True, "seed": 0}), poses)
    path = tmp_path / "drive.html"
    path.write_text(text, encoding="utf-8")
    page = browser.new_page()
    requests: list[str] = []
    page.on("request", lambda request: requests.append(request.url))
    page.goto(path.as_uri())
    page.locator("#seek").wait_for(timeout=TIMEOUT)
    end = time.monotonic() + TIMEOUT / 1000
    while _colours_of_the_scene(page) <= 12:  # the first pictures of a slow browser may be empty
        assert time.monotonic() < end
    scanned = "simkitView.sensors.points.geometry.attributes.position.array[0]"
    assert page.evaluate(scanned) == pytest.approx(1.5 * np.cos(0.1), abs=1e-3)  # of the first step, at the start
    page.locator("#seek").fill("1.5")
    page.locator("#time", has_text="1.500 s").wait_for(timeout=TIMEOUT)
    assert page.evaluate("simkitView.world.bodies[simkitView.bodyOf.get('rover')].elements[12]") == pytest.approx(1.5)
    page.locator("#play").click()
    page.locator("#rtf", has_text="paused").wait_for(timeout=TIMEOUT)  # at the end
    page.locator("#frames").filter(has_not_text="/s").wait_for(state="attached", timeout=TIMEOUT)  # nothing moves
    assert [url for url in requests if not url.startswith(("file:", "data:", "blob:"))] == []
    page.close()


def _colours_of_the_scene(page: Any) -> int:
    """Return the number of colours in a screenshot of the scene, with 16 levels of red, green and blue."""
    box = page.evaluate(
        "(() => { const b = simkitView.stage.canvas.getBoundingClientRect();"
        "return {x: b.x, y: b.y, width: b.width, height: b.height * 0.8}; })()"
    )
    image = Image.open(io.BytesIO(page.screenshot(clip=box, timeout=TIMEOUT))).convert("RGB")
    return len(np.unique(np.asarray(image).reshape(-1, 3) >> 4, axis=0))


def _moving_poses(sim: simkit.Simulation) -> np.ndarray:
    """States in which all bodies move by 1 m/s along x."""
    bodies = moving_bodies(sim.mj_model)
    states = np.zeros((31, len(bodies), 7))
    states[:, :, 0] = (np.arange(31) / 15)[:, None]
    states[:, :, 3] = 1.0
    return states
