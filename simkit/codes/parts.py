"""Parameters, plugins, sensors."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import BALL, command, model, python, sensor, world

_DIFF_DRIVE = """
<link name="base"/>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <left_joint>left_weel</left_joint>
  <right_joint>right_wheel</right_joint>
</plugin>
"""
_RAISER = """
import simkit

class Faulty(simkit.WorldPlugin):
    def load(self, sim, params):
        pass

    def after_step(self):
        raise ValueError("the wheel fell off")

sim = simkit.load("ball.sdf", plugins=[Faulty()])
sim.run(1.0)
"""
_UNCOPYABLE = """
import threading

import simkit

class Logger(simkit.WorldPlugin):
    def load(self, sim, params):
        self.lock = threading.Lock()

sim = simkit.load("ball.sdf", plugins=[Logger()])
sim.snapshot()
"""
_CAMERA = "<image><width>64</width><height>48</height></image>"
_LENS = "<intrinsics><fx>60</fx><fy>60</fy><cx>32</cx><cy>24</cy></intrinsics>"


def _camera(content: str) -> str:
    return f"<camera>\n  {_CAMERA}\n  {content}\n</camera>"


def _lidar(horizontal: str = "", rest: str = "") -> str:
    return (
        f"<lidar>\n  <scan><horizontal><samples>180</samples>{horizontal}<min_angle>-1</min_angle>"
        f"<max_angle>1</max_angle></horizontal></scan>\n  <range><min>0.1</min><max>10</max></range>{rest}\n</lidar>"
    )


CODES: tuple[Code, ...] = (
    Code("SK-PARAM-001", "error", "a required element is missing", "", world("<include><name>table</name></include>")),
    Code(
        "SK-PARAM-002",
        "error",
        "a value that is not allowed; what is allowed is said",
        "",
        model('<link name="base"><inertial><mass>heavy</mass></inertial></link>'),
    ),
    Code(
        "SK-PARAM-003",
        "warning",
        "an element of a sensor or plugin that is not used",
        "the closest name is given",
        sensor("imu", "<imu><angular_velocty/></imu>"),
    ),
    Code(
        "SK-PARAM-004",
        "warning",
        "an older spelling, which is understood",
        "write the newer one",
        world(
            '<light name="sun" type="directional"/>\n'
            '<model name="robot">\n  <link name="base"/>\n'
            '  <plugin filename="libsolar_sensor.so" name="solar">\n'
            "    <light_name>sun</light_name><rpy_offsets>0 0 0</rpy_offsets>\n  </plugin>\n</model>"
        ),
    ),
    Code(
        "SK-PLUGIN-001",
        "warning",
        "unknown plugin; it is left out",
        "the closest name, or `--plugin-path`",
        model('<link name="base"/>\n<plugin filename="libmy_drive.so" name="drive"/>'),
    ),
    Code(
        "SK-PLUGIN-002",
        "warning",
        "a plugin of Gazebo's that simkit does not have; it is left out",
        "[write it in Python](writing_a_plugin.md)",
        model('<link name="base"/>\n<plugin filename="libMudPlugin.so" name="mud"/>'),
    ),
    Code(
        "SK-PLUGIN-003",
        "error",
        "a plugin names a joint, link or light that is not there, or does not fit",
        "those there are listed",
        model(_DIFF_DRIVE),
    ),
    Code("SK-PLUGIN-004", "stop", "a plugin raised; exit code 4", "its traceback", python(_RAISER, {"ball.sdf": BALL})),
    Code(
        "SK-PLUGIN-005",
        "note",
        "a plugin that is not needed: simkit does its work by itself",
        "",
        world('<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>'),
    ),
    Code(
        "SK-PLUGIN-006",
        "warning",
        "an attribute of a plugin cannot be copied; snapshots and reset leave it",
        "override `get_state` and `set_state`",
        python(_UNCOPYABLE, {"ball.sdf": BALL}),
    ),
    Code(
        "SK-PLUGIN-007",
        "warning",
        "a plugin in the wrong place, such as a model plugin in a sensor",
        "move it",
        sensor("imu", '<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"/>'),
    ),
    Code(
        "SK-PLUGIN-008",
        "error",
        "a Python plugin that cannot be used: its import fails, or the class is none or not clear",
        "",
        command(
            "simkit check robot.sdf --plugin-path .",
            {
                "robot.sdf": model('<link name="base"/>\n<plugin filename="broken_drive.py" name="drive"/>').text,
                "broken_drive.py": "import no_such_module\n",
            },
        ),
    ),
    Code(
        "SK-PLUGIN-010",
        "warning",
        "a plugin that drives joints, on a static model; it is left out",
        "make the model movable, or remove the plugin",
        model(
            '<static>true</static>\n<link name="base"/>\n<link name="wheel"/>\n'
            '<joint name="axle" type="revolute">\n  <parent>base</parent><child>wheel</child><axis/>\n</joint>\n'
            '<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">\n'
            "  <joint_name>axle</joint_name>\n</plugin>"
        ),
    ),
    Code(
        "SK-PLUGIN-011",
        "warning",
        "a colour of gz's Sensors system has no effect: another Sensors plugin, or `--set`, says otherwise",
        "one Sensors plugin, in the world",
        world(
            '<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors">\n'
            "  <background_color>0 0 1</background_color>\n</plugin>\n"
            '<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors">\n'
            "  <background_color>0 1 0</background_color>\n</plugin>"
        ),
    ),
    Code(
        "SK-SENSOR-001",
        "warning",
        "a kind of sensor that is not simulated; it is left out",
        "",
        sensor("theremin", ""),
    ),
    Code(
        "SK-SENSOR-002",
        "warning",
        "an IMU's orientation reference that Gazebo leaves out, in a world that asks for Gazebo's quirks",
        "without `<simkit:gazebo_quirks>` it is as the file says",
        world(
            """
            <gazebo_quirks>true</gazebo_quirks>
            <model name="robot"><link name="base"><sensor name="imu" type="imu"><imu>
              <orientation_reference_frame><localization>GRAV_UP</localization></orientation_reference_frame>
            </imu></sensor></link></model>
            """
        ),
    ),
    Code(
        "SK-SENSOR-003",
        "note",
        "a lidar's `<resolution>` changes no reading, as in Gazebo",
        "",
        sensor("gpu_lidar", _lidar("<resolution>2</resolution>")),
    ),
    Code(
        "SK-SENSOR-004",
        "warning",
        "`<visibility_mask>` hides nothing from a lidar that sees collisions, which have no `<visibility_flags>`",
        "a `gpu_lidar` or `gpu_ray` sees visuals",
        sensor("lidar", _lidar(rest="<visibility_mask>2</visibility_mask>")),
    ),
    Code(
        "SK-SENSOR-006",
        "note",
        "`<projection>` differs from the intrinsics: P tells it, and the picture is drawn by the intrinsics",
        "Gazebo draws the picture by `<projection>`, while K tells the intrinsics; so does a world with "
        "`<simkit:gazebo_quirks>`",
        sensor("camera", _camera(f"<lens>{_LENS}<projection><p_fx>90</p_fx></projection></lens>")),
    ),
    Code(
        "SK-SENSOR-008",
        "warning",
        "of an image's noise only mean and standard deviation are used",
        "",
        sensor(
            "camera", _camera("<noise><type>gaussian</type><stddev>0.01</stddev><bias_mean>0.1</bias_mean></noise>")
        ),
    ),
    Code(
        "SK-SENSOR-009",
        "warning",
        "`<save>` of a camera is not used: its path leads out of the folders that worlds may write to",
        "a path below the working directory, or `SIMKIT_SAVE_PATH`",
        sensor("camera", _camera('<save enabled="true"><path>/var/pictures</path></save>')),
    ),
)
