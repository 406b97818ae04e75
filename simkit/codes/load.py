"""Finding and reading files; names at run time."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import BALL, command, link, model, python, world

_TWO_MODELS = """
<model name="a"><link name="l"/></model>
<model name="b"><link name="l"/></model>
"""
_NESTED = model('<link name="base"/>\n<model name="arm"><link name="upper"/></model>').text

CODES: tuple[Code, ...] = (
    Code(
        "SK-LOAD-001",
        "error",
        "the file cannot be loaded, for no more exact reason",
        without="every reason that is known has a code of its own",
    ),
    Code(
        "SK-LOAD-002",
        "error",
        "no such file, or it cannot be read",
        "the closest name is given",
        command("simkit check bal.sdf", {"ball.sdf": BALL}),
    ),
    Code(
        "SK-LOAD-003",
        "error",
        "the root element is of no format that is known; those known are listed",
        "a world or model file begins with `<sdf version='...'>`",
        Example("<sdg version='1.9'><world name='default'/></sdg>\n"),
    ),
    Code(
        "SK-LOAD-004",
        "warning",
        "SDF version missing, from 2012, or newer than 1.12; the file is read as the message says",
        'write `<sdf version="1.12">`',
        Example("<sdf><world name='default'/></sdf>\n"),
    ),
    Code(
        "SK-LOAD-010",
        "error",
        "what is spawned holds no model, or several",
        "spawn them one by one",
        python(
            f'import simkit\nsim = simkit.load("ball.sdf")\nsim.spawn("""{world(_TWO_MODELS).text}""")\n',
            {"ball.sdf": BALL},
        ),
    ),
    Code(
        "SK-LOAD-011",
        "error",
        "a model of that name is there already",
        "give `name=`",
        python('import simkit\nsim = simkit.load("ball.sdf")\nsim.spawn("ball.sdf")\n', {"ball.sdf": BALL}),
    ),
    Code(
        "SK-URI-001",
        "error, warning",
        "the URI is found nowhere; the places looked in are listed (a warning for a mesh: the world goes on without)",
        "`--resource-path`",
        world("<include><uri>model://no_such_table</uri></include>"),
    ),
    Code(
        "SK-URI-002",
        "error, warning",
        "a Fuel URL that is in no local folder; nothing is downloaded (a warning for a mesh)",
        "fetch it once with Gazebo, whose cache is read",
        world("<include><uri>https://fuel.gazebosim.org/1.0/nobody/models/No Such Table</uri></include>"),
    ),
    Code(
        "SK-URI-003",
        "error",
        "the URI leaves the folders it may use",
        "`--resource-path`",
        link(
            '<visual name="look">\n'
            "  <geometry><mesh><uri>../../../../../../elsewhere/table.stl</uri></mesh></geometry>\n</visual>"
        ),
    ),
    Code(
        "SK-URI-004",
        "error",
        "unknown URI scheme",
        "model, package, file and https are known",
        world("<include><uri>modle://table</uri></include>"),
    ),
    Code(
        "SK-URI-005",
        "error",
        "the model's folder has no SDF file to read",
        "",
        world("<include><uri>model://table</uri></include>", files={"table/README": "no model here yet\n"}),
    ),
    Code(
        "SK-URI-006",
        "warning",
        "a texture is not found; drawn without it",
        "",
        link(
            '<visual name="look">\n  <geometry><box><size>1 1 1</size></box></geometry>\n'
            "  <material><pbr><metal><albedo_map>wood.png</albedo_map></metal></pbr></material>\n</visual>"
        ),
    ),
    Code(
        "SK-URI-007",
        "error",
        "`TURTLEBOT3_MODEL` names a robot that is not here; those there are, are listed",
        "unset it, or choose one",
        command(
            "TURTLEBOT3_MODEL=wafle simkit check world.sdf",
            {"world.sdf": world("<include><uri>model://turtlebot3</uri></include>").text},
        ),
    ),
    Code(
        "SK-URI-008",
        "note",
        "`TURTLEBOT3_MODEL` is not set; `model://turtlebot3` is the waffle",
        "`TURTLEBOT3_MODEL=waffle`",
        world("<include><uri>model://turtlebot3</uri></include>"),
    ),
    Code(
        "SK-XML-001",
        "error",
        "broken XML",
        "",
        Example('<sdf version="1.9">\n  <model name="robot">\n    <link name="base">\n  </model>\n</sdf>\n'),
    ),
    Code(
        "SK-XML-002",
        "error",
        "the file is too large, too deep, or has too many elements",
        "",
        python("import simkit\nfor problem in simkit.check('<a>' * 10_000):\n    print(problem)\n"),
    ),
    Code(
        "SK-XML-003",
        "error",
        "the file declares an XML entity; entities are not read",
        "write the text out",
        Example('<!DOCTYPE sdf [<!ENTITY mass "1">]>\n<sdf version="1.9"/>\n'),
    ),
    Code(
        "SK-XML-004",
        "warning",
        "not strictly XML, read all the same",
        "",
        Example("<!-- the robot -->\n<?xml version='1.0'?>\n" + model('<link name="base"/>').text),
    ),
    Code(
        "SK-NAME-002",
        "error",
        "a handle of something that was removed",
        "",
        python(
            'import simkit\nsim = simkit.load("ball.sdf")\nball = sim.model("ball")\nsim.remove("ball")\nball.pose\n',
            {"ball.sdf": BALL},
        ),
    ),
    Code(
        "SK-NAME-003",
        "error",
        "only top-level models can be removed",
        "remove the model it belongs to",
        python('import simkit\nsim = simkit.load("robot.sdf")\nsim.remove("robot::arm")\n', {"robot.sdf": _NESTED}),
    ),
    Code(
        "SK-CORE-001",
        "stop",
        "an error of simkit's own; exit code 1",
        without="no input should bring it about: report it",
    ),
    Code(
        "SK-CORE-002",
        "error",
        "the simulation is closed",
        "",
        python('import simkit\nsim = simkit.load("ball.sdf")\nsim.close()\nsim.step()\n', {"ball.sdf": BALL}),
    ),
    Code(
        "SK-INPUT-001",
        "error",
        "input that cannot be used, for no more exact reason",
        without="every reason that is known has a code of its own",
    ),
)
