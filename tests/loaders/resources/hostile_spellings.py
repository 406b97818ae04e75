"""Project of a stranger beside private files: all readers of file names, and spellings of the path of a file."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

TOKEN = "top-secret-4711"
"""Text in each private file, which no output may contain."""

_PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154789c636868680000030401814bd3d210"
    "0000000049454e44ae426082"
)
_STL = TOKEN.encode().ljust(80, b" ") + struct.pack("<I", 1) + struct.pack("<12fH", *range(12), 0)
_DAE = f"""<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="1"/>
<up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="{TOKEN}"/></library_geometries></COLLADA>"""
_XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
FILES: dict[str, str | bytes] = {
    "m.stl": _STL,
    "m.obj": f"# {TOKEN}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "m.dae": _DAE,
    "m.mtl": f"# {TOKEN}\nnewmtl a\nKd 1 0 0\n",
    "t.png": _PNG,
    "b.bin": TOKEN * 20,
    "s.yaml": f"secret: {TOKEN}\nplay_motion: {{motions: {{{TOKEN}: 1}}}}\n{TOKEN}: [\n",
    "good.yaml": f"secret: {TOKEN}\n",
    "map.yaml": f"image: t.png\nresolution: {TOKEN}\norigin: [0, 0, 0]\n",
    "p.xacro": f'<robot {_XACRO}><link name="{TOKEN}"/></robot>',
    "model.sdf": f'<sdf version="1.9"><model name="{TOKEN}"><link name="{TOKEN}"/></model></sdf>',
    "model.config": f"<model><name>{TOKEN}</name><sdf>model.sdf</sdf></model>",
    "own.material": f"material Own/Red\n{{\n technique\n {{\n pass\n {{\n diffuse 1 0 0 1\n }}\n }}\n}}\n// {TOKEN}\n",
    "m.xml": f'<mujoco model="{TOKEN}"><worldbody><body name="{TOKEN}"><geom size="1"/></body></worldbody></mujoco>',
}


def _world(content: str) -> str:
    return f'<sdf version="1.9"><world name="w">{content}</world></sdf>'


def _visual(geometry: str, more: str = "") -> str:
    visual = f'<visual name="v"><geometry>{geometry}</geometry>{more}</visual>'
    return _world(f'<model name="m"><static>true</static><link name="l">{visual}</link></model>')


def _robot(content: str) -> str:
    return f'<robot {_XACRO} name="r">{content}</robot>'


def _mesh_robot(uri: str) -> str:
    return _robot(f'<link name="a"><visual><geometry><mesh filename="{uri}"/></geometry></visual></link>')


_BOX = "<box><size>1 1 1</size></box>"
_ACTOR = """<actor name="walker"><skin><filename>{}</filename></skin><animation name="walk"><filename>{}</filename>
</animation><script><trajectory id="0" type="walk"><waypoint><time>0</time><pose>0 0 0 0 0 0</pose></waypoint>
</trajectory></script></actor>"""
_OBJ = "mtllib {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n"
_SIDE_DAE = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="1"/>
<up_axis>Z_UP</up_axis></asset><library_images><image id="i"><init_from>{u}</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON><newparam sid="s"><surface type="2D"><init_from>i</init_from></surface>
</newparam><newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam><technique sid="c"><lambert><diffuse>
<texture texture="t" texcoord="UV"/></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials><library_geometries>
<geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><source id="q"><float_array id="qa" count="6">
0 0 1 0 0 1</float_array><technique_common><accessor source="#qa" count="3" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION"
source="#p"/></vertices><triangles count="1" material="mm"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#q" offset="1" set="0"/><p>0 0 1 1 2 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="vs"><node id="n"><instance_geometry url="#g">
<bind_material><technique_common><instance_material symbol="mm" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#vs"/></scene>
</COLLADA>"""
_GLTF = """{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}}]}}],
"materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],"textures":[{{"source":0}}],
"images":[{{"uri":"{image}"}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],
"buffers":[{{"byteLength":36,"uri":"{buffer}"}}]}}"""


@dataclass(frozen=True)
class Reader:
    """File of the stranger in which a text names another file.

    Attributes:
        target: file of `FILES` that the text names.
        files: path in the project -> content; `{u}` is the text and `{n}` a number.
        opened: path of the file that the user opens.
        action: the user's action (see `file_tracer.py`).
        opens_own: the reader opens a file of the project itself, which is a proof that it works.
    """

    target: str
    files: dict[str, str]
    opened: str
    action: str = "check"
    opens_own: bool = True


def _one(target: str, path: str, content: str, **more: object) -> Reader:
    return Reader(target, {path: content}, path, **more)  # type: ignore[arg-type]


def _plugin(file: str, name: str, content: str) -> str:
    return f'<plugin filename="{file}" name="{name}">{content}</plugin>'


def _mjcf(compiler: str, asset: str, world: str = "", more: str = "") -> str:
    return f"<mujoco>{compiler}<asset>{asset}</asset>{more}<worldbody>{world}</worldbody></mujoco>"


def _side(mesh: str, files: dict[str, str], target: str) -> Reader:
    world = _visual(f"<mesh><uri>../meshes/{mesh}</uri></mesh>")
    return Reader(target, {**files, "worlds/{n}.sdf": world}, "worlds/{n}.sdf", "load")


_MESH_GEOM = '<geom type="mesh" mesh="q"/>'
_ARM = """<link name="world"/><link name="l"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
</link><joint name="j" type="revolute"><parent link="world"/><child link="l"/><axis xyz="0 0 1"/><limit lower="-1"
upper="1" effort="1" velocity="1"/></joint><ros2_control name="s" type="system"><hardware><plugin>
gz_ros2_control/GazeboSimSystem</plugin></hardware><joint name="j"><command_interface name="position"/></joint>
</ros2_control>"""
_SCRIPT = "<material><script><uri>{u}</uri><name>Own/Red</name></script></material>"
_ALBEDO = "<material><pbr><metal><albedo_map>{u}</albedo_map></metal></pbr></material>"
_HEIGHT = "<heightmap><uri>{u}</uri><size>1 1 1</size><pos>0 0 0</pos></heightmap>"
_HEAT = _plugin("gz-sim-thermal-system", "gz::sim::systems::Thermal", "<heat_signature>{u}</heat_signature>")
_LOAD = "${xacro.load_yaml('{u}')}"
_YAML = _robot(f'<xacro:property name="y" value="{_LOAD}"/><link name="${{y[\'secret\']}}"/>')
_FETCHED = _robot(
    f'<xacro:property name="y" value="{_LOAD}"/><link name="a"><visual><geometry>'
    "<mesh filename=\"http://127.0.0.1:9/1.0/o/models/${y['secret']}/files/m.stl\"/></geometry></visual></link>"
)
READERS: dict[str, Reader] = {
    "urdf mesh": _one("m.stl", "urdf/{n}.urdf", _mesh_robot("{u}")),
    "urdf texture": _one(
        "t.png",
        "urdf/{n}.urdf",
        _robot(
            '<link name="a"><visual><geometry><box size="1 1 1"/></geometry><material name="x">'
            '<texture filename="{u}"/></material></visual></link>'
        ),
        opens_own=False,
    ),
    "sdf mesh": _one("m.stl", "worlds/{n}.sdf", _visual("<mesh><uri>{u}</uri></mesh>")),
    "sdf collada": _one("m.dae", "worlds/{n}.sdf", _visual("<mesh><uri>{u}</uri></mesh>")),
    "sdf heightmap": _one("t.png", "worlds/{n}.sdf", _visual(_HEIGHT)),
    "sdf texture": _one("t.png", "worlds/{n}.sdf", _visual(_BOX, _ALBEDO), action="load", opens_own=False),
    "sdf script": _one("own.material", "worlds/{n}.sdf", _visual(_BOX, _SCRIPT)),
    "sdf include": _one("model.sdf", "worlds/{n}.sdf", _world("<include><uri>{u}</uri></include>")),
    "sdf include of a folder": _one("", "worlds/{n}.sdf", _world("<include><uri>{u}</uri></include>"), opens_own=False),
    "sdf skin": _one("m.dae", "worlds/{n}.sdf", _world(_ACTOR.format("{u}", "{u}"))),
    "sdf heat signature": _one("t.png", "worlds/{n}.sdf", _visual(_BOX, _HEAT)),
    "mesh of mtllib": _side("{n}.obj", {"meshes/{n}.obj": _OBJ.format("{u}")}, "m.mtl"),
    "mesh of map_Kd": _side(
        "{n}.obj",
        {"meshes/{n}.obj": _OBJ.format("{n}.mtl"), "meshes/{n}.mtl": "newmtl a\nmap_Kd {u}\n"},
        "t.png",
    ),
    "mesh of COLLADA": _side("{n}.dae", {"meshes/{n}.dae": _SIDE_DAE}, "t.png"),
    "mesh of a glTF buffer": _side("{n}.gltf", {"meshes/{n}.gltf": _GLTF.format(image="a.png", buffer="{u}")}, "b.bin"),
    "mesh of a glTF image": _side(
        "{n}.gltf", {"meshes/{n}.gltf": _GLTF.format(image="{u}", buffer="own/b.bin")}, "t.png"
    ),
    "xacro include": _one("p.xacro", "urdf/{n}.xacro", _robot('<xacro:include filename="{u}"/>')),
    "xacro load_yaml": _one("s.yaml", "urdf/{n}.xacro", _YAML),
    "xacro load_yaml of a value": _one("good.yaml", "urdf/{n}.xacro", _YAML),
    "xacro load_yaml into a URL": _one("good.yaml", "urdf/{n}.xacro", _FETCHED),
    "controllers": _one(
        "s.yaml",
        "urdf/{n}.urdf",
        _robot(
            _ARM + "<gazebo>" + _plugin("libgazebo_ros2_control.so", "c", "<parameters>{u}</parameters>") + "</gazebo>"
        ),
    ),
    "arguments of a controller": _one(
        "s.yaml",
        "urdf/{n}.urdf",
        _robot(
            _ARM
            + "<gazebo>"
            + _plugin("libgazebo_ros2_control.so", "c", "<ros><argument>--params-file {u}</argument></ros>")
            + "</gazebo>"
        ),
        opens_own=False,
    ),
    "motions": _one(
        "s.yaml",
        "worlds/{n}.sdf",
        _world(
            '<model name="m"><link name="l"/>'
            + _plugin("libsimkit_play_motion.so", "play_motion2", "<motions>{u}</motions>")
            + "</model>"
        ),
    ),
    "map": _one(
        "map.yaml",
        "worlds/{n}.sdf",
        _world(_plugin("libsimkit_map_server.so", "map_server", "<yaml_filename>{u}</yaml_filename>")),
    ),
    "image of a map": Reader(
        "t.png",
        {
            "worlds/{n}.yaml": "image: '{u}'\nresolution: 0.1\norigin: [0, 0, 0]\n",
            "worlds/{n}.sdf": _world(
                _plugin("libsimkit_map_server.so", "map_server", "<yaml_filename>{n}.yaml</yaml_filename>")
            ),
        },
        "worlds/{n}.sdf",
        opens_own=False,
    ),
    "mjcf mesh": _one("m.stl", "urdf/{n}.xml", _mjcf("", '<mesh name="q" file="{u}"/>', _MESH_GEOM)),
    "mjcf texture": _one("t.png", "urdf/{n}.xml", _mjcf("", '<texture type="2d" name="q" file="{u}"/>')),
    "mjcf height field": _one("t.png", "urdf/{n}.xml", _mjcf("", '<hfield name="q" size="1 1 1 1" file="{u}"/>')),
    "mjcf include": _one("m.xml", "urdf/{n}.xml", '<mujoco><include file="{u}"/></mujoco>'),
    "mjcf model": _one("m.xml", "urdf/{n}.xml", _mjcf("", '<model name="q" file="{u}"/>')),
    "mjcf meshdir": _one(
        "m.stl", "urdf/{n}.xml", _mjcf('<compiler meshdir="{d}"/>', '<mesh name="q" file="m.stl"/>', _MESH_GEOM)
    ),
    "mjcf texturedir": _one(
        "t.png",
        "urdf/{n}.xml",
        _mjcf('<compiler texturedir="{d}"/>', '<texture type="2d" name="q" file="t.png"/>'),
    ),
    "model.config": Reader(
        "model.sdf",
        {
            "models/m{n}/model.config": "<model><name>m</name><sdf version='1.9'>{u}</sdf></model>",
            "worlds/{n}.sdf": _world("<include><uri>package://mine/models/m{n}</uri></include>"),
        },
        "worlds/{n}.sdf",
        opens_own=False,
    ),
}


def make_project(top: Path) -> Path:
    """Write the private files and the stranger's project; return the folder of the project.

    The project has a file and a folder that are links to the private ones, and own files of the same names.
    """
    private, project = top / "private", top / "home" / "ws" / "src" / "mine"
    for folder in (private, project / "own", project / "meshes/own", project / "worlds", project / "urdf"):
        folder.mkdir(parents=True, exist_ok=True)
    (project / "models/mm/meshes").mkdir(parents=True)
    (project / "package.xml").write_text("<package><name>mine</name></package>")
    (project / "models/mm/model.config").write_text("<model><name>mm</name><sdf>model.sdf</sdf></model>")
    (project / "models/mm/model.sdf").write_text('<sdf version="1.9"><model name="mm"><link name="l"/></model></sdf>')
    (project / "links").mkdir()
    for name, content in FILES.items():
        data = content if isinstance(content, bytes) else content.encode()
        (private / name).write_bytes(data)
        for folder in (project / "own", project / "meshes/own"):
            (folder / name).write_bytes(data.replace(TOKEN.encode(), b"x" * len(TOKEN)))
        (project / "links" / name).symlink_to(private / name)
        (project / "links" / f"again_{name}").symlink_to(name)
    for folder in (project, project / "meshes", project / "models/mm"):
        (folder / "out").symlink_to(private)
        (folder / "up").symlink_to("../" * (len(folder.parts) + 2))  # the root of the file system
    (project / "linked").symlink_to(private)
    return project


PREFIXES = (
    "",
    "./",
    "../",
    "own/",
    "file://",
    "package://mine/",
    "package://mine/own/",
    "model://mm/",
    "model://mine/",
    "$(find mine)/",
    "file://$(find mine)/",
    "model://turtlebot3_burger/",
    "package://turtlebot3_description/",
    "https://fuel.gazebosim.org/1.0/o/models/mm/1/files/",
    "https://fuel.gazebosim.org/1.0/o/models/mm/",
)


def _encoded(text: str, times: int, characters: str) -> str:
    for _ in range(times):
        text = "".join(f"%{ord(c):02X}" if c in characters else c for c in quote(text, safe="/.~"))
    return text


def spellings(path: Path, project: Path) -> Iterator[str]:
    """Yield spellings of a private file or folder, as a stranger can write them in a file of the project."""
    plain = path.as_posix()
    climbing = "../" * (len(project.parts) + 3) + plain.lstrip("/")
    bodies = {
        plain: None,
        f"/{plain}": None,
        f"//{plain}": None,
        f"/.{plain}": None,
        plain.lstrip("/"): None,
        climbing: None,
        f"x/{climbing}": None,
        f"a/..//{climbing}": None,
        f"~{plain}": None,
        f"up{plain}": None,
        f"out/{path.name}": None,
        f"./out/../out//{path.name}": None,
        f"{plain}/": None,
        f"{plain}?x": None,
        f"{plain}#x": None,
        plain.replace("/", "\\"): None,
        climbing.replace("/", "\\"): None,
    }
    if path.suffix:
        bodies |= {f"links/{path.name}": None, f"links/again_{path.name}": None}
    for text in (plain, climbing):
        for characters in ("/", ".", "/."):
            bodies |= {_encoded(text, times, characters): None for times in (1, 2, 3)}
    for prefix in PREFIXES:
        for body in bodies:
            yield prefix + body
    yield from (f"file://localhost{plain}", f"file:{plain}", f"package:///{plain}", f"model:////{plain}", f"{plain}\0")
    yield from (f"package://{plain}", f"package://..{plain}", f"model://.{plain}", f"package://%2F{plain}")
    yield from (f"package://mine{plain}", f"model://linked/{path.name}", f"package://linked/{path.name}")


def write_job(reader: Reader, project: Path, text: str, folder: str, number: str) -> tuple[str, str]:
    """Write the files of a reader with a text; return the action and the path of the file to open.

    Args:
        text: spelling of the target's path.
        folder: spelling of the path of the target's folder.
        number: name of the files.
    """
    for path, content in reader.files.items():
        file = project / path.replace("{n}", number)
        file.parent.mkdir(parents=True, exist_ok=True)
        written = content.replace("{u}", text).replace("{d}", folder).replace("{n}", number)
        file.write_text(written, "utf-8")
    return reader.action, str(project / reader.opened.replace("{n}", number))
