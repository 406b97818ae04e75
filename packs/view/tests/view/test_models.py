"""Models that pages spawn, move and remove."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import simkit
from packs.view.tests.view.conftest import Stage
from simkit_view.view.live_view import LiveView

CRATE = """<sdf version="1.9"><model name="crate"><link name="l"><inertial><mass>1</mass></inertial>
<collision name="c"><geometry><box><size>0.4 0.4 0.4</size></box></geometry></collision></link></model></sdf>"""


def test_a_model_stands_on_what_is_below_the_place(stage: Stage) -> None:
    page = stage.page()
    assert page.ask("spawn", source=CRATE, x=4.0, y=1.0)["ok"] == "crate"
    assert stage.sim.model("crate").pose.position == pytest.approx([4.0, 1.0, 0.2], abs=2e-3)
    assert page.ask("spawn", source=CRATE, name="upper", x=4.1, y=1.0, yaw=0.3)["ok"] == "upper"
    assert stage.sim.model("upper").pose.position == pytest.approx([4.1, 1.0, 0.6], abs=2e-3)
    assert stage.sim.model("upper").pose.rpy[2] == pytest.approx(0.3)
    assert page.ask("spawn", source=CRATE, name="high", x=4.0, y=1.0, z=3.0)["ok"] == "high"
    assert stage.sim.model("high").pose.position[2] == 3.0


def test_models_of_the_search_paths_and_of_simkit_can_be_chosen(tmp_path: Path) -> None:
    (tmp_path / "crate").mkdir()
    (tmp_path / "crate" / "model.sdf").write_text(CRATE, encoding="utf-8")
    (tmp_path / "notes").mkdir()
    world = "<sdf version='1.9'><world name='w'/></sdf>"
    with simkit.load(world, resource_paths=[tmp_path]) as sim, LiveView(sim):
        assert sim.control.list_models is not None
        found = sim.control.list_models()
        assert found["crate"] == str(tmp_path / "crate") and "notes" not in found
        assert found["turtlebot3_burger"] == "turtlebot3_burger"
        assert sim.spawn(found["crate"]).name == "crate"


def test_a_page_reads_the_pose_of_a_model_and_moves_it(stage: Stage) -> None:
    page = stage.page()
    assert page.ask("model_pose", name="wall")["ok"] == pytest.approx([2.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0])
    page.ask("move", name="wall", position=[2.5, 0.0, 0.5], quaternion=[1, 0, 0, 0])
    assert page.ask("model_pose", name="wall")["ok"][0] == 2.5


@pytest.mark.parametrize(
    "request_, reason",
    [
        ({"do": "spawn", "source": "none_such", "x": 0, "y": 0}, "none_such"),
        ({"do": "spawn", "source": CRATE, "name": "rover", "x": 0, "y": 0}, "exists already"),
        ({"do": "spawn", "source": CRATE, "name": "a b::c", "x": 0, "y": 0}, "a b::c"),
        ({"do": "model_pose", "name": "rovr"}, "rover"),
        ({"do": "move", "name": "rovr", "position": [0, 0, 0], "quaternion": [1, 0, 0, 0]}, "rover"),
        ({"do": "remove", "name": "rovr"}, "rover"),
    ],
)
def test_what_cannot_be_done_is_refused_with_a_reason(stage: Stage, request_: dict[str, Any], reason: str) -> None:
    page, models = stage.page(), list(stage.sim.models)
    do = request_.pop("do")
    assert reason in page.ask(do, **request_)["error"]
    assert list(stage.sim.models) == models
