"""Items of a message whose order has no meaning are sorted by name."""

from __future__ import annotations

from typing import Any

import pytest

from simkit import msgs
from simkit.testing.run_record.run_recorder import sort_message

TF = "tf2_msgs/msg/TFMessage"


def frame(child: str, parent: str, x: float = 0.0) -> dict[str, Any]:
    return {
        "header": {"frame_id": parent}, "child_frame_id": child, "transform": {"translation": {"x": x}}
    }  # fmt: skip


def test_transforms_are_by_child_then_parent_and_equal_ones_keep_their_order() -> None:
    message = msgs.make(TF, transforms=[frame("b", "o"), frame("a", "z"), frame("a", "o", 2.0), frame("a", "o", 1.0)])
    before = msgs.serialize(message)
    found = sort_message(message, TF)
    names = [(t.child_frame_id, t.header.frame_id, t.transform.translation.x) for t in found.transforms]
    assert names == [("a", "o", 2.0), ("a", "o", 1.0), ("a", "z", 0.0), ("b", "o", 0.0)]
    assert msgs.serialize(message) == before
    assert sort_message(found, TF) is found
    other = msgs.make(TF, transforms=[frame("a", "o", 2.0), frame("b", "o"), frame("a", "o", 1.0), frame("a", "z")])
    assert msgs.serialize(sort_message(other, TF)) == msgs.serialize(found)


def test_joints_of_a_model_keep_their_order() -> None:
    kind = "sensor_msgs/msg/JointState"
    message = msgs.make(kind, name=["wheel", "arm"], position=[1.0, 2.0])
    assert sort_message(message, kind) is message


def test_states_of_all_models_are_by_name() -> None:
    kind = "gazebo_msgs/msg/ModelStates"
    poses = [{"position": {"x": float(i)}} for i in range(3)]
    message = msgs.make(kind, name=["c", "a", "b"], pose=poses, twist=[{}, {}, {}])
    found = sort_message(message, kind)
    assert list(found.name) == ["a", "b", "c"] and [p.position.x for p in found.pose] == [1.0, 2.0, 0.0]
    odd = msgs.make(kind, name=["c", "a"], pose=poses, twist=[])
    assert sort_message(odd, kind) is odd
    assert len(msgs.serialize(found)) == len(msgs.serialize(message))


def test_contacts_are_sorted_by_collision_names() -> None:
    kind = "ros_gz_interfaces/msg/Contacts"
    pairs = [("b", "a"), ("a", "c"), ("a", "b")]
    contacts = [{"collision1": {"name": a, "id": 4}, "collision2": {"name": b, "id": 10}} for a, b in pairs]
    found = sort_message(msgs.make(kind, contacts=contacts), kind)
    assert [(c.collision1.name, c.collision2.name) for c in found.contacts] == sorted(pairs)
    assert {c.collision1.id for c in found.contacts} == {0}, "an id counts the parts of the file"


@pytest.mark.parametrize("first", [0, 1, 3])
@pytest.mark.parametrize(
    ("kind", "part"),
    [("ros_gz_interfaces/msg/Contacts", "contacts"), ("gazebo_msgs/msg/ContactsState", "states")],
)
def test_contact_points_are_sorted_independently_of_the_engine(first: int, kind: str, part: str) -> None:
    is_gz = part == "contacts"
    prefix = "" if is_gz else "contact_"
    corners = [(0.1, 0.1), (-0.1, 0.1), (-0.1, -0.1), (0.1, -0.1)]
    turned = [(*corners[(first + i) % 4], (first + i) % 4) for i in range(4)]
    contact = {
        f"{prefix}positions": [{"x": x, "y": y} for x, y, _ in turned],
        f"{prefix}normals": [{"z": 1.0 + n} for _, _, n in turned],
        "depths": [0.001 * n for _, _, n in turned],
        "wrenches": [{"body_1_wrench": {"force": {"z": n}}} if is_gz else {"force": {"z": n}} for *_, n in turned],
    }  # fmt: skip
    found = getattr(sort_message(msgs.make(kind, **{part: [contact]}), kind), part)[0]
    assert [(p.x, p.y) for p in getattr(found, f"{prefix}positions")] == [corners[i] for i in (2, 1, 3, 0)]
    assert [n.z for n in getattr(found, f"{prefix}normals")] == [3.0, 2.0, 4.0, 1.0]
    assert list(found.depths) == [0.002, 0.001, 0.003, 0.0]
    forces = [(w.body_1_wrench if is_gz else w).force.z for w in found.wrenches]
    assert forces == [2.0, 1.0, 3.0, 0.0]
