"""Small sets of files, made of text and numbers: a file that is opened and what it names, one of which is broken."""

from __future__ import annotations

import io
import json
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image
from wide_sdf import BOX, WORLD

from tests.loaders.meshes.mesh_makers import (
    PLACED,
    QUAD,
    TETRAHEDRON,
    TETRAHEDRON_FACES,
    binary_stl,
    collada,
    gltf,
    write_glb,
)


@dataclass(frozen=True)
class Sample:
    """A set of files.

    Attributes:
        name: what it is about.
        main: the file that is opened.
        files: path -> content.
        broken: the files that a mutation may change.
        is_text: whether these are XML.
    """

    name: str
    main: str
    files: dict[str, bytes]
    broken: tuple[str, ...]
    is_text: bool = True


@cache
def samples() -> tuple[Sample, ...]:
    """All sets."""
    return (*_meshes(), *_pictures(), *_folders(), *_xacros(), _wide(), _script())


def _meshes() -> list[Sample]:
    triangles = np.array(TETRAHEDRON)[np.array(TETRAHEDRON_FACES)]
    ascii_stl = "solid s\n" + "".join(
        "facet normal 0 0 1\nouter loop\n"
        + "".join("vertex {:g} {:g} {:g}\n".format(*corner) for corner in triangle)
        + "endloop\nendfacet\n"
        for triangle in triangles
    )
    points = "".join("v {:g} {:g} {:g}\n".format(*p) for p in QUAD)
    obj = f"mtllib m.mtl\no a\nusemtl m\n{points}vt 0 0\nvt 1 1\nvn 0 1 0\nf 1/1/1 2/2/1 3/1/1 4/2/1\nf -1 -2 -3\n"
    materials = "newmtl m\nKd 1 0 0\nKa 0 0 0\nd 0.5\nmap_Kd p.png\n"
    image = '<library_images><image id="I"><init_from>p.png</init_from></image></library_images>'
    node = f"<node><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><translate>1 0 0</translate>{PLACED}</node>"
    document = gltf([{"mesh": 0, "scale": [1, 2, 3], "rotation": [0, 0, 0, 1], "children": []}])
    with tempfile.TemporaryDirectory() as folder:
        glb = write_glb(Path(folder) / "m.glb", document).read_bytes()
    made: dict[str, dict[str, bytes]] = {
        "m.stl": {"m.stl": binary_stl(triangles)},
        "text.stl": {"text.stl": ascii_stl.encode()},
        "m.obj": {"m.obj": obj.encode(), "m.mtl": materials.encode(), "p.png": picture("PNG", "RGB")},
        "m.dae": {"m.dae": collada(node, images=image).encode(), "p.png": picture("PNG", "RGB")},
        "m.gltf": {"m.gltf": json.dumps(document).encode()},
        "m.glb": {"m.glb": glb},
    }
    parts = {"m.obj": "a", "m.dae": "tetra", "m.gltf": "quad", "m.glb": "quad"}
    return [
        Sample(name, "w.sdf", {"w.sdf": _mesh_world(name, parts.get(name, "")), **files}, tuple(files), False)
        for name, files in made.items()
    ]


def _mesh_world(name: str, part: str) -> bytes:
    mesh = f"<geometry><mesh><uri>{name}</uri><scale>1 1 -1</scale></mesh></geometry>"
    both = f'<collision name="c">{mesh}</collision><visual name="v">{mesh}</visual>'
    solid = f'<link name="l"><inertial auto="true"/>{both}</link>'
    sub = mesh.replace("<scale>", f"<submesh><name>{part}</name><center>1</center></submesh><scale>") if part else mesh
    still = f'<model name="s"><static>1</static><link name="l"><collision name="c">{sub}</collision></link></model>'
    return f'<sdf version="1.11"><world name="w"><model name="m">{solid}</model>{still}</world></sdf>'.encode()


def picture(kind: str, mode: str, side: int = 9) -> bytes:
    rows = np.arange(side * side, dtype=np.float32).reshape(side, side)
    if mode in ("L", "RGB", "P"):
        image = Image.fromarray(rows.astype(np.uint8)).convert(mode)
    else:
        image = Image.fromarray(rows if mode == "F" else rows.astype(np.uint16))
    stream = io.BytesIO()
    image.save(stream, kind)
    return stream.getvalue()


def _pictures() -> list[Sample]:
    found = []
    for kind, mode in (
        ("PNG", "L"),
        ("PNG", "I;16"),
        ("JPEG", "L"),
        ("TIFF", "F"),
        ("BMP", "RGB"),
        ("GIF", "P"),
        ("TGA", "L"),
    ):
        field = (
            f"<geometry><heightmap><uri>h.{kind.lower()}</uri><size>9 9 1</size><pos>0 0 1</pos></heightmap></geometry>"
        )
        parts = f'<collision name="c">{field}</collision><visual name="v">{field}</visual>'
        world = f'<model name="m"><static>1</static><link name="l">{parts}</link></model>'
        name = f"h.{kind.lower()}"
        files = {
            "w.sdf": f'<sdf version="1.9"><world name="w">{world}</world></sdf>'.encode(),
            name: picture(kind, mode),
        }
        found.append(Sample(f"heightmap {kind} {mode}", "w.sdf", files, (name,), False))
    return found


def _folders() -> list[Sample]:
    config = """<?xml version="1.0"?><model><name>a</name><version>1.0</version>
<sdf version="1.4">old.sdf</sdf><sdf version="1.9">model.sdf</sdf><urdf>r.urdf</urdf>
<author><name>n</name></author></model>"""
    inside = '<link name="l"><gravity>1</gravity></link><frame name="f" attached_to="l"/>{}'
    model = '<sdf version="1.9"><model name="{}">' + inside + "</model></sdf>"
    include = (
        '<include merge="{}"><uri>model://{}</uri><name>{}</name><pose relative_to="l">1 0 0 0 0 0</pose>{}</include>'
    )
    changes = (
        '<experimental:params><link element_id="l" action="modify"><gravity>0</gravity></link></experimental:params>'
    )
    inner = include.format("true", "d", "x", "") + include.format("false", "b", "y", changes)
    world = include.format("false", "a", "one", "<static>1</static>").replace('relative_to="l"', "")
    world += include.format("false", "c", "two", "<placement_frame>l</placement_frame>").replace('relative_to="l"', "")
    mass = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    plugin = '<gazebo><plugin name="p" filename="libp.so"/></gazebo>'
    robot = f'<robot name="c"><link name="l">{mass}</link>{plugin}</robot>'
    files = {
        "w.world": f'<sdf version="1.9"><world name="w">{world}</world></sdf>'.encode(),
        "a/model.config": config.encode(),
        "a/model.sdf": model.format("a", inner).encode(),
        "b/model.sdf": model.format("b", "").encode(),
        "d/model.sdf": b'<sdf version="1.9"><model name="d"><link name="k"/></model></sdf>',
        "c/r.urdf": robot.encode(),
        "c/model.config": config.encode(),
    }
    return [Sample("includes", "w.world", files, tuple(files)), Sample("a model folder", "a", files, tuple(files))]


def _xacros() -> list[Sample]:
    head = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    text = f"""<?xml version="1.0"?>{head}
<xacro:include filename="$(find pkg)/urdf/parts.xacro"/><xacro:include filename="more.xacro" ns="more"/>
<xacro:arg name="mass" default="1.5"/><xacro:property name="mass" value="$(arg mass)"/>
<xacro:property name="table" value="${{dict(a=1, b=[1, 2, 3])}}"/>
<xacro:property name="settings" value="${{xacro.load_yaml('settings.yaml')}}"/>
<xacro:property name="origin"><origin xyz="0 0 ${{pi / 2}}"/></xacro:property>
<xacro:macro name="wheel" params="name parent:=base radius:='0.1' *shape **more side=^|1">
<link name="${{name}}"><inertial><mass value="${{mass * 2 ** 1}}"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
</inertial><collision><geometry><xacro:insert_block name="shape"/></geometry></collision></link>
<joint name="${{name}}_joint" type="continuous"><parent link="${{parent}}"/><child link="${{name}}"/>
<xacro:insert_block name="origin"/><axis xyz="0 ${{side}} 0"/><xacro:insert_block name="more"/></joint></xacro:macro>
<link name="base"/><xacro:if value="${{mass > 1 and len(table['b']) == 3}}">
<xacro:wheel name="left"><sphere radius="${{sin(radians(30)) * settings['radius']}}"/><d><dynamics damping="0.1"/></d>
</xacro:wheel></xacro:if><xacro:unless value="${{max(1, 2) == 2}}"><link name="never"/></xacro:unless>
<xacro:part n="3"/><link name="last_${{[x for x in range(3)][-1]}}"/>
<joint name="k" type="fixed"><parent link="base"/><child link="last_2"/></joint></robot>"""
    parts = f"""{head}<xacro:macro name="part" params="n"><xacro:if value="${{n > 0}}"><link name="p${{n}}"/>
<joint name="q${{n}}" type="fixed"><parent link="base"/><child link="p${{n}}"/></joint><xacro:part n="${{n - 1}}"/>
</xacro:if></xacro:macro></robot>"""
    more = f'{head}<xacro:property name="x" value="1"/><xacro:element xacro:name="gazebo"/></robot>'
    files = {
        "pkg/urdf/r.urdf.xacro": text.encode(),
        "pkg/urdf/parts.xacro": parts.encode(),
        "pkg/urdf/more.xacro": more.encode(),
        "pkg/urdf/settings.yaml": b"radius: 0.3\nlist: [1, 2.5, a]\nangle: !degrees 30\n",
        "pkg/package.xml": b"<package><name>pkg</name></package>",
    }
    return [Sample("xacro", "pkg/urdf/r.urdf.xacro", files, tuple(files))]


def _wide() -> Sample:
    """Every element that a reader asks for."""
    world = WORLD.replace('<model name="m"', '<model name="z"><link name="l"/></model><model name="m"', 1)
    field = "<heightmap><uri>a.png</uri><size>1 1 1</size><pos>0 0 0</pos></heightmap>"
    obj = b"o x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
    files = {
        "w.sdf": world.replace(field, "<sphere><radius>1</radius></sphere>").encode(),
        "a.png": picture("PNG", "L"),
        "a.obj": obj,
        "box/model.sdf": BOX.encode(),
    }
    return Sample("every element of SDF", "w.sdf", files, ("w.sdf", "w.sdf", "w.sdf", "box/model.sdf"))


def _script() -> Sample:
    text = b"""# commands
- {at: 0.0, topic: /cmd_vel, message: {linear: {x: 0.2, y: 0}, angular: {z: 1.0}}}
- at: 0.001
  until: 0.02
  rate: 100
  topic: /model/m/joint/j/cmd_vel
  message: {data: 2.0}
- {at: 0.003, topic: cmd_vel}
"""
    return Sample("a script of commands", "s.yaml", {"s.yaml": text}, ("s.yaml",), False)
