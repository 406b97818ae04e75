"""Chains in files of strangers: each has a length that passes, and one more is refused with a code."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import simkit
from simkit.compiler.model_writer import DEEPEST
from simkit.loaders.sdf.load_context import MAX_INCLUDE_DEPTH
from simkit.scene.model import MOST_LEADERS

INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
AXIS = "<axis><xyz>1 0 0</xyz>{}</axis>"


def world(content: str) -> str:
    return f'<sdf version="1.9"><world name="w">{content}</world></sdf>'


def included(folder: Path, count: int, element: str) -> str:
    """Write models that include one another; return a world with the first of them, and `count` includes in a row."""
    for i in range(count):
        inner = "" if i == count - 1 else f"{element}<uri>m{i + 1}.sdf</uri></include>"
        text = f'<sdf version="1.9"><model name="m{i}"><link name="l{i}"/>{inner}</model></sdf>'
        (folder / f"m{i}.sdf").write_text(text)
    return world("<include><uri>m0.sdf</uri></include>")


def nested(_folder: Path, count: int) -> str:
    """Return a world whose elements are nested to a depth; a link is 3 below the outermost model's parents."""
    models = count - 3
    opened = "".join(f'<model name="m{i}"><link name="l"/>' for i in range(models))
    return world(opened + "</model>" * models)


def linked(_folder: Path, count: int) -> str:
    links = "".join(f'<link name="l{i}"/>' for i in range(count))
    joint = '<joint name="j{0}" type="fixed"><parent>l{1}</parent><child>l{0}</child></joint>'
    return world(f'<model name="m">{links}{"".join(joint.format(i, i - 1) for i in range(1, count))}</model>')


def linked_urdf(_folder: Path, count: int) -> str:
    links = "".join(f'<link name="l{i}">{INERTIAL}</link>' for i in range(count))
    joint = '<joint name="j{0}" type="fixed"><parent link="l{1}"/><child link="l{0}"/></joint>'
    return f'<robot name="r">{links}{"".join(joint.format(i, i - 1) for i in range(1, count))}</robot>'


def mimicking(_folder: Path, count: int) -> str:
    """Return a model whose last joint follows a chain of `count` joints."""
    parts = ""
    for i in range(count + 1):
        law = f'<mimic joint="j{i - 1}"><multiplier>1</multiplier><offset>0</offset><reference>0</reference></mimic>'
        axis = AXIS.format(law if i else "")
        joint = f'<joint name="j{i}" type="revolute"><parent>b</parent><child>l{i}</child>{axis}</joint>'
        parts += f'<link name="l{i}"/>{joint}'
    return world(f'<model name="m"><link name="b"/>{parts}</model>')


def mimicking_urdf(_folder: Path, count: int) -> str:
    parts = ""
    for i in range(count + 1):
        law = f'<mimic joint="j{i - 1}"/>' if i else ""
        ends = f'<parent link="b"/><child link="l{i}"/>'
        parts += f'<link name="l{i}">{INERTIAL}</link><joint name="j{i}" type="continuous">{ends}{law}</joint>'
    return f'<robot name="r"><link name="b">{INERTIAL}</link>{parts}</robot>'


CHAINS: dict[str, tuple[Callable[[Path, int], str], int, str]] = {
    "includes": (lambda f, n: included(f, n, "<include>"), MAX_INCLUDE_DEPTH - 1, "SK-SDF-016"),
    "merging includes": (lambda f, n: included(f, n, '<include merge="true">'), MAX_INCLUDE_DEPTH - 1, "SK-SDF-016"),
    "nested models": (nested, 200, "SK-XML-002"),
    "links": (linked, DEEPEST, "SK-JOINT-015"),
    "links of a URDF": (linked_urdf, DEEPEST, "SK-JOINT-015"),
    "mimics": (mimicking, MOST_LEADERS, "SK-JOINT-017"),
    "mimics of a URDF": (mimicking_urdf, MOST_LEADERS, "SK-JOINT-017"),
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name.startswith("links") else ()) for name in CHAINS]
)
def test_the_longest_chain_passes_and_a_longer_one_is_refused(tmp_path: Path, name: str) -> None:
    make, most, code = CHAINS[name]
    found: dict[int, list[str]] = {}
    for count in (most, most + 1, 4 * most):
        (tmp_path / "w.sdf").write_text(make(tmp_path, count))
        found[count] = [d.code for d in simkit.check(tmp_path / "w.sdf") if d.severity == "error"]
    assert found[most] == [] and found[most + 1][0] == code and set(found[4 * most]) == {code}


@pytest.mark.parametrize(
    "frames",
    [
        lambda n: "".join(f'<frame name="f{i}" attached_to="{f"f{i + 1}" if i < n - 1 else "l"}"/>' for i in range(n)),
        pytest.param(
            lambda n: "".join(
                f'<frame name="f{i}"><pose relative_to="{f"f{i + 1}" if i < n - 1 else "l"}">0 0 1 0 0 0</pose></frame>'
                for i in range(n)
            ),
            marks=pytest.mark.slow,
        ),
    ],
    ids=["attached_to", "relative_to"],
)
def test_a_chain_of_frames_needs_no_stack(frames: Callable[[int], str]) -> None:
    text = world(f'<model name="m"><link name="l"/>{frames(20_000)}</model>')
    assert not [d for d in simkit.check(text) if d.severity == "error"]


def test_a_ring_of_mimics_that_is_longer_than_the_limit_is_refused() -> None:
    joints = "".join(
        f'<link name="l{i}">{INERTIAL}</link><joint name="j{i}" type="continuous"><parent link="b"/>'
        f'<child link="l{i}"/><mimic joint="j{(i + 1) % 300}"/></joint>'
        for i in range(300)
    )
    found = simkit.check(f'<robot name="r"><link name="b">{INERTIAL}</link>{joints}</robot>')
    assert {d.code for d in found if d.severity == "error"} == {"SK-JOINT-017"}
    assert max(len(d.message) for d in found) < 1000


def joined(count: int) -> str:
    """Return a world with a chain of models that joints of the world connect; each joint adds a body."""
    link = '<link name="l"><inertial><mass>1</mass></inertial></link>'
    models = "".join(f'<model name="m{i}"><pose>{i} 0 0 0 0 0</pose>{link}</model>' for i in range(count))
    joint = '<joint name="j{0}" type="fixed"><parent>m{1}</parent><child>m{0}</child></joint>'
    return world(models + "".join(joint.format(i, i - 1) for i in range(1, count)))


def test_joints_between_models_count_as_moving_links(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("simkit.compiler.model_compilation.MOST_MOVING", 19)
    assert not [d for d in simkit.check(joined(10)) if d.severity == "error"]
    assert [d.code for d in simkit.check(joined(11)) if d.severity == "error"] == ["SK-PHYS-029"]


@pytest.mark.slow
def test_a_chain_of_two_thousand_models_runs() -> None:
    """With more than 4096 bodies, MuJoCo's memory was too small, and a `mujoco.FatalError` ended the command."""
    with simkit.load(joined(2100)) as sim:
        sim.step(2)
        assert len(sim.models) == 2100
