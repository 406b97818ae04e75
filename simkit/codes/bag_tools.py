"""Bags as tools: charts, exports, commands that are played."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import BALL, python
from simkit.codes.terminal import _BAG, _MAIN

_WORLD = '<sdf version="1.9"><world name="w"><model name="m"><link name="l"/></model></world></sdf>'
_TAKER = f"""
sim = simkit.load('{_WORLD}')
sim.bus.listen("/name", ("std_msgs/msg/{{kind}}",), print)
"""


def _line(*words: str) -> str:
    """A script that makes a bag with one text on `/name`, and does something with it."""
    return _BAG + _MAIN.format(words=list(words))


CODES: tuple[Code, ...] = (
    Code(
        "SK-BAG-010",
        "error",
        "a field that is to be drawn is no number: a text, a message, a long list",
        "name one of its fields or items, such as `.ranges[0]` or `.ranges.min`; what there is is told",
        python(_line("bag", "plot", "run.mcap", "/name.data")),
    ),
    Code(
        "SK-BAG-011",
        "error",
        "there is nothing to draw or to export: no field is named, no number came, or no topic is wanted",
        "`simkit bag info` says what a recording holds",
        python(_line("plot", "run.mcap")),
    ),
    Code(
        "SK-BAG-012",
        "error",
        "a chart cannot be written under that ending",
        "`.svg` or `.png`",
        python(_line("plot", "run.mcap", "/name.data.length", "-o", "name.pdf")),
    ),
    Code(
        "SK-BAG-013",
        "error",
        "an export cannot go there: something else is there, an older export without `--force`, or it is not writable",
        "another name, or `--force` for an older export; what is no export is never replaced",
        python(_BAG + 'open("out", "w").close()\n' + _MAIN.format(words=["bag", "export", "run.mcap", "-o", "out"])),
    ),
    Code(
        "SK-BAG-014",
        "error",
        "a format of an export needs what is not installed: Parquet its package, MP4 an encoder",
        "`pip install 'simkit-robotics[parquet]'`, `--images png`",
        without="it depends on what is installed",
    ),
    Code(
        "SK-BAG-015",
        "error",
        "a recorded message does not fit the topic that it is to be played on",
        "play it on another one: `--play-topic OLD:=NEW`",
        python(
            _BAG + _TAKER.format(kind="Bool") + "from pathlib import Path\nfrom simkit.sinks.playback import Playback\n"
            'Playback(sim, Path("run.mcap"))\n'
        ),
    ),
    Code(
        "SK-BAG-016",
        "error",
        "a world takes nothing of what was recorded",
        "say what goes where: `--play-topic OLD:=NEW`",
        python(
            _line("run", "ball.sdf", "--play", "run.mcap"),
            {"ball.sdf": BALL},
        ),
    ),
)
