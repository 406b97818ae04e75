"""Malicious files, opened as a user opens them: exit code 0, 2 or 3, no traceback, in seconds and within 2 GiB."""

from __future__ import annotations

import os
import resource
import struct
import subprocess
import sys
import threading
import zlib
from collections.abc import Callable
from pathlib import Path
from xml.sax.saxutils import quoteattr

import pytest

import simkit
from simkit.input_file import read_input

ROOT = Path(__file__).resolve().parents[3]
WIDE = int(os.environ.get("SIMKIT_WIDEST", "200000"))  # siblings; a million of them take 20 s for each format
SECONDS = 60  # time limit on a busy machine; nearly all files take 1 s
LARGEST = 2 << 30  # [bytes]
WORLD = '<sdf version="1.9"><world name="w">{}</world></sdf>'
MODEL = WORLD.format('<model name="m"><static>{}</static>{}</model>')
LASER = """<link name="l"><sensor name={} type="{}"><update_rate>{}</update_rate><topic>{}</topic>
<{}>{}</{}></sensor></link>"""
SCAN = """<scan><horizontal><samples>{}</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal>
<vertical><samples>{}</samples><min_angle>-1</min_angle><max_angle>1</max_angle></vertical></scan>
<range><min>0.1</min><max>9</max></range>"""
IMAGE = """<horizontal_fov>1</horizontal_fov><image><width>{}</width><height>{}</height></image>
<clip><near>0.1</near><far>9</far></clip>"""
PICTURE_MODEL = (
    '<link name="l"><visual name="v"><geometry><box><size>1 1 1</size></box></geometry><material><pbr><metal>'
    "<albedo_map>{}</albedo_map></metal></pbr></material></visual></link>"
)


@pytest.fixture
def opened(tmp_path: Path) -> Callable[..., tuple[int, str]]:
    """Return a function opened(command, file, *options) that runs `simkit` and returns its exit code and output."""

    def _opened(command: str, file: object, *options: object) -> tuple[int, str]:
        done = subprocess.run(
            [sys.executable, "-c", _BOUNDED, str(LARGEST), command, str(file), *map(str, options)],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            capture_output=True,
            timeout=SECONDS,
            check=False,
        )
        text = (done.stdout + done.stderr).decode(errors="replace")
        assert "Traceback" not in text and "RuntimeWarning" not in text, text[-3000:]
        return done.returncode, text

    return _opened


_BOUNDED = """
import resource, sys
most = int(sys.argv.pop(1))
from simkit.cli import main
try:
    main()
finally:
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 < most, "Traceback: took too much memory"
"""


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str, str | bytes], Path]:
    def _write(name: str, content: str | bytes) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return _write


def errors(source: object, **options: object) -> list[str]:
    return [d.code for d in simkit.check(source, **options) if d.severity == "error"]  # type: ignore[arg-type]


# ---------------------------------------------------------------------- paths that are not files


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["/dev/zero", "/dev/null", ".", "/proc/self/mem", "nothing.sdf", "", "x" * 5000, "a\nb.sdf"]
)
def test_files_that_are_not_worlds_are_refused(opened, name):
    for command in ("check", "run", "inspect"):
        code, text = opened(command, name)
        assert code == 2 and "SK-" in text


def test_a_pipe_is_read_and_a_silent_pipe_times_out(tmp_path, monkeypatch):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    content = MODEL.format(0, '<link name="l"/>').encode()
    writer = threading.Thread(target=pipe.write_bytes, args=(content,))
    writer.start()
    assert read_input(pipe, 10_000, allow_pipe=True) == content
    writer.join()
    monkeypatch.setattr("simkit.input_file.PIPE_TIMEOUT", 0.2)
    assert errors(pipe) == ["SK-LOAD-002"]


def test_a_pipe_or_device_named_in_a_file_counts_as_missing(tmp_path, write):
    os.mkfifo(tmp_path / "m.stl")
    (tmp_path / "zero.dae").symlink_to("/dev/zero")
    shape = '<link name="l"><visual name="v"><geometry><mesh><uri>{}</uri></mesh></geometry></visual></link>'
    for name in ("m.stl", "zero.dae", "file:///dev/zero", "/dev/zero"):
        file = write("w.sdf", MODEL.format(0, shape.format(name)))
        found = [d for d in simkit.check(file) if d.severity != "note"]
        assert found and all(d.code.startswith("SK-URI") for d in found)


def test_a_sparse_file_of_two_gigabytes_is_refused(opened, tmp_path):
    file = tmp_path / "w.sdf"
    file.touch()
    os.truncate(file, 2 << 30)
    code, text = opened("check", file)
    assert code == 2 and "SK-XML-002" in text


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is denied to root")
def test_a_file_without_read_permission_is_an_error(write, tmp_path):
    file = write("closed/w.sdf", WORLD)
    file.chmod(0)
    assert errors(file) == ["SK-LOAD-002"]
    file.parent.chmod(0)
    try:
        assert errors(file) == ["SK-LOAD-002"]
        assert errors(file.parent) == ["SK-URI-005"]
        assert errors(write("w.sdf", WORLD.format("<include><uri>model://closed</uri></include>"))) == ["SK-URI-005"]
    finally:
        file.parent.chmod(0o700)


# ---------------------------------------------------------------------- folders outside the resource folders


@pytest.mark.parametrize(
    "uri",
    ["/etc/passwd", "file:///etc/passwd", "../../../../etc/passwd", "model://../../etc/passwd", "model://m/../../../etc/passwd",
     "package://../etc/passwd", "file://../../../../etc/passwd", "%2e%2e/%2e%2e/%2e%2e/%2e%2e/etc/passwd",
     "http://127.0.0.1:9/x.sdf", "ftp://127.0.0.1/x.sdf", "https://127.0.0.1:9/a/models/b", "data:text/xml,<sdf/>",
     "\\\\host\\x",
     "~/.profile", "$HOME/.profile", "file://localhost/etc/passwd", "model://m/%2e%2e/%2e%2e/etc/passwd"],
)  # fmt: skip
@pytest.mark.parametrize(
    "content",
    [
        "<include><uri>{}</uri></include>",
        '<model name="m"><static>1</static><link name="l"><collision name="c"><geometry>'
        "<mesh><uri>{}</uri></mesh></geometry>"
        "</collision></link></model>",
        '<model name="m"><static>1</static><link name="l"><collision name="c"><geometry>'
        "<heightmap><uri>{}</uri></heightmap>"
        "</geometry></collision></link></model>",
    ],
    ids=["include", "mesh", "heightmap"],
)
def test_no_file_outside_the_folders_is_read_or_downloaded(write, uri, content):
    file = write("world/inner/w.sdf", WORLD.format(content.format(uri.replace("<", "&lt;"))))
    found = list(simkit.check(file))
    assert [d for d in found if d.code.startswith("SK-URI") and d.severity != "note"]
    assert not any("root:" in d.message for d in found)


@pytest.mark.parametrize(
    "line",
    [
        '<xacro:include filename="/etc/passwd"/>',
        '<xacro:include filename="../../../../../../etc/passwd"/>',
        '<xacro:property name="x" value="${xacro.load_yaml(\'/etc/passwd\')}"/><link name="${x}"/>',
        '<xacro:property name="x" value="${open(\'/etc/passwd\').read()}"/><link name="${x}"/>',
        '<xacro:property name="x" value="${__import__(\'os\').system(\'true\')}"/><link name="${x}"/>',
        '<xacro:property name="x" value="${().__class__.__bases__}"/><link name="${x}"/>',
        '<link name="$(env HOME)"/><xacro:include filename="$(env HOME)/x.xacro"/>',
        '<link name="${9**9**9**9}"/>',
        "<link name=\"${'a' * 10**10}\"/>",
        '<link name="${[x for x in range(10**10)]}"/>',
        '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>',
        '<xacro:macro name="m"><xacro:n/><xacro:n/></xacro:macro>'
        '<xacro:macro name="n"><xacro:m/><xacro:m/></xacro:macro><xacro:m/>',
        '<xacro:include filename="r.xacro"/>',
    ],
)
def test_a_xacro_file_cannot_read_outside_its_folders_or_run_code(write, line):
    text = f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/>{line}</robot>'
    found = list(simkit.check(write("a/b/r.xacro", text)))
    assert any(d.severity == "error" for d in found)
    assert not any("root:" in d.message for d in found)


def test_a_link_inside_a_folder_is_followed_as_in_a_workspace_of_links(write, tmp_path):
    """The target of a link is read like a file in the folder: here one target is a model, and the other is refused."""
    write("elsewhere/robot.sdf", '<sdf version="1.9"><model name="far"><link name="l"/></model></sdf>')
    write("secret.txt", "password")
    write("models/m/model.config", "<model><sdf version='1.9'>model.sdf</sdf></model>")
    (tmp_path / "models/m/model.sdf").symlink_to(tmp_path / "elsewhere/robot.sdf")
    write("models/n/model.config", "<model><sdf version='1.9'>model.sdf</sdf></model>")
    (tmp_path / "models/n/model.sdf").symlink_to(tmp_path / "secret.txt")
    both = "<include><uri>model://m</uri></include><include><uri>model://n</uri></include>"
    found = list(simkit.check(write("w.sdf", WORLD.format(both)), resource_paths=[tmp_path / "models"]))
    assert [d.code for d in found if d.severity == "error"] == ["SK-XML-005"]
    assert not any("password" in str(d) for d in found)


# ---------------------------------------------------------------------- circular includes, expanding entities


def test_circular_includes_through_other_formats_are_an_error(write, tmp_path):
    xacro = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
    write("one.xacro", xacro.format('<xacro:include filename="two.xacro"/>'))
    write("two.xacro", xacro.format('<xacro:include filename="one.xacro"/>'))
    assert errors(tmp_path / "one.xacro")
    write(
        "a/model.sdf", WORLD.replace("world", "model").format('<link name="l"/><include><uri>model://b</uri></include>')
    )
    write("b/b.urdf", xacro.format('<link name="k"/><gazebo><include><uri>model://a</uri></include></gazebo>'))
    assert all(c.startswith("SK-") for c in errors(tmp_path / "a/model.sdf"))
    write("m.xml", '<mujoco model="m"><include file="n.xml"/></mujoco>')
    write("n.xml", '<mujocoinclude><include file="m.xml"/></mujocoinclude>')
    assert errors(tmp_path / "m.xml")
    write(
        "p.xml",
        '<mujoco><asset><model name="p" file="p.xml"/></asset>'
        '<worldbody><attach model="p" prefix="x"/></worldbody></mujoco>',
    )
    assert errors(tmp_path / "p.xml")


LAUGHS = "<!DOCTYPE x [<!ENTITY a 'ha'>" + "".join(
    f"<!ENTITY {n} '{f'&{m};' * 10}'>" for m, n in zip("abcdefghi", "bcdefghij", strict=True)
)


@pytest.mark.parametrize("root", ["sdf", "robot", "mujoco"])
@pytest.mark.parametrize(
    "declared",
    [LAUGHS, '<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">',
     '<!DOCTYPE x [<!ENTITY % a SYSTEM "http://127.0.0.1:9/a"> %a;'],
    ids=["laughs", "file", "network"],
)  # fmt: skip
def test_entities_are_refused_in_every_format(declared, root):
    assert errors(f"{declared}]><{root} name='&a;'/>") == ["SK-XML-003"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["model.config", "parts.xacro", "package.xml", "inner.xml"])
def test_entities_are_refused_in_every_referenced_file(write, tmp_path, name):
    """The entity in the file would expand to ten thousand million words."""
    bomb = f"{LAUGHS}]><x>&j;</x>"
    write(f"m/{name}", bomb)
    write("m/w.sdf", WORLD.format("<include><uri>model://m</uri></include>"))
    write(
        "m/r.xacro",
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="parts.xacro"/></robot>',
    )
    write("m/i.xml", '<mujoco><include file="inner.xml"/></mujoco>')
    for main in ("m/w.sdf", "m/r.xacro", "m/i.xml"):
        simkit.check(tmp_path / main)


@pytest.mark.slow
@pytest.mark.parametrize("suffix, root", [(".urdf", "robot"), (".xml", "mujoco"), (".xacro", "robot"), (".sdf", "sdf")])
@pytest.mark.parametrize("shape", ["deep", "wide"])
def test_a_million_nested_or_sibling_elements_are_handled_quickly(opened, write, suffix, root, shape):
    inner = "<link>" * 1_000_000 if shape == "deep" else '<link name="l"/>' * WIDE
    code, text = opened("check", write(f"x{suffix}", f"<{root}>{inner}</{root}>"))
    assert code == 2 and "SK-" in text


@pytest.mark.slow
def test_thousands_of_unknown_names_are_handled_quickly(write):
    links = "".join(f'<link name="link_{i}"/>' for i in range(6_000))
    frames = "".join(f'<frame name="f{i}" attached_to="lonk_{i}"/>' for i in range(6_000))
    found = list(simkit.check(MODEL.format(0, links + frames)))
    assert found[-1].code == "SK-LOAD-012" and len(found) < 1100
    joints = "".join(
        f'<joint name="j{i}" type="fixed"><parent link="x{i}"/><child link="y{i}"/></joint>' for i in range(2000)
    )
    assert "SK-LOAD-012" in errors(f'<robot name="r">{links[:20_000].rpartition("<link")[0]}{joints}</robot>')


def png(width: int, height: int, rows: bytes) -> bytes:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


@pytest.mark.slow
@pytest.mark.parametrize("content", [PICTURE_MODEL.format("p.png"), '<link name="l">'
    '<collision name="c"><geometry><heightmap>'
    "<uri>p.png</uri></heightmap></geometry></collision></link>"], ids=["texture", "heightmap"])  # fmt: skip
@pytest.mark.parametrize("size", [60_000, 2_000_000_000])
def test_an_image_that_unpacks_to_gigabytes_is_refused(opened, write, content, size):
    write("p.png", png(size, size, zlib.compress(b"\0" * 50_000_000, 9)))
    code, text = opened("check", write("w.sdf", MODEL.format(1, content)))
    assert code in (0, 2) and ("SK-MESH" in text or "SK-SDF" in text or "SK-URI" in text)


def test_an_stl_header_that_declares_a_thousand_million_triangles_is_left_out(opened, write):
    write("m.stl", b"\0" * 80 + struct.pack("<I", 1_000_000_000) + b"\0" * 500)
    shape = '<link name="l"><visual name="v"><geometry><mesh><uri>m.stl</uri></mesh></geometry></visual></link>'
    code, text = opened("run", write("w.sdf", MODEL.format(0, shape)), "--duration", "0.002")
    assert code == 0 and "SK-MESH-001" in text


# ---------------------------------------------------------------------- counts and rates


def laser(kind: str, horizontal: int, vertical: int) -> str:
    tag = "ray" if kind == "ray" else "lidar"
    return LASER.format('"s"', kind, 1000, "scan", tag, SCAN.format(horizontal, vertical), tag)


def camera(kind: str, width: int, height: int) -> str:
    return LASER.format('"s"', kind, 1000, "image", "camera", IMAGE.format(width, height), "camera")


@pytest.mark.parametrize("kind", ["lidar", "ray", "gpu_lidar"])
@pytest.mark.parametrize("counts", [(10**9, 1), (10**5, 10**5), (1, 10**9), (10**30, 10**30)])
def test_a_thousand_million_rays_are_refused(kind, counts):
    assert errors(MODEL.format(0, laser(kind, *counts))) == ["SK-PARAM-002"]


@pytest.mark.parametrize("kind", ["camera", "depth_camera", "rgbd_camera"])
@pytest.mark.parametrize("size", [(10**6, 10**6), (10**9, 1), (20_000, 20_000)])
def test_a_huge_camera_image_is_refused(kind, size):
    assert errors(MODEL.format(0, camera(kind, *size))) == ["SK-PARAM-002"]


@pytest.mark.parametrize("rate", ["1e9", "1e-9", "1e300", "1e-300", "0"])
def test_any_update_rate_is_accepted_or_refused(rate):
    sensor = f'<link name="l"><sensor name="s" type="imu"><update_rate>{rate}</update_rate></sensor></link>'
    with simkit.load(MODEL.format(0, sensor)) as sim:
        sim.step(20)
    assert not errors(MODEL.format(0, sensor))


@pytest.mark.parametrize("step", ["1e-12", "1e9", "1e-320", "0", "-1", "nan", "inf"])
def test_an_invalid_step_size_is_refused(step):
    world = WORLD.format(f'<physics name="p"><max_step_size>{step}</max_step_size></physics>')
    assert errors(world) == ["SK-PARAM-002"]
    mjcf = f'<mujoco><option timestep="{step}"/><worldbody><geom size="1"/></worldbody></mujoco>'
    assert errors(mjcf)
    with pytest.raises(simkit.InputError):
        simkit.load(WORLD.format(""), overrides=[f"physics.max_step_size={step}"])


COPIES = '<population name="p"><model name="m"><link name="l"/></model><model_count>{}</model_count>{}</population>'


@pytest.mark.parametrize("count", ["1000000000", "1e300", "-1", "nan"])
def test_a_thousand_million_copies_are_refused(count):
    box = "<box><size>1 1 1</size></box><distribution><type>random</type></distribution>"
    assert errors(WORLD.format(COPIES.format(count, box)))[0] in ("SK-SDF-033", "SK-PARAM-002")
    rows = f"<distribution><type>grid</type><rows>{count}</rows><cols>{count}</cols><step>1 1 0</step></distribution>"
    assert errors(WORLD.format(COPIES.format(4, rows)))[0] in ("SK-SDF-033", "SK-PARAM-002")


def test_more_moving_bodies_than_mujoco_compiles_in_a_minute_are_refused(monkeypatch):
    monkeypatch.setattr("simkit.compiler.model_compilation.MOST_MOVING", 50)
    box = "<box><size>1 1 1</size></box><distribution><type>random</type></distribution>"
    assert errors(WORLD.format(COPIES.format(60, box))) == ["SK-PHYS-029"]


# ---------------------------------------------------------------------- names

NAMES = [
    "a/b",
    "a b",
    "名前",
    "ü\U0001f916",
    "a\tb",
    "..",
    "/",
    "-",
    "%s",
    "{}",
    "a.b",
    "9",
    "$(x)",
    "x" * 200,
    "<",
    "\u202e",
    "~",
]


@pytest.mark.parametrize("name", NAMES)
def test_topics_with_unusual_names_are_recorded_and_read_back(tmp_path, name):
    quoted = quoteattr(name)
    plugin = '<plugin filename="gz-sim-joint-state-publisher-system" name="p"/>'
    plugin += '<plugin filename="gz-sim-odometry-publisher-system" name="o"/>'
    world = f"""<sdf version="1.9"><world name={quoted}><model name={quoted}><link name={quoted}>
    <sensor name={quoted} type="imu">    <update_rate>500</update_rate></sensor></link>{plugin}</model></world></sdf>"""
    from simkit.recording.bags.recorder import Recorder

    with simkit.load(world) as sim, Recorder(sim, tmp_path / "bag.mcap") as recording:
        sim.run(0.02)
        assert recording.message_count > 0
        for topic in sim.topics():
            assert topic.startswith("/") and "//" not in topic and topic.isprintable() and " " not in topic
    from mcap.reader import make_reader

    with (tmp_path / "bag.mcap").open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None and summary.statistics is not None and summary.statistics.message_count > 0


@pytest.mark.parametrize(
    "topic", ["", "/", "//", "a b", "../x", "名前", "x" * 10_000, "a//b/", "%n", "~/x", "a\nb", "{ns}", "/a/../b"]
)
def test_invalid_topic_names_are_refused_or_corrected(tmp_path, topic):
    sensor = LASER.format('"s"', "lidar", 500, topic, "lidar", SCAN.format(3, 1), "lidar")
    world = MODEL.format(0, sensor)
    if not errors(world):
        with simkit.load(world) as sim:
            sim.run(0.01)
            assert all(t.startswith("/") and t.isascii() and t.isprintable() for t in sim.topics())


def test_the_memory_of_this_process_stays_small():
    """The limit applies to all tests above that ran in this process, together with MuJoCo and other libraries."""
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 < LARGEST


# ---------------------------------------------------------------------- folders near the file


@pytest.fixture
def neighbours(write):
    """Return a maker of `people/alice/proj/worlds/w.sdf`, which includes a URI; a model of bob is in `people`."""
    for name in ("people/bob/private/model.sdf", "people/alice/proj/secret/model.xml", "people/alice/notes/model.xml"):
        write(name, '<sdf version="1.9"><model name="m"><link name="l"/></model></sdf>')

    def _world(uri: str) -> Path:
        return write("people/alice/proj/worlds/w.sdf", WORLD.format(f"<include><uri>{uri}</uri></include>"))

    return _world


@pytest.mark.parametrize(
    "uri",
    [
        "model://people/bob/private",
        "model://people/bob/private/model.sdf",
        "package://people/bob/private/model.sdf",
        "package://anything/bob/private/model.sdf",
        "package://anything/secret/model.xml",
        "model://alice/notes/model.xml",
        "model://proj/secret/model.xml",
        "model://secret/model.xml",
    ],
)
def test_a_world_opens_no_folder_near_it_that_is_neither_a_model_nor_a_package(neighbours, uri):
    assert errors(neighbours(uri)) == ["SK-URI-009" if uri.startswith("package") else "SK-URI-001"]


@pytest.mark.parametrize("manifest", ["model.config", "package.xml"])
def test_a_world_finds_its_own_model_or_package_by_the_name_of_the_folder(neighbours, write, manifest):
    write(f"people/alice/proj/{manifest}", "<package><name>proj</name></package>")
    assert errors(neighbours("model://proj/secret/model.xml")) == []
