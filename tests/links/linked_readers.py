"""Table of the readers of simkit that open a file which a symbolic link in a stranger's folder names.

Each entry has the name of the link, further files of the folder, the arguments of the command, and a text in the format
that the reader expects, with secret words and with errors that a message could quote.
"""

from __future__ import annotations

from dataclasses import dataclass, field

SECRET_WORDS = ("zebrafish", "quokka", "narwhal", "wombat")

_INERTIAL = "<inertial><mass>1</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial>"
_XACRO = '<robot name="z" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'


def _world(content: str) -> str:
    return f'<sdf version="1.9"><world name="w">{content}</world></sdf>'


def _model(content: str) -> str:
    return _world(f'<model name="m"><static>true</static><link name="l">{_INERTIAL}{content}</link></model>')


def _mesh(name: str) -> str:
    mesh = f"<geometry><mesh><uri>{name}</uri></mesh></geometry>"
    return _model(f'<visual name="v">{mesh}</visual><collision name="c">{mesh}</collision>')


SDF = (
    '<sdf version="1.9"><model name="zebrafish"><quokka/><link name="narwhal"><inertial><mass>wombat</mass></inertial>'
    "</link></model></sdf>"
)
URDF = '<robot name="zebrafish"><link name="quokka"/><joint name="narwhal" type="wombat"/></robot>'
XACRO = _XACRO.format('<link name="${zebrafish.quokka}"/><xacro:narwhal wombat="1"/>')
MJCF = '<mujoco model="zebrafish"><worldbody><body name="quokka"><joint type="narwhal"/></body></worldbody></mujoco>'
SCENARIO = "world: zebrafish\nquokka: 3\nset: {narwhal: wombat}\nuntil: zebrafish > 1\n"
OPEN_YAML = "zebrafish: [quokka\nnarwhal: wombat\n"
SCRIPT = "- {at: zebrafish, topic: quokka, message: {narwhal: wombat}}\n- zebrafish\n"
PARAMETERS = "zebrafish:\n  ros__parameters:\n    quokka: narwhal\n    update_rate: wombat\n"
VALUES = "zebrafish: quokka\nnarwhal: [wombat, 3]\n"
CSV = "zebrafish,quokka\nnarwhal,wombat,1\n"
DEFINITION = "# zebrafish\nint64 quokka\n# narwhal\nint64 wombat 5x\n"
GOLDEN = '{"format": 1, "zebrafish": "quokka", "scenario": {"world": "narwhal", "file": "wombat.yaml"}}'
RESULTS = '{"format": 1, "count": 3, "block": 1, "file": "/zebrafish/quokka.yaml", "title": "narwhal wombat"}'
METADATA = "rosbag2_bagfile_information: {relative_file_paths: [zebrafish.mcap], ros_distro: quokka}\n"
MAP = "image: zebrafish.pgm\nresolution: quokka\norigin: narwhal\nmode: wombat\n"
CONFIG = '<model><name>zebrafish</name><sdf version="1.9">quokka.sdf</sdf><narwhal>wombat</narwhal></model>'
MESH = "mtllib zebrafish.mtl\nv quokka 1 2\nf narwhal\nwombat\n"
PYTHON = "zebrafish(quokka.narwhal)\nwombat\n"
NOTES = "zebrafish quokka: hunter: narwhal\n\twombat\n"
"""Text of no format."""

_EXERCISE = "world: empty\ngoals: ['time > 0.01']\nduration: 0.1\nexercise: {title: t}\n"
_LISTED_SDF = '<model><sdf version="1.9">model.sdf</sdf></model>'
_PLAIN_MODEL = '<sdf version="1.9"><model name="x"><link name="l"/></model></sdf>'


@dataclass(frozen=True)
class LinkedReader:
    """Reader of a linked file.

    Attributes:
        link: name of the link in the stranger's folder.
        command: arguments of the command, separated by spaces.
        text: content of the private file.
        files: further files of the stranger.
    """

    link: str
    command: str
    text: str
    files: dict[str, str] = field(default_factory=dict)

    def __str__(self) -> str:
        return f"{self.link} {self.command}"


_NAMED_WORLDS = (
    "check L.sdf",
    "inspect L.sdf",
    "run L.sdf --duration 0.1",
    "convert L.sdf -o O.xml",
    "vendor L.sdf O",
    "certify L.sdf --runs 2 --duration 0.1",
    "bundle L.sdf -o O.zip --duration 0.1",
    "golden record L.sdf -o O --duration 0.1",
    "map L.sdf -o O",
    "graph L.sdf -o O.svg",
    "bench L.sdf",
    "plot L.sdf /x",
    "fetch L.sdf --dry-run",
)
_NAMED_SCENARIOS = (
    "certify L.yaml --runs 2",
    "bundle L.yaml -o O.zip",
    "golden record L.yaml -o O",
    "grade L.yaml",
    "sweep L.yaml -o O",
    "plot L.yaml /x",
)

NAMED = (
    *(LinkedReader("L.sdf", command, SDF) for command in _NAMED_WORLDS),
    *(LinkedReader("L.yaml", command, text) for command in _NAMED_SCENARIOS for text in (SCENARIO, OPEN_YAML)),
    LinkedReader("L.urdf", "check L.urdf", URDF),
    LinkedReader("L.urdf", "motion list L.urdf", URDF),
    LinkedReader("L.urdf", "run empty --spawn L.urdf:0,0,0 --duration 0.1", URDF),
    LinkedReader("L.sdf", "run turtlebot3_burger --world L.sdf --duration 0.1", SDF),
    LinkedReader("L.xacro", "check L.xacro", XACRO),
    LinkedReader("L.xml", "check L.xml", MJCF),
    LinkedReader("L.yaml", "run empty --script L.yaml --duration 0.1", SCRIPT),
    LinkedReader("L.yaml", "run turtlebot3_world --params-file L.yaml --duration 0.1", PARAMETERS),
    LinkedReader("L.mcap", "bag info L.mcap", NOTES),
    LinkedReader("L.db3", "bag info L.db3", NOTES),
    LinkedReader("L.mcap", "bag recover L.mcap -o O", NOTES),
    LinkedReader("L.zip", "replay --list L.zip", NOTES),
    LinkedReader("L.mcap", "plot L.mcap /x.y", NOTES),
    LinkedReader("L.py", "certify L.py", PYTHON),
    LinkedReader("L.py", "run p.sdf --plugin-path .", PYTHON, {"p.sdf": _world('<plugin filename="L.py" name="L"/>')}),
)
"""Files that the user names on the command line: they are read, and no message shows their text."""

FOUND = (
    LinkedReader("msg/B.msg", "interface show stranger/msg/B --interfaces msg", DEFINITION, {"msg/A.msg": "int64 a\n"}),
    LinkedReader("msg/B.msg", "interface show stranger/msg/A --interfaces .", DEFINITION, {"msg/A.msg": "B b\n"}),
    LinkedReader("srv/B.srv", "interface show stranger/srv/B --interfaces srv", DEFINITION),
    LinkedReader("action/B.action", "interface show stranger/action/B --interfaces action", DEFINITION),
    LinkedReader("msg/B.msg", "run w.sdf --interfaces . --duration 0.1", DEFINITION, {"w.sdf": _world("")}),
    LinkedReader("g/golden.json", "golden check g", GOLDEN),
    LinkedReader("g/golden.json", "golden check .", GOLDEN),
    LinkedReader("r/sweep.json", "sweep report r", RESULTS),
    LinkedReader("r/sweep.json", "sweep table r", RESULTS),
    LinkedReader("r/sweep.json", "sweep replay r 0", RESULTS),
    LinkedReader("b/metadata.yaml", "bag info b", METADATA, {"b/x.mcap": "x"}),
    LinkedReader("b/metadata.yaml", "bag info b", OPEN_YAML),
    LinkedReader("b/x.mcap", "bag info b", NOTES),
    LinkedReader("lab/exercise.yaml", "lab grade lab", SCENARIO),
    LinkedReader("requirements.txt", "lab grade .", NOTES, {"exercise.yaml": _EXERCISE}),
    LinkedReader("i.sdf", "check w.sdf", SDF, {"w.sdf": _world("<include><uri>i.sdf</uri></include>")}),
    LinkedReader(
        "i/model.sdf",
        "check w.sdf",
        SDF,
        {"w.sdf": _world("<include><uri>model://i</uri></include>"), "i/model.config": _LISTED_SDF},
    ),
    LinkedReader(
        "i/model.config",
        "check w.sdf",
        CONFIG,
        {"w.sdf": _world("<include><uri>model://i</uri></include>"), "i/model.sdf": _PLAIN_MODEL},
    ),
    LinkedReader("model.config", "check .", CONFIG, {"model.sdf": _PLAIN_MODEL}),
    LinkedReader("model.sdf", "check .", SDF, {"model.config": _LISTED_SDF}),
    LinkedReader("model.sdf", "inspect .", SDF, {"model.config": _LISTED_SDF}),
    LinkedReader(
        "package.xml",
        "check w.sdf",
        "<package><name>zebrafish</name></package>",
        {"w.sdf": _mesh("package://other/m.stl")},
    ),
    *(LinkedReader(f"m.{end}", "check w.sdf", MESH, {"w.sdf": _mesh(f"m.{end}")}) for end in ("stl", "obj", "dae")),
    LinkedReader(
        "c.yaml",
        "inspect r.xacro",
        VALUES,
        {"r.xacro": _XACRO.format("<link name=\"${xacro.load_yaml('c.yaml')}\"/>")},
    ),
    LinkedReader(
        "c.xacro",
        "check r.xacro",
        XACRO,
        {"r.xacro": _XACRO.format('<xacro:include filename="c.xacro"/><link name="a"/>')},
    ),
    LinkedReader("c.xml", "check r.xml", MJCF, {"r.xml": '<mujoco><include file="c.xml"/></mujoco>'}),
    LinkedReader("c.sdf", "golden record s.yaml -o O", SDF, {"s.yaml": "world: c.sdf\nduration: 0.1\n"}),
    LinkedReader("c.yaml", "golden record s.yaml -o O", SCRIPT, {"s.yaml": "world: empty\ncommands: c.yaml\n"}),
    LinkedReader("c.mcap", "golden record s.yaml -o O", NOTES, {"s.yaml": "world: empty\nplay: c.mcap\n"}),
    LinkedReader("c.yaml", "golden record s.yaml -o O", PARAMETERS, {"s.yaml": "world: empty\nparams_files: c.yaml\n"}),
    LinkedReader("c.sdf", "golden record s.yaml -o O", SDF, {"s.yaml": "world: empty\nspawn: 'c.sdf:0,0,0'\n"}),
    LinkedReader("c.sdf", "golden record s.yaml -o O", SDF, {"s.yaml": "world: turtlebot3_burger\nmodel_world: c.sdf"}),
    LinkedReader(
        "c.csv",
        "sweep s.yaml -o O",
        CSV,
        {"s.yaml": "world: empty\nparameters: c.csv\nmetrics: {a: time}\n"},
    ),
    LinkedReader(
        "simkit.lock",
        "check w.sdf",
        NOTES,
        {"w.sdf": _world("<include><uri>https://fuel.gazebosim.org/1.0/a/models/b</uri></include>")},
    ),
    LinkedReader(
        "m.yaml",
        "run w.sdf --duration 0.1",
        MAP,
        {
            "w.sdf": _world(
                '<plugin filename="map_server" name="map_server"><yaml_filename>m.yaml</yaml_filename></plugin>'
            )
        },
    ),
    LinkedReader(
        "p.yaml",
        "check r.urdf",
        PARAMETERS,
        {
            "r.urdf": '<robot name="z"><link name="a"/><gazebo><plugin filename="gz_ros2_control-system" '
            'name="gz_ros2_control::GazeboSimROS2ControlPlugin"><parameters>p.yaml</parameters></plugin></gazebo></robot>'
        },
    ),
)
"""Files that simkit finds in a folder, or that another file names: a link to a private file is refused."""

ALL_TEXTS = (
    SDF, URDF, XACRO, MJCF, SCENARIO, OPEN_YAML, SCRIPT, PARAMETERS, VALUES, CSV, DEFINITION, GOLDEN, RESULTS, METADATA,
    MAP, CONFIG, MESH, PYTHON, NOTES,
)  # fmt: skip
