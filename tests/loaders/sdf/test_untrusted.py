"""Malicious or broken files: an error or a clean load, in limited time and memory."""

from __future__ import annotations

import sys

import pytest

HEAD = '<sdf version="1.9"><model name="m"><link name="l"/>'


def model(content: str) -> str:
    return f"{HEAD}{content}</model></sdf>"


def codes(found, severity: str = "error") -> list[str]:
    return [d.code for d in found if d.severity == severity]


@pytest.mark.parametrize(
    "declared",
    [
        '<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">',
        '<!ENTITY a SYSTEM "file:///etc/passwd">',
        '<!ENTITY % a SYSTEM "http://127.0.0.1/a.dtd">',
    ],
)
def test_entities_are_refused(load, declared):
    scene, found = load(f'<!DOCTYPE sdf [{declared}]><sdf version="1.9"><model name="m"/></sdf>')
    assert codes(found) == ["SK-XML-003"] and scene.model is None


def test_an_external_document_type_is_not_fetched(load):
    scene, found = load('<!DOCTYPE sdf SYSTEM "http://127.0.0.1:9/a.dtd">' + model(""))
    assert scene.model is not None and not codes(found)


def test_xinclude_is_not_read_and_causes_a_warning(load, write):
    secret = write("secret.txt", "secret")
    text = model("").replace("<sdf ", '<sdf xmlns:xi="http://www.w3.org/2001/XInclude" ')
    scene, found = load(text.replace("<model", f'<xi:include href="{secret}" parse="text"/><model'))
    assert scene.model.name == "m"
    messages = [d.message for d in found if d.severity == "warning"]
    assert messages == ["<xi:include> is not supported"]


def test_a_million_nested_elements_are_refused(load):
    deep = "<model name='a'>" * 1_000_000
    _, found = load(f'<sdf version="1.9">{deep}')
    assert codes(found) == ["SK-XML-002"]


@pytest.mark.slow
def test_the_number_of_warnings_about_unknown_siblings_is_limited(load):
    scene, found = load(model("".join(f"<x{i}/>" for i in range(200_000))))
    assert scene.model is not None and 500 <= len(found) <= 510


@pytest.mark.slow
def test_more_siblings_than_the_limit_are_refused(load):
    _, found = load(model('<frame name="f"/>' * 100_001))
    assert codes(found) == ["SK-XML-002"]


def test_a_very_long_name_is_refused(load):
    _, found = load(model(f'<link name="{"a" * 10_000_000}"/>'))
    assert codes(found) == ["SK-SDF-003"]
    assert all(len(d.message) < 5000 for d in found)


def test_the_message_about_a_number_of_a_million_digits_is_short(load):
    _, found = load(model(f"<static>{'1' * 1_000_000}</static>"))
    assert codes(found) == ["SK-PARAM-002"] and len(found[-1].message) < 400


@pytest.mark.parametrize("forward", [True, False])
def test_a_chain_of_frames_of_any_length_is_resolved(load, forward):
    count = 3 * sys.getrecursionlimit()
    order = range(1, count) if forward else range(count - 1, 0, -1)
    links = "".join(f'<frame name="f{i}" attached_to="f{i - 1}"><pose>1 0 0 0 0 0</pose></frame>' for i in order)
    scene, found = load(model('<frame name="f0" attached_to="l"/>' + links))
    assert not codes(found)
    last = next(f for f in scene.model.frames if f.name == f"f{count - 1}")
    assert (last.pose_world.position[0], last.attached_to) == (count - 1, "m::l")


def test_a_circle_of_frames_of_any_length_is_one_error_for_poses_and_one_for_attachments(load):
    count = 3 * sys.getrecursionlimit()
    frames = "".join(f'<frame name="f{i}" attached_to="f{(i + 1) % count}"/>' for i in range(count))
    poses = "".join(f'<frame name="p{i}"><pose relative_to="p{(i + 1) % count}"/></frame>' for i in range(count))
    _, found = load(model(poses))
    assert codes(found) == ["SK-SDF-005"]
    _, found = load(model(frames))
    assert set(codes(found)) == {"SK-SDF-005"}


def test_models_can_be_nested_to_the_depth_limit(load):
    deep = "".join(f'<model name="m{i}">' for i in range(190)) + '<link name="l"/>' + "</model>" * 190
    scene, found = load(f'<sdf version="1.9">{deep}</sdf>')
    assert not codes(found) and len(scene.model.all_models()) == 190


def test_circular_includes_through_links_are_an_error(load, write, tmp_path):
    text = '<sdf version="1.9"><model name="{}"><link name="l"/><include><uri>{}</uri></include></model></sdf>'
    write("a/model.sdf", text.format("a", "model://b"))
    (tmp_path / "b").symlink_to(tmp_path / "a")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    _, found = load(tmp_path / "a/model.sdf", (tmp_path,))
    assert codes(found) == ["SK-SDF-016"]
    _, found = load(model("<include><uri>model://loop</uri></include>"), (tmp_path,))
    assert codes(found) and all(code.startswith("SK-") for code in codes(found))


@pytest.mark.slow
def test_includes_that_double_at_every_level_are_limited(load, write, tmp_path):
    for i in range(30):
        inner = f"<include><uri>model://m{i + 1}</uri><name>{{}}</name></include>"
        write(
            f"m{i}/model.sdf",
            f'<sdf version="1.9"><model name="m"><link name="l"/>{inner.format("a")}{inner.format("b")}</model></sdf>',
        )
    write("m30/model.sdf", '<sdf version="1.9"><model name="m"><link name="l"/></model></sdf>')
    _, found = load(model("<include><uri>model://m0</uri></include>"), (tmp_path,))
    assert "SK-SDF-016" in codes(found)


@pytest.mark.parametrize("name", ["a/b", "a b", "名前", "..", "ä" * 100, "a\tb", "<", "'", "%s", "a:b"])
def test_unusual_names_are_accepted(load, name):
    from xml.sax.saxutils import quoteattr

    scene, found = load(
        f'<sdf version="1.9"><model name={quoteattr(name)}><link name={quoteattr(name)}/></model></sdf>'
    )
    assert not codes(found)
    assert scene.model.links[0].scoped == f"{scene.model.name}::{scene.model.links[0].name}"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ('<link name=""/>', "SK-SDF-001"),
        ('<link name="  "/>', "SK-SDF-001"),
        ("<link/>", "SK-SDF-001"),
        ('<link name="l"/>', "SK-SDF-002"),
        ('<link name="a::b"/>', "SK-SDF-003"),
        ('<link name="world"/>', "SK-SDF-003"),
        ('<link name="__x__"/>', "SK-SDF-003"),
        ('<frame name="f"/><frame name="f"/>', "SK-SDF-002"),
        ('<frame name="f"><pose>nan 0 0 0 0 0</pose></frame>', "SK-PARAM-002"),
        ('<frame name="f"><pose>1e308 0 0 0 0 0</pose></frame>', "SK-PARAM-002"),
        ('<frame name="f"><pose>inf 0 0 0 0 0</pose></frame>', "SK-PARAM-002"),
        ('<link name="k"><inertial><mass>1e308</mass></inertial></link>', "SK-PARAM-002"),
        ('<link name="k"><inertial><mass>inf</mass></inertial></link>', "SK-PARAM-002"),
    ],
)
def test_invalid_names_and_numbers_are_errors(load, text, code):
    _, found = load(model(text))
    assert codes(found) == [code]
