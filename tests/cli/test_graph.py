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


def test_a_pdf_has_the_names_of_the_frames_and_a_valid_table_of_its_objects(tmp_path: Path) -> None:
    out = tmp_path / "tf.pdf"
    found = graph("turtlebot3_empty", "--tf", "-o", out)
    data = out.read_bytes()
    assert data.startswith(b"%PDF-1.4\n") and data.endswith(b"%%EOF\n")
    assert data.count(b" c h B") + data.count(b" l h B") == found["frames"]
    assert b"(base_footprint) Tj" in data and b"[5 4] 0 d" in data  # dashed: a static transform
    table = int(data.rsplit(b"startxref\n", 1)[1].split()[0])
    assert data[table : table + 4] == b"xref"
    for number, line in enumerate(data[table:].splitlines()[3:9], 1):
        assert data[int(line[:10]) :].startswith(b"%d 0 obj" % number)


def test_a_file_that_is_no_svg_is_refused(tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["graph", "turtlebot3_empty", "-o", str(tmp_path / "graph.png")])
    assert found.exit_code == 2
    assert "expected .svg" in found.stderr
