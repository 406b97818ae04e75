"""Layered layout: columns from left to right, no overlaps, few crossings."""

from __future__ import annotations

import random

import pytest

from simkit.recording.graphs.graph_svg import GraphBox, GraphEdge, graph_svg
from simkit.recording.graphs.layered_layout import Layout, layered_layout

SIZE = (80.0, 30.0)


def overlaps(layout: Layout) -> list[tuple[str, str]]:
    """Return the pairs of boxes that overlap."""
    boxes = sorted(layout.boxes.items())
    return [
        (a, b)
        for n, (a, (x, y, w, h)) in enumerate(boxes)
        for b, (u, v, s, t) in boxes[n + 1 :]
        if x < u + s and u < x + w and y < v + t and v < y + h
    ]


def test_a_chain_lies_on_one_line_from_left_to_right() -> None:
    layout = layered_layout(dict.fromkeys("abcd", SIZE), [("a", "b"), ("b", "c"), ("c", "d")])
    places = [layout.boxes[name][:2] for name in "abcd"]
    assert [x for x, _ in places] == sorted({x for x, _ in places})
    assert {y for _, y in places} == {0.0}


def test_a_loop_of_control_is_drawn_with_one_edge_backwards() -> None:
    edges = [("controller", "/cmd_vel"), ("/cmd_vel", "drive"), ("drive", "/odom"), ("/odom", "controller")]
    layout = layered_layout({name: SIZE for edge in edges for name in edge}, edges)
    backwards = [edge for edge, path in layout.paths.items() if path[0][0] > path[-1][0]]
    assert len(layout.paths) == 4
    assert len(backwards) == 1
    assert not overlaps(layout)


def test_edges_begin_and_end_at_their_boxes() -> None:
    layout = layered_layout(dict.fromkeys("abc", SIZE), [("a", "b"), ("b", "c"), ("a", "c")])
    for (start, end), path in layout.paths.items():
        x, y, width, height = layout.boxes[start]
        assert path[0] == pytest.approx((x + width, y + height / 2))
        x, y, _, height = layout.boxes[end]
        assert path[-1] == pytest.approx((x, y + height / 2))


@pytest.mark.parametrize("count", [5, 60])
def test_boxes_of_a_random_graph_do_not_overlap(count: int) -> None:
    drawn = random.Random(count)
    names = [f"n{n}" for n in range(count)]
    sizes = {name: (drawn.uniform(40, 200), drawn.uniform(20, 120)) for name in names}
    edges = [(drawn.choice(names), drawn.choice(names)) for _ in range(2 * count)]
    layout = layered_layout(sizes, edges)
    assert set(layout.boxes) == set(names)
    assert overlaps(layout) == []
    assert all(box[0] >= 0 and box[1] >= -1e-9 for box in layout.boxes.values())


def test_edges_of_a_tree_do_not_cross() -> None:
    edges = [(f"f{(n - 1) // 3}", f"f{n}") for n in range(1, 40)]
    layout = layered_layout({f"f{n}": SIZE for n in range(40)}, edges)
    middle = {name: box[1] for name, box in layout.boxes.items()}
    for a, b in edges:
        for c, d in edges:
            if layout.boxes[a][0] == layout.boxes[c][0] and middle[a] < middle[c]:
                assert middle[b] < middle[d]


def test_names_in_a_drawing_are_escaped_and_long_ones_are_shortened() -> None:
    boxes = [GraphBox("a<b", "node", "a<b"), GraphBox("x" * 80, "topic", "x" * 80)]
    text = graph_svg("a & b", boxes, [GraphEdge("a<b", "x" * 80)])
    assert "a &amp; b" in text and "a&lt;b" in text and "a<b" not in text
    assert ">" + "x" * 21 + "…" in text
    assert "prefers-color-scheme:dark" in text
