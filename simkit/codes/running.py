"""Messages, pictures, recordings, and the command line."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import BALL, command, model, python

_FILES = {"ball.sdf": BALL}

_ROVER = model(
    '<link name="base"/>\n'
    '<link name="left"/>\n<joint name="l" type="revolute"><parent>base</parent><child>left</child>'
    "<axis/></joint>\n"
    '<link name="right"/>\n<joint name="r" type="revolute"><parent>base</parent><child>right</child>'
    "<axis/></joint>\n"
    '<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">\n'
    "  <left_joint>l</left_joint><right_joint>r</right_joint><topic>cmd_vel</topic>\n</plugin>"
).text

CODES: tuple[Code, ...] = (
    Code(
        "SK-MSG-001",
        "error",
        "a message does not fit its topic",
        "the closest field is given",
        python(
            'import simkit\nsim = simkit.load("robot.sdf")\nsim.publish("/cmd_vel", {"liner": {"x": 0.2}})\n',
            {"robot.sdf": _ROVER},
        ),
    ),
    Code(
        "SK-RENDER-001",
        "stop",
        "no renderer, or it failed; exit code 1",
        "`simkit doctor`",
        without="it depends on the machine: neither EGL nor OSMesa is there",
    ),
    Code(
        "SK-RENDER-002",
        "warning",
        "the engine failed to draw; that camera is switched off, the others go on",
        without="it depends on the machine, as when its memory is full",
    ),
    Code(
        "SK-BAG-001",
        "error",
        "the recording's name is taken",
        "another name, or `--force`",
        command("simkit run ball.sdf --duration 0.1 --record run.mcap", {**_FILES, "run.mcap": "an older run\n"}),
    ),
    Code(
        "SK-BAG-002",
        "error",
        "the recording cannot be written there",
        "",
        command("simkit run ball.sdf --duration 0.1 --record no_such_folder/run.mcap", _FILES),
    ),
    Code(
        "SK-BAG-003",
        "stop",
        "recording stopped in the middle of a run, as on a full disk; exit code 1",
        "`simkit bag recover` mends what is there",
        without="it depends on the machine, as when its disk is full",
    ),
    Code(
        "SK-BAG-004",
        "error",
        "nothing readable in the recording to mend",
        "",
        command("simkit bag recover run.mcap mended.mcap", {"run.mcap": "this is no recording\n"}),
    ),
    Code(
        "SK-CLI-010",
        "error",
        "`--cmd-vel` is not two numbers, or no single topic takes a Twist",
        "`--cmd-vel 0.2,0.3`",
        command("simkit run ball.sdf --duration 0.1 --cmd-vel 0.2", _FILES),
    ),
    Code(
        "SK-CLI-011",
        "error",
        "a script of commands cannot be read; file and line are given",
        "",
        command(
            "simkit run ball.sdf --duration 0.1 --script drive.yaml", {**_FILES, "drive.yaml": "commands: sometimes\n"}
        ),
    ),
    Code(
        "SK-CLI-012",
        "error",
        "a message of a script does not fit its topic; file and line are given",
        "",
        command(
            "simkit run robot.sdf --duration 0.1 --script drive.yaml",
            {
                "robot.sdf": _ROVER,
                "drive.yaml": "- {at: 0.0, topic: /cmd_vel, message: {liner: {x: 0.2}}}\n",
            },
        ),
    ),
    Code(
        "SK-CLI-013",
        "error",
        "the picture cannot be written there",
        "an existing folder, `.png` or `.jpg`",
        command("simkit run ball.sdf --duration 0.1 --picture end.tiff", _FILES),
    ),
    Code(
        "SK-CLI-014",
        "error",
        "`--set` names an unknown entity or element, or a value that does not fit",
        "the closest name is given",
        command("simkit run ball.sdf --duration 0.1 --set physics.max_stp_size=0.002", _FILES),
    ),
    Code(
        "SK-CLI-015",
        "error",
        "`--view` finds no display or no window library",
        "the extra `view`",
        without="it depends on the machine",
    ),
    Code(
        "SK-CLI-016",
        "error",
        "`convert` or `vendor` cannot write its output, or it exists",
        "`--force`",
        command("simkit convert ball.sdf -o ball.xml", {**_FILES, "ball.xml": "<mujoco/>\n"}),
    ),
    Code(
        "SK-CLI-017",
        "error",
        "`explain` is asked for a code that there is not",
        "the closest code is given",
        command("simkit explain SK-SFD-004"),
    ),
    Code(
        "SK-CLI-018",
        "error",
        "an option that does not go with the others, or of another form than allowed",
        "",
        command("simkit inspect ball.sdf --base flaoting", _FILES),
    ),
    Code(
        "SK-CLI-019",
        "error",
        "the folder that `vendor` wrote would not mean the same; nothing is left of it",
        without="it guards against an error of simkit's own: report it",
    ),
)
