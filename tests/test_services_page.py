"""The page of services has exactly what a world offers, and no type that is not known."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import simkit
from simkit import msgs
from simkit.msgs.interface_definitions import interface_names

PAGE = Path(__file__).resolve().parents[1] / "docs" / "services.md"
ROW = re.compile(r"^\| `(/[^`]+)` \| `([\w/]+/srv/\w+)` \| (.*)\|$", re.MULTILINE)
WORLD = (
    """<sdf version="1.9"><world name="w"><plugin name="api" filename="libgazebo_ros_api_plugin.so"/></world></sdf>"""
)


def test_the_page_has_every_service_with_its_type_and_no_other() -> None:
    page = PAGE.read_text("utf-8")
    rows = {(name.replace("<world>", "w"), type_name) for name, type_name, _ in ROW.findall(page)}
    types = dict(rows)
    classic = re.search(r"^These have the types .*?\n\n", page, re.MULTILINE | re.DOTALL)
    assert classic is not None
    rows |= {(name, types[name.removeprefix("/gazebo")]) for name in re.findall(r"`(/gazebo/\w+)`", classic[0])}
    standard = page[page.index("## Services of `simulation_interfaces`") : page.index("The action `/simulate_steps`")]
    for name in re.findall(r"^\| `(/\w+)`|(?<=[:,]\s)`(/\w+)`(?=[,.])", standard, re.MULTILINE):
        camel = "".join(word.capitalize() for word in "".join(name).strip("/").split("_"))
        rows.add(("".join(name), f"simulation_interfaces/srv/{camel}"))
    offered = set()
    # where Gazebo Classic's plugin offers a service of a name, that of `simulation_interfaces` is not offered
    for text in (WORLD, '<sdf version="1.9"><world name="w"/></sdf>'):
        with simkit.load(text) as sim:
            offered |= set(sim.communication.services.names().items())
    assert rows == {(name, kind) for name, kind in offered if not name.endswith("/blocking")}
    blocking = {name.removesuffix("/blocking") for name, _ in offered if name.endswith("/blocking")}
    assert {f"/world/w/{short}" for short in ("control", "generate_world_sdf", "scene/info")} == {
        n for n, _ in rows if "/world/" in n
    } - blocking


def test_the_page_has_the_topics_that_a_world_tells_of_itself() -> None:
    text = PAGE.read_text("utf-8")
    with simkit.load(WORLD) as sim:
        topics = {
            topic: kind
            for topic, kind in sim.communication.bus.all_topics().items()
            if topic in sim.communication.bus.aside
        }
    for topic, kind in topics.items():
        assert f"`{topic.replace('/w/', '/<world>/')}`" in text
        assert kind.rpartition("/")[2] in text


@pytest.mark.slow
def test_every_type_can_be_made_and_written() -> None:
    for name in interface_names("srv"):
        for end in ("Request", "Response"):
            message = msgs.make(f"{name}_{end}")
            assert msgs.serialize(msgs.deserialize(msgs.serialize(message), f"{name}_{end}")) == msgs.serialize(message)
