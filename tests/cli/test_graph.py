"""`simkit graph`: nodes and topics, or frames, of worlds and of running simulations."""

from __future__ import annotations

import json
from pathlib import Path

from typer.testing import CliRunner

from simkit.cli import app


def graph(*arguments: object) -> dict[str, object]:
    found = CliRunner().invoke(app, ["graph", *map(str, arguments), "--json"])
    assert found.exit_code == 0, found.output
    report: dict[str, object] = json.loads(found.stdout)
    return report


def test_the_graph_of_a_world_has_its_nodes_topics_and_directions(tmp_path: Path) -> None:
    out = tmp_path / "graph.svg"
    assert graph("turtlebot3_empty", "-o", out) == {"output": str(out), "nodes": 7, "topics": 13, "edges": 13}
    text = out.read_text(encoding="utf-8")
    assert all(name in text for name in ("diff_drive", "/cmd_vel", "geometry_msgs/Twist", "/odom"))
    assert "/rosout" not in text
    everything = graph("turtlebot3_empty", "-o", out, "--all")
    assert int(str(everything["topics"])) > 13
    assert "/rosout" in out.read_text(encoding="utf-8")


def test_the_tree_of_frames_has_moving_and_static_transforms(tmp_path: Path) -> None:
    out = tmp_path / "tf.svg"
    found = graph("turtlebot3_empty", "--tf", "-o", out)
    text = out.read_text(encoding="utf-8")
    assert int(str(found["edges"])) == int(str(found["frames"])) - 1  # a tree
    assert "base_footprint" in text and "dashed" in text


def test_a_file_that_is_no_svg_is_refused(tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["graph", "turtlebot3_empty", "-o", str(tmp_path / "graph.png")])
    assert found.exit_code == 2
    assert "expected .svg" in found.stderr
