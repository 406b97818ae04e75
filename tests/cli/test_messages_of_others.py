"""Messages that users of MuJoCo, Gazebo and ROS meet: simkit meets the same cause, names it once, and says what helps.

Each row provokes the cause of one message. Its text is also asked of the documentation's search, which `docs/site/
check_search.mjs` does with the built site.
"""

from __future__ import annotations

import ctypes.util
import json
import os
import shlex
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import pytest

import simkit
from simkit.sensors.cameras.rendering import gl_context

ROOT = Path(__file__).resolve().parents[2]
SEARCH = ROOT / "docs" / "site" / "check_search.mjs"

FLAT = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
SCREEN = {"DISPLAY": "", "WAYLAND_DISPLAY": ""}
# a vendor list that names no file leaves the EGL library without drivers
NO_DRIVER = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent.json", "__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent"}


def link(name: str, inertial: str = "1 0.01 0.01 0.01", shape: str = "") -> str:
    """Return a link of a URDF; the inertial is its mass and its three moments, or empty."""
    mass, xx, yy, zz = inertial.split() or [""] * 4
    tensor = f"<inertia ixx='{xx}' iyy='{yy}' izz='{zz}' ixy='0' ixz='0' iyz='0'/>"
    inside = f"<inertial><mass value='{mass}'/>{tensor}</inertial>" if mass else ""
    return f"<link name='{name}'>{inside}{shape}</link>"


def joint(child: str, kind: str = "continuous", more: str = "") -> str:
    parts = f"<parent link='base'/><child link='{child}'/><axis xyz='0 1 0'/>{more}"
    return f"<joint name='hinge' type='{kind}'>{parts}</joint>"


def collision(geometry: str) -> str:
    return f"<collision><geometry>{geometry}</geometry></collision>"


def urdf(*lines: str) -> dict[str, str]:
    return {"a.urdf": "\n".join(["<robot name='bot'>", *lines, "</robot>"])}


def sdf(*lines: str) -> dict[str, str]:
    return {"a.sdf": "\n".join(["<sdf version='1.9'><world name='w'>", *lines, "</world></sdf>"])}


def mjcf(body: str) -> dict[str, str]:
    return {"a.xml": f"<mujoco><worldbody>\n<body name='b'>{body}</body></worldbody></mujoco>"}


CAMERA = sdf(
    "<include><uri>model://sun</uri></include><model name='m'><static>true</static><link name='l'>",
    "<sensor name='c' type='camera'><update_rate>10</update_rate><topic>image</topic>",
    "<camera><image><width>32</width><height>24</height></image></camera></sensor>",
    "<sensor name='s' type='lidar'><update_rate>10</update_rate><topic>scan</topic>",
    "<lidar><range><min>0.1</min><max>5</max></range></lidar></sensor></link></model>",
)
DRAW = """run a.sdf --duration 0.1 -q --assert "count('/image') > 0" --assert "count('/scan') > 0" """
DRAWN = ("passed count('/image') > 0", "passed count('/scan') > 0")
SWING = sdf(
    "<model name='m'><link name='base'/><link name='c'><pose>0.2 0 0 0 0 0</pose></link><link name='d'/>",
    "<joint name='fix' type='fixed'><parent>world</parent><child>base</child></joint>",
    "<joint name='a' type='revolute'><parent>base</parent><child>c</child><pose>-0.2 0 0 0 0 0</pose>",
    "<axis><xyz>0 1 0</xyz></axis></joint>",
    "<joint name='b' type='revolute'><parent>base</parent><child>d</child><axis><xyz>0 1 0</xyz>",
    "<mimic joint='a'><multiplier>2</multiplier><offset>0</offset><reference>0</reference></mimic></axis></joint>",
    "</model>",
)
BROKEN_CORE = {
    "stub/mujoco/__init__.py": Path(mujoco.__file__).read_text(encoding="utf-8"),
    "stub/mujoco/_version.py": "raise ModuleNotFoundError('gone', name='mujoco._version')",
}
FUEL = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Table"


@dataclass(frozen=True)
class Row:
    """Cause of one message.

    Attributes:
        number: number of the message; several rows may have the same.
        text: text of the other program, as a user types it into the search.
        files: files by their paths.
        line: command line of simkit.
        exit_code: exit code of the command.
        printed: texts that are printed exactly once.
        environments: environment variables of each run in a process of its own; empty: it runs in this process.
        is_silent: nothing is printed on standard error.
    """

    number: int
    text: str
    files: dict[str, str]
    line: str = "check a.urdf"
    exit_code: int = 0
    printed: tuple[str, ...] = ()
    environments: tuple[dict[str, str], ...] = ()
    is_silent: bool = field(default=False, kw_only=True)


ROWS = [
    Row(
        1,
        "Error: mass and inertia of moving bodies must be larger than mjMINVAL Element name 'c', id 2",
        urdf(link("base"), link("c", ""), joint("c")),
        printed=(
            "a.urdf:4: warning SK-JOINT-016: joint bot::hinge (continuous) of link bot::c moves no mass",
            "help: give the link an <inertial>, or make the joint fixed",
        ),
    ),
    Row(
        1,
        "Error: mass and inertia of moving bodies must be larger than mjMINVAL Element name 'c', id 2",
        mjcf("<joint/>"),
        "check a.xml",
        2,
        ("a.xml:2: error SK-MJCF-001", "help: give the body an <inertial>, or a geom with mass"),
    ),
    Row(
        2,
        "Error: error 'inertia must have positive eigenvalues' in fullinertia",
        urdf(link("base", "1 -0.01 0.01 0.01")),
        exit_code=2,
        printed=(
            "a.urdf:2: error SK-INERTIA-002: link bot::base of 1 kg: principal moments (-0.01, 0.01, 0.01) kg m2",
            "check the signs on the diagonal",
            "help: simkit check --fix-inertia",
        ),
    ),
    Row(
        2,
        "Error: error 'inertia must have positive eigenvalues' in fullinertia",
        urdf(link("base", "1 1e-18 1e-18 1e-18", collision("<box size='0.1 0.1 0.1'/>"))),
        printed=(
            "a.urdf:2: warning SK-PHYS-011: link bot::base: principal moments (1e-18, 1e-18, 1e-18) kg m2",
            "(0.001667, 0.001667, 0.001667) are used, which are those of its collisions at 1 kg",
        ),
    ),
    Row(
        3,
        "Error: inertia must satisfy A + B >= C; use 'balanceinertia' to fix",
        urdf(link("base", "1 0.01 0.01 0.05")),
        printed=(
            "a.urdf:2: warning SK-INERTIA-001: link bot::base: principal moments (0.01, 0.01, 0.05) kg m2",
            "A + B falls short of C by 60 % of C",
        ),
    ),
    Row(
        3,
        "Error: inertia must satisfy A + B >= C; use 'balanceinertia' to fix",
        urdf(link("base", "1 0.01 0.01 0.02005")),
        printed=("a.urdf:2: note SK-INERTIA-001: ", "A + B falls short of C by 0.249 % of C"),
    ),
    Row(
        4,
        "Error opening file 'package:/foo_description/meshes/base.stl'",
        urdf(link("base", shape=collision("<mesh filename='package://foo_description/meshes/base.stl'/>"))),
        printed=(
            "a.urdf:2: warning SK-URI-009: package://foo_description/meshes/base.stl: "
            "the package 'foo_description' is not found; searched below /",
            "help: give its folder, --package-path foo_description=DIR",
        ),
    ),
    Row(
        4,
        "Error: Error opening file 'base.stl': No such file or directory",
        urdf(link("base", shape=collision("<mesh filename='base.stl'/>"))),
        printed=("a.urdf:2: warning SK-URI-001: base.stl is not found; searched /", "help: add its folder with"),
    ),
    Row(
        5,
        "Error: Error opening file 'base.dae', Unknown mesh file type",
        urdf(link("base", shape=collision("<mesh filename='base.dae'/>"))) | {"base.dae": "no XML"},
        printed=("a.urdf:2: warning SK-MESH-001: base.dae: is not readable as XML",),
    ),
    Row(
        6,
        "XML Error: URDF joint parent or child missing Element 'joint', line 1",
        urdf(link("base"), link("wheel"), joint("whel")),
        exit_code=2,
        printed=(
            "a.urdf:4: error SK-URDF-003: joint 'hinge': the child link 'whel' does not exist",
            "help: did you mean 'wheel'?",
        ),
    ),
    Row(
        7,
        "XML Error: repeated URDF name:",
        urdf(link("base"), link("base")),
        exit_code=2,
        printed=(
            "a.urdf:3: error SK-URDF-002: two links are named 'base' (the other at line 2)",
            "help: rename one of them",
        ),
    ),
    Row(
        8,
        "Error: repeated name in mesh array",
        urdf(link("base", shape="".join(collision(f"<mesh filename='{place}/plate.obj'/>") for place in "ab")))
        | {f"{place}/plate.obj": FLAT for place in "ab"},
        printed=("note SK-MESH-007: a/plate.obj", "note SK-MESH-007: b/plate.obj", "0 errors, 0 warnings, 3 notes"),
    ),
    Row(
        9,
        "XML Error: bad format in attribute 'size'",
        urdf(link("base", shape=collision("<box size='${width} 1 1'/>"))),
        exit_code=2,
        printed=(
            "a.urdf:2: warning SK-XML-006: the text '${width}' was not filled in",
            'a.urdf:2: error SK-URDF-013: <box size="${width} 1 1">: expected 3 numbers',
        ),
    ),
    Row(
        10,
        "Error: size 0 must be positive in geom Element name ''",
        urdf(link("base", shape=collision("<box size='0 1 1'/>"))),
        printed=("a.urdf:2: warning SK-URDF-028: collision 'base_collision' of link 'base': <box> has size 0 1 1",),
    ),
    Row(
        10,
        "Error: size 0 must be positive in geom Element name ''",
        urdf(link("base", "", collision("<sphere radius='nan'/>"))),
        exit_code=2,
        printed=('a.urdf:2: error SK-URDF-013: <sphere radius="nan">: expected a number', "radius"),
    ),
    Row(
        10,
        "Error: size 0 must be positive in geom Element name ''",
        mjcf("<geom size='0'/>"),
        "check a.xml",
        2,
        ("size 0 must be positive in geom (element 'b_geom0')", "help: give each number of size a value above 0"),
    ),
    Row(
        11,
        "mesh volume is too small. Try setting inertia to shell",
        urdf(link("base", shape=collision("<mesh filename='plate.obj'/>"))) | {"plate.obj": FLAT},
        printed=("a.urdf:2: note SK-MESH-007: plate.obj is flat: it collides as a thin plate",),
    ),
    Row(
        12,
        "free joint can only be used on top level",
        mjcf("<geom size='1'/>\n<body name='c'><freejoint/><geom size='1'/></body>"),
        "check a.xml",
        2,
        ("error SK-MJCF-001: MuJoCo refuses the file: free joint can only", "help: move its body into <worldbody>"),
    ),
    Row(
        12,
        "free joint can only be used on top level",
        urdf(link("base"), link("c"), joint("c", "floating")),
        printed=("0 errors, 0 warnings, 1 note",),
    ),
    Row(
        12,
        "free joint can only be used on top level",
        sdf(
            "<model name='m'><link name='base'/><link name='c'/>",
            "<joint name='j' type='floating'><parent>base</parent><child>c</child></joint></model>",
        ),
        "check a.sdf",
        2,
        ("a.sdf:3: error SK-SDF-008: joint 'j' has unknown type 'floating'", "help: remove the joint: a link without"),
    ),
    Row(
        13,
        "URDF mimic dropped, gazebo and transmission ignored, two roots, misspelt tag",
        urdf(
            *(link(name) for name in ("base", "c", "d")),
            joint("c", more="<mimic joint='none'/>"),
            "<gazebo reference='nowhere'/>",
            "<transmission name='t'><joint name='hinge'/></transmission>",
            "<colision/>",
        ),
        exit_code=2,
        printed=(
            "a.urdf:4: error SK-URDF-006: robot 'bot' has 2 root links, but can have only one",
            "a.urdf:5: warning SK-URDF-015: joint 'hinge' mimics 'none', which does not exist",
            "a.urdf:6: warning SK-URDF-021: <gazebo reference='nowhere'>",
            "a.urdf:7: warning SK-URDF-025: transmission 't' needs <type>",
            "a.urdf:8: warning SK-URDF-010: <robot> has no element <colision>",
        ),
    ),
    Row(
        14,
        "WARNING: Nan, Inf or huge value in QACC at DOF 6. The simulation is unstable. Time = 0.0100.",
        sdf(
            "<model name='m'><link name='l'/><link name='c'><inertial><mass>1</mass><inertia><ixx>1e-6</ixx>",
            "<iyy>1e-6</iyy><izz>1e-6</izz></inertia></inertial></link>",
            "<joint name='fix' type='fixed'><parent>world</parent><child>l</child></joint>",
            "<joint name='hinge' type='revolute'><parent>l</parent><child>c</child><axis><xyz>0 0 1</xyz><dynamics>",
            "<spring_stiffness>1e8</spring_stiffness><spring_reference>1</spring_reference></dynamics></axis></joint>",
            "</model>",
        ),
        "run a.sdf --duration 1",
        3,
        (
            "error: SK-PHYS-001 the simulation diverged at t=0 s in 'm::hinge'",
            "a gain, a force or a stiffness is too large for the step of 0.001 s; try a smaller max_step_size",
        ),
    ),
    Row(
        15,
        "mujoco.FatalError: an OpenGL platform library has not been loaded into this process, "
        "GLFWError: (65537) b'The GLFW library is not initialized'",
        CAMERA,
        DRAW,
        printed=("note: SK-RENDER-015 images are drawn by the software renderer", "apt install libegl1", *DRAWN),
        environments=(SCREEN | NO_DRIVER, SCREEN | {"MUJOCO_GL": "glfw"}),
    ),
    Row(
        16,
        "RuntimeError: invalid value for environment variable MUJOCO_GL: foo",
        CAMERA,
        DRAW,
        printed=(
            "SK-RENDER-016: MUJOCO_GL=foo: unknown renderer; expected egl, osmesa, glfw, glx, cgl, wgl or disable",
            "help: unset MUJOCO_GL; here ",
            *DRAWN,
        ),
        environments=({"MUJOCO_GL": "foo"}, {"MUJOCO_GL": "foo", "PYOPENGL_PLATFORM": "foo"}),
    ),
    Row(
        16,
        "RuntimeError: invalid value for environment variable MUJOCO_GL: foo",
        CAMERA,
        DRAW + "--renderer software",
        printed=("SK-RENDER-016: MUJOCO_GL=foo: unknown renderer; expected egl, osmesa", *DRAWN),
        environments=({"MUJOCO_GL": "foo"},),
    ),
    Row(
        17,
        "ctypes.ArgumentError No array-type handler for type builtins.NoneType",
        CAMERA,
        DRAW,
        printed=("(osmesa: libOSMesa not found)", "(or libosmesa6)", *DRAWN),
        environments=({"MUJOCO_GL": "osmesa"}, {"PYOPENGL_PLATFORM": "osmesa"}),
    ),
    Row(
        18,
        "OpenGL.raw.EGL._errors.EGLError: <exception str() failed>",
        CAMERA,
        DRAW,
        printed=DRAWN,
        environments=({}, {"MUJOCO_GL": "egl"}),
        is_silent=True,
    ),
    Row(
        19,
        "ImportError: Cannot initialize a headless EGL display.",
        CAMERA,
        DRAW,
        printed=(
            "note: SK-RENDER-015 images are drawn by the software renderer: OpenGL cannot be opened (egl: ",
            *DRAWN,
        ),
        environments=(NO_DRIVER | {"MUJOCO_GL": "egl"},),
    ),
    Row(
        19,
        "AttributeError: 'GLXPlatform' object has no attribute 'EGL'",
        CAMERA,
        DRAW,
        printed=DRAWN,
        environments=({"PYOPENGL_PLATFORM": "glx"}, {"PYOPENGL_PLATFORM": "glx", "MUJOCO_GL": "egl"}),
        is_silent=True,
    ),
    Row(
        19,
        "gladLoadGL error",
        CAMERA,
        DRAW + "--renderer software",
        printed=DRAWN,
        environments=(SCREEN | NO_DRIVER,),
        is_silent=True,
    ),
    Row(
        20,
        "ImportError: The 'mujoco' package is installed, but its core bindings ('mujoco-core') are missing",
        BROKEN_CORE,
        "doctor",
        1,
        (
            "SK-CORE-005 MuJoCo cannot be imported (The 'mujoco' package is installed, but its core bindings",
            "help: python -m pip install --force-reinstall 'mujoco>=4.0,<5'",
        ),
        ({"PYTHONPATH": "stub"},),
    ),
    Row(
        21,
        "TypeError: mj_multiRay(): incompatible function arguments",
        CAMERA,
        """run a.sdf --duration 0.1 --assert "count('/scan') > 0" """,
        printed=("passed count('/scan') > 0",),
        is_silent=True,
    ),
    Row(
        22,
        "Error Code 13: Msg: Unable to find uri[model://sun]",
        sdf(
            "<include><uri>model://sun</uri></include>",
            *(f"<include><name>{name}</name><uri>model://suun</uri></include>" for name in "ab"),
        ),
        "check a.sdf",
        printed=("a.sdf:3: warning SK-URI-001: model://suun is not found; searched /", "help: did you mean 'sun'?"),
    ),
    Row(
        23,
        "Failed to download model. REST response code: 504",
        sdf(f"<include><uri>{FUEL}</uri></include>"),
        "run a.sdf --duration 0",
        2,
        (
            f"a.sdf:2: error SK-URI-002: {FUEL} is not on this machine and nothing is downloaded",
            "help: download it with `simkit fetch a.sdf`",
        ),
    ),
    Row(
        24,
        "A model must have at least one link.",
        sdf("<model name='m'/>"),
        "run a.sdf --duration 0",
        2,
        ("a.sdf:2: error SK-SDF-006: model 'm' has no link", "help: add a <link>", "1 error; nothing was run"),
    ),
    Row(
        25,
        "XML Element[scene], child of element[sdf], not defined in SDF. Copying[scene] as children of [sdf].",
        {"a.sdf": "<sdf version='1.9'><world name='w'/>\n<scene/></sdf>"},
        "check a.sdf",
        printed=("a.sdf:2: warning SK-SDF-011: <sdf> has no element <scene>", "help: move it inside <world>"),
    ),
    Row(
        26,
        "Attempting to create a mimic constraint for joint but the chosen physics engine does not support mimic",
        SWING,
        """run a.sdf --duration 0.3 --assert "joint('a').position > 0.01"
            --assert "-0.001 < joint('b').position - 2 * joint('a').position < 0.001" """,
        printed=("passed joint('a').position > 0.01", "passed -0.001 < joint('b').position"),
    ),
    Row(
        27,
        "[Err] [Ogre2RenderEngine.cc:1131] Unable to create the rendering window: OGRE EXCEPTION"
        "(3:RenderingAPIException): OpenGL 3.3 is not supported",
        CAMERA,
        DRAW + "--picture a.png --renderer software",
        printed=DRAWN,
        environments=(SCREEN | NO_DRIVER,),
        is_silent=True,
    ),
    Row(
        28,
        "RLException: Invalid <arg> tag: environment variable 'TURTLEBOT3_MODEL' is not set.",
        sdf("<include><uri>model://turtlebot3</uri></include>"),
        "check a.sdf",
        printed=(
            "a.sdf:2: note SK-URI-008: TURTLEBOT3_MODEL is not set; the robot is a waffle",
            "help: set TURTLEBOT3_MODEL to burger, waffle, waffle_pi",
        ),
    ),
    Row(
        28,
        "KeyError: 'TURTLEBOT3_MODEL'",
        {"a.launch": "<launch>\n<arg name='model' default='$(env TURTLEBOT3_MODEL)'/></launch>"},
        "launch a.launch --print -v",
        printed=("a.launch:2: note SK-LAUNCH-021: the environment variable TURTLEBOT3_MODEL is not set; 'waffle' is",),
    ),
    Row(
        31,
        "XacroException: substitution args not supported: No module named 'roslaunch'",
        {
            "bot/a.urdf.xacro": "<robot name='bot' xmlns:xacro='http://www.ros.org/wiki/xacro'>"
            "<xacro:include filename='$(find bot)/b.xacro'/></robot>",
            "bot/b.xacro": f"<robot>{link('base')}</robot>",
            "bot/package.xml": "<package><name>bot</name></package>",
        },
        "check bot/a.urdf.xacro",
        printed=("0 errors, 0 warnings, 1 note",),
    ),
]
LIVE = {
    29: "Service /spawn_entity unavailable. Was Gazebo started with GazeboRosFactory?",
    30: "Service /controller_manager/list_controllers not available. Controller manager not available",
    32: "Warning: TF_OLD_DATA ignoring data from the past",
}
"""Messages whose cause is a simulation in another process; the tests below ask one."""


@pytest.mark.parametrize(
    "row",
    [
        pytest.param(
            row,
            id=f"{row.number}-{row.line.split()[0]}",
            marks=[pytest.mark.slow] * bool(row.environments) + [pytest.mark.needs_packs] * (row.line[:6] == "launch"),
        )
        for row in ROWS
    ],
)
def test_the_cause_of_a_message_is_named_once_with_a_remedy(
    row: Row, tmp_path: Path, simkit_line: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    for path, text in row.files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    for name in ("MUJOCO_GL", "PYOPENGL_PLATFORM", "TURTLEBOT3_MODEL"):
        monkeypatch.delenv(name, raising=False)
    if row.number == 17 and ctypes.util.find_library("OSMesa"):
        pytest.skip("OSMesa is installed")
    if row.is_silent and row.environments and "software" not in row.line:
        try:
            gl_context.find_library()
        except simkit.RenderError as error:
            pytest.skip(str(error))
    words = shlex.split(row.line)
    for environment in row.environments or (None,):
        done = simkit_line(*words) if environment is None else in_new_process(words, environment)
        shown = " ".join((done.stdout + done.stderr).split())
        assert done.exit_code == row.exit_code, shown
        assert {text: shown.count(text) for text in row.printed} == dict.fromkeys(row.printed, 1), shown
        assert "Traceback" not in shown and "Exception" not in shown
        assert not (row.is_silent and done.stderr)


@dataclass(frozen=True)
class Done:
    """Result of a command in a process of its own."""

    stdout: str
    stderr: str
    exit_code: int


def in_new_process(words: list[str], environment: dict[str, str]) -> Done:
    paths = [*filter(None, [environment.get("PYTHONPATH")]), str(ROOT), *sys.path]
    done = subprocess.run(
        [sys.executable, "-m", "simkit", *words],
        env={**os.environ, **environment, "PYTHONPATH": os.pathsep.join(paths)},
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    return Done(done.stdout, done.stderr, done.returncode)


@pytest.mark.needs_packs
def test_29_a_model_is_spawned_at_once(start: Callable[..., Any], simkit_line: Callable[..., Any]) -> None:
    start(world=sdf("<simkit:entity_services>classic</simkit:entity_services>")["a.sdf"])
    request = json.dumps({"name": "box", "xml": "<sdf version='1.9'><model name='m'><link name='l'/></model></sdf>"})
    done = simkit_line("service", "call", "/spawn_entity", "gazebo_msgs/srv/SpawnEntity", request)
    assert done.exit_code == 0 and "success=True" in done.stdout, done
    assert "box" in simkit_line("model", "list").stdout


CONTROLLED = """<robot name="arm"><link name="world"/>
  <link name="forearm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="elbow" type="continuous"><parent link="world"/><child link="forearm"/><axis xyz="0 1 0"/></joint>
  <ros2_control name="arm" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
    <joint name="elbow"><command_interface name="position"/><state_interface name="position"/></joint></ros2_control>
  <gazebo><plugin filename="libgz_ros2_control-system.so" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
    <parameters>arm.yaml</parameters></plugin></gazebo></robot>"""
CONTROLLERS = """
controller_manager:
  ros__parameters: {update_rate: 100, arm: {type: position_controllers/JointGroupPositionController}}
arm: {ros__parameters: {joints: [elbow]}}
"""


@pytest.mark.needs_packs
def test_30_the_controller_manager_answers_at_once(
    tmp_path: Path, start: Callable[..., Any], simkit_line: Callable[..., Any]
) -> None:
    (tmp_path / "arm.yaml").write_text(CONTROLLERS)
    (tmp_path / "arm.urdf").write_text(CONTROLLED)
    start(world=tmp_path / "arm.urdf")
    done = simkit_line("service", "call", "/controller_manager/list_controllers")
    assert done.exit_code == 0 and "name='arm', state='active'" in done.stdout, done


@pytest.mark.needs_packs
def test_32_a_world_that_is_reset_sends_no_transform_from_the_past(
    start: Callable[..., Any], simkit_line: Callable[..., Any]
) -> None:
    sim = start(paused=True).sim
    before = sim.time
    sim.tf.frames()
    for service, time in (("/reset_world", before), ("/reset_simulation", 0.0)):
        done = simkit_line("service", "call", service)
        assert (done.exit_code, done.stderr, sim.time) == (0, "", time)
        assert sim.tf.lookup("odom", "base").position == pytest.approx([0, 0, 0], abs=1e-3)


def test_every_message_has_a_cause_and_a_query_of_the_search() -> None:
    texts = {row.text: row.number for row in ROWS} | {text: number for number, text in LIVE.items()}
    assert set(texts.values()) == set(range(1, 33))
    queries = SEARCH.read_text(encoding="utf-8")
    assert not [text for text in texts if f"{json.dumps(text)}: " not in queries]
