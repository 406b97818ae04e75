"""The commands that talk to a running simulation, and read bags."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import command, python

_BAG = """
import simkit
from simkit.sinks.bag_reader import open_bag_to_read
from simkit.sinks.recorder import Recorder

with simkit.load('<sdf version="1.9"><world name="w"><model name="m"><link name="l"/></model></world></sdf>') as sim:
    with Recorder(sim, "run.mcap"):
        sim.bus.advertise("/name", "std_msgs/msg/String").publish(simkit.msgs.make("std_msgs/msg/String", data="x"))
"""
_MAIN = """
import contextlib
from simkit.cli import app
with contextlib.suppress(SystemExit):
    import io, sys
    sys.stderr = io.StringIO()
    try:
        app({words})
    finally:
        told, sys.stderr = sys.stderr.getvalue(), sys.__stderr__
        print(told)
"""


def _on_bag(*words: str) -> Example:
    """A command that reads a bag with one text on `/name`."""
    return python(_BAG + _MAIN.format(words=[*words, "--bag", "run.mcap"]))


def _on_run(*words: str) -> Example:
    """A command that talks to a world with a parameter, a service and a model."""
    return python(_RUNNING + _MAIN.format(words=[*words, "--sim", "example"]) + "over.set()\nthread.join()\n")


_RUNNING = """
import threading
import simkit
from simkit.live import Server


class Tuner(simkit.WorldPlugin):
    def load(self, parent, params):
        self.gain = self.declare("p_gain", 2.0)


def serve():
    with simkit.load(world, plugins=[Tuner()]) as sim, Server(sim, "example") as server:
        ready.set()
        while not over.is_set():
            server.poll(0.01)


world = '<sdf version="1.9"><world name="w"><model name="robot"><link name="l"/></model></world></sdf>'
ready, over = threading.Event(), threading.Event()
thread = threading.Thread(target=serve, daemon=True)
thread.start()
ready.wait(20)
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-CLI-030",
        "error",
        "no such topic in the running simulation, or in the bag",
        "the closest name is given; `simkit topic list` has them all",
        _on_bag("topic", "echo", "/nme"),
    ),
    Code(
        "SK-CLI-031",
        "error",
        "values on the command line are not YAML, or do not fit the type",
        "`simkit interface proto TYPE` prints a message to be filled in",
        _on_run("param", "set", "/Tuner", "p_gain"),
    ),
    Code(
        "SK-CLI-032",
        "error",
        "no such type, or not the type of this topic, service or action",
        "the closest is given; `simkit interface list` has them all",
        command("simkit interface show geometry_msgs/msg/Twst"),
    ),
    Code(
        "SK-CLI-033",
        "error",
        "a message has no such field, or the expression of `--filter` fails with it",
        "the closest field is given; `simkit interface show TYPE` has them all",
        _on_bag("topic", "echo", "/name", "--field", "dta"),
    ),
    Code(
        "SK-CLI-034",
        "error",
        "no such node or parameter in the running simulation",
        "the closest name is given; `simkit param list` has them all",
        _on_run("param", "get", "/Tuner", "p_gan"),
    ),
    Code(
        "SK-CLI-035",
        "error",
        "a bag is not there, or cannot be read",
        "`simkit bag recover` mends one that was cut off",
        command("simkit bag info run.mcap", {"run.mcap": "this is no recording\n"}),
    ),
    Code(
        "SK-CLI-036",
        "error",
        "the type of a message in a bag is known neither to the bag nor to simkit, or its bytes are not of it",
        "record it with a ROS that writes definitions into bags (Iron and later), or as MCAP",
        python(
            _BAG + "\nfrom simkit.sinks.bag_reader import BagMessage\n"
            'with open_bag_to_read("run.mcap") as bag:\n'
            '    bag.decode(BagMessage(0, "/name", "lab_msgs/msg/Reading", b""))\n'
        ),
    ),
    Code(
        "SK-CLI-037",
        "error",
        "no such service or action in the running simulation",
        "the closest name is given; `simkit service list` and `simkit action list` have them all",
        _on_run("service", "call", "/pause_physcs"),
    ),
    Code(
        "SK-CLI-038",
        "error",
        "no such model, link, joint or frame, or two frames of separate trees",
        "the closest name is given; `simkit model list` and `simkit tf tree` have them all",
        _on_run("model", "pose", "robt"),
    ),
    Code(
        "SK-CLI-041",
        "error",
        "a parameter file cannot be read, or says nothing of the node",
        "`simkit param dump NODE` prints one",
        _on_run("param", "load", "/Tuner", "no_such.yaml"),
    ),
)
