"""What plugins made by users bring about."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import BALL, command, python, world

_TIRED = """
from simkit import WorldPlugin

class Counter(WorldPlugin):
    def load(self, sim, params):
        params.number("limit", 10.0)
        for gain in params.all("gain"):
            gain.attribute("unit")

    def after_step(self):
        if self.sim.time > 0.1:
            raise ValueError("counted enough")
"""
_COUNTER = '<plugin name="counter" filename="counter.py">\n  {}\n</plugin>'
_FILES = {"counter.py": _TIRED}


def _with_counter(body: str, line: str) -> Example:
    return command(line, {**_FILES, "counter.sdf": world(_COUNTER.format(body)).text})


_ON_MODEL = """
import simkit

class Brake(simkit.ModelPlugin):
    def load(self, model, params):
        pass

simkit.load("ball.sdf", plugins=[("bal", Brake())])
"""
_NONE = """
import simkit

simkit.load("ball.sdf", plugins=["brake"])
"""
_RATE = """
import simkit

class Teller(simkit.WorldPlugin):
    after_step_rate = -10.0

    def load(self, sim, params):
        pass

simkit.load("ball.sdf", plugins=[Teller()])
"""
_NESTED = """
import simkit

sim = simkit.load("ball.sdf")
sim.subscribe("/clock", lambda message: sim.step())
try:
    sim.run(0.1)
except simkit.SimkitError as error:
    print(error.__cause__.code)
"""
_HASTY = """
import simkit


class Hasty(simkit.WorldPlugin):
    def load(self, parent, params):
        self.sim.reset()


try:
    simkit.load("ball.sdf", plugins=[Hasty()])
except simkit.PluginError as error:
    print(error.__cause__.code)
"""
_TWICE = """
import simkit

sim = simkit.load("ball.sdf")
link = next(iter(sim.model("ball").links.values())).scoped
sim.add_sensor(link, "<sensor name='imu' type='imu'/>")
sim.add_sensor(link, "<sensor name='imu' type='imu'/>")
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-PARAM-007",
        "warning",
        "an attribute of a plugin's element that is not used",
        "the closest name that the plugin asks for is given",
        _with_counter('<gain unti="rad">2</gain>', "simkit check counter.sdf --plugin-path ."),
    ),
    Code(
        "SK-PLUGIN-020",
        "warning",
        "a plugin raised and is left out from then on, because that was asked for (`on_error`)",
        "the place where it raised is said; without `on_error` the run stops there with the whole traceback",
        python(
            'import simkit\n\nsim = simkit.load("counter.sdf", plugin_paths=["."])\nsim.run(0.2)\n',
            {
                **_FILES,
                "counter.sdf": world(_COUNTER.format("<simkit:on_error>disable</simkit:on_error>")).text,
            },
        ),
    ),
    Code(
        "SK-PLUGIN-021",
        "error",
        "a plugin handed over in Python does not say what it hangs on, or names what is not there",
        'a pair of the scoped name and the plugin: `plugins=[("robot", MyPlugin())]`',
        python(_ON_MODEL, {"ball.sdf": BALL}),
    ),
    Code(
        "SK-PLUGIN-022",
        "error",
        "something handed over as a plugin is none",
        "an instance of a class derived from `WorldPlugin`, `ModelPlugin`, …, or of one with the hooks of gz",
        python(_NONE, {"ball.sdf": BALL}),
    ),
    Code(
        "SK-PLUGIN-023",
        "error",
        "the rate of a plugin's hook is negative, infinite or no number",
        "a number of at least 0 [Hz]; 0 and None are every step",
        python(_RATE, {"ball.sdf": BALL}),
    ),
    Code(
        "SK-NAME-005",
        "error",
        "a model is to be spawned or copied under a name that none can have",
        "a text that is not empty, without `::`, and not of the form `__name__`",
        python(
            'import simkit\n\nwith simkit.load("ball.sdf") as sim:\n    sim.spawn("ball.sdf", name="shelf::ball")\n',
            {"ball.sdf": BALL},
        ),
    ),
    Code(
        "SK-CORE-004",
        "error",
        "a plugin's `load` asks for a reset, while the world is still being loaded",
        "do it in a hook",
        python(_HASTY, {"ball.sdf": BALL}),
    ),
    Code(
        "SK-CORE-003",
        "error",
        "a hook, a callback or a second thread steps a simulation that is being stepped",
        "do it after the step; what is to happen in a later step belongs in that step's hook",
        python(_NESTED, {"ball.sdf": BALL}),
    ),
    Code(
        "SK-NAME-004",
        "error",
        "a link or joint has a sensor of that name already",
        "another name",
        python(_TWICE, {"ball.sdf": BALL}),
    ),
)
