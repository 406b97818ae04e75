"""Python systems of gz-sim."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import INERTIAL, Files, command, python

_SYSTEM = """
from gz.math7 import Vector3d
from gz.sim8 import Link, Model


class Pusher:
    def configure(self, entity, sdf, ecm, event_mgr):
        self.link = Link(Model(entity).canonical_link(ecm))

    def pre_update(self, info, ecm):
        self.link.add_world_force(ecm, Vector3d(1, 0, 0))


def get_system():
    return Pusher()
"""
_INSTALLED = """
import os
import subprocess
import sys

check = [sys.executable, "-m", "simkit", "check", "world.sdf", "--plugin-path", "systems"]
real = {**os.environ, "PYTHONPATH": "installed"}  # where a gz.math7 lies
print(subprocess.run(check, env=real, capture_output=True, text=True).stdout)
"""
_NESTED = """
from gz.math7 import Pose3d
from gz.sim8 import Model, World


class Mover:
    def pre_update(self, info, ecm):
        outer = Model(World(1).model_by_name(ecm, "outer"))
        Model(outer.model_by_name(ecm, "inner")).set_world_pose_cmd(ecm, Pose3d(0, 0, 2, 0, 0, 0))


def get_system():
    return Mover()
"""
_RATED = """
from gz.msgs10.double_pb2 import Double
from gz.transport13 import AdvertiseMessageOptions, Node


class Speaker:
    def configure(self, entity, sdf, ecm, event_mgr):
        options = AdvertiseMessageOptions()
        options.msgs_per_sec = 10
        self.node = Node()
        self.out = self.node.advertise("/out", Double, options)

    def pre_update(self, info, ecm):
        self.out.publish(Double(data=1))


def get_system():
    return Speaker()
"""
_RUN = """
import simkit

sim = simkit.load("world.sdf", plugin_paths=["."])
sim.step()
"""


def _world(module: str) -> str:
    return f"""<sdf version="1.9">
  <world name="default">
    <model name="outer">
      <link name="base">{INERTIAL}</link>
      <model name="inner"><link name="part">{INERTIAL}</link></model>
      <plugin filename="gz-sim-python-system-loader-system" name="gz::sim::systems::PythonSystemLoader">
        <module_name>{module}</module_name>
      </plugin>
    </model>
  </world>
</sdf>
"""


def _check(module: str, files: Files) -> Example:
    return command("simkit check world.sdf --plugin-path .", {"world.sdf": _world(module), **files})


CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-080",
        "error, warning",
        "the module that a PythonSystemLoader names is in no folder that the user allows (a warning: it is left out), "
        "or its name is none",
        "name its folder with `--plugin-path`, `plugin_paths` or `GZ_SIM_SYSTEM_PLUGIN_PATH`",
        Example(_world("pusher")),
    ),
    Code(
        "SK-PLUGIN-081",
        "error",
        "the file of a PythonSystemLoader makes no `get_system`; it is not run",
        "write `def get_system(): return MySystem()`",
        _check("pusher", {"pusher.py": "class Pusher: ...\n"}),
    ),
    Code(
        "SK-PLUGIN-082",
        "error",
        "importing the module of a PythonSystemLoader failed; file, line and the cause are said",
        "",
        _check("pusher", {"pusher.py": "from gz.rendering8 import Scene\n\n\ndef get_system(): ...\n"}),
    ),
    Code(
        "SK-PLUGIN-083",
        "error, note",
        "a module of Gazebo's Python is installed and goes before simkit's own; an error where it is `gz.sim`, which "
        "knows nothing of a simulation of simkit's",
        "`<simkit:shadow_gz>true</simkit:shadow_gz>` in the plugin, or `SIMKIT_SHADOW_GZ=1`, lets simkit's go first",
        python(
            _INSTALLED,
            {
                "world.sdf": _world("pusher"),
                "systems/pusher.py": _SYSTEM,
                "installed/gz/math7.py": "class Vector3d:\n    def __init__(self, x, y, z): ...\n",
            },
        ),
    ),
    Code(
        "SK-PLUGIN-084",
        "error",
        "what `get_system` gives has none of the hooks",
        "give an object with `configure`, `pre_update`, `update`, `post_update` or `reset`",
        _check("pusher", {"pusher.py": "def get_system():\n    return None\n"}),
    ),
    Code(
        "SK-PLUGIN-085",
        "warning",
        "a system sets the pose of a nested model, which has no effect, as in Gazebo",
        "set the pose of the outermost model",
        python(_RUN, {"world.sdf": _world("mover"), "mover.py": _NESTED}),
    ),
    Code(
        "SK-PLUGIN-086",
        "warning",
        "a system asks gz.transport for so many messages in a second at most, which has no effect: every one arrives",
        "count steps, or compare `info.sim_time`",
        python(_RUN, {"world.sdf": _world("speaker"), "speaker.py": _RATED}),
    ),
)
