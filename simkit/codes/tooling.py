"""The command line for plugins: names, new ones, and edits while a run goes on."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import BALL, command

_RUN = "simkit run world.sdf --plugin-path . --watch --duration 2"
_WORLD = '<sdf version="1.9"><world name="w"><plugin name="count" filename="libcount.so"/></world></sdf>\n'
_ARM = """<sdf version="1.9"><world name="w"><model name="arm">
  <link name="base"/><link name="lever"><pose>0 0 1 0 0 0</pose></link>
  <joint name="fixed" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="turn" type="revolute"><parent>base</parent><child>lever</child><axis><xyz>0 0 1</xyz></axis></joint>
  <plugin name="count" filename="libcount.so"/>
</model></world></sdf>
"""
_COUNT = """
from pathlib import Path
from simkit import {base}


class Count({base}):
    filenames = ("libcount.so",)
    after_step_rate = 1.0{prepare}

    def load(self, parent, params):
        self.count = 0

    def after_step(self):  # stands for somebody who edits this file
        self.count += 1
        text = Path(__file__).read_text()
        Path(__file__).write_text(text.replace({edit}))
"""
_PREPARE = """

    def prepare(self, scene, params, builder):
        builder.add_velocity_servo("arm::turn", max_effort=5.0, owner=self.name)"""


def _count(edit: str, base: str = "WorldPlugin", prepare: str = "") -> str:
    return _COUNT.format(base=base, prepare=prepare, edit=edit)


CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-070",
        "error",
        "there is no plugin of that name",
        "the closest name is given; `simkit plugin list` has all",
        command("simkit plugin info gazebo_ros_dif_drive"),
    ),
    Code(
        "SK-PLUGIN-071",
        "error",
        "a plugin's file that was edited while a world runs cannot be imported; the run goes on with the old code",
        "`simkit run --watch` looks at the file again when it is written the next time",
        command(_RUN, {"world.sdf": _WORLD, "count.py": _count('"class Count", "class"')}),
    ),
    Code(
        "SK-PLUGIN-072",
        "error",
        "`simkit plugin new` takes either a name or a world",
        "`simkit plugin new wheel_brake`, or `simkit plugin new --from world.sdf`",
        command("simkit plugin new", {"world.sdf": BALL}),
    ),
    Code(
        "SK-PLUGIN-073",
        "error",
        "a new plugin cannot be called so, or cannot hang there",
        "what is allowed is said",
        command("simkit plugin new wheel_brake --on wheel"),
    ),
    Code(
        "SK-PLUGIN-074",
        "error",
        "a file of a new plugin is there already, or cannot be written",
        "another name, another `--folder`, or `--force`",
        command("simkit plugin new wheel_brake", {"wheel_brake.py": "# mine\n"}),
    ),
    Code(
        "SK-PLUGIN-075",
        "error",
        "a plugin that was edited while a world runs wants other servos, sites or welds than there are; "
        "the run goes on with the old code",
        "begin the run anew",
        command(
            _RUN,
            {"world.sdf": _ARM, "count.py": _count('"effort=5.0", "effort=6.0"', "ModelPlugin", _PREPARE)},
        ),
    ),
    Code(
        "SK-PLUGIN-076",
        "error",
        "a plugin that was edited while a world runs cannot take the place of the old one; "
        "the run goes on with the old code",
        "the class keeps its name, or what the world calls it",
        command(_RUN, {"world.sdf": _WORLD, "count.py": _count('"libcount.so", "libtally.so"')}),
    ),
)
