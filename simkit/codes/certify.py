"""Certificates of determinism."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import BALL, command, python

_MADE_HERE = """
from simkit.certify import certify
from simkit.plugins import WorldPlugin
from simkit.scenario import Scenario


class Mine(WorldPlugin):
    def load(self, parent, params):
        pass


certify(Scenario(world="ball.sdf", plugins=(Mine(),)))
"""
_QUITTER = """
import os

from simkit.plugins import WorldPlugin


class Quitter(WorldPlugin):
    def load(self, parent, params):
        os._exit(3)
"""
_QUITS = """<sdf version="1.9"><world name="w"><plugin filename="quitter:Quitter" name="q"/></world></sdf>"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-CERT-001",
        "error",
        "a certificate is asked for of fewer than two runs",
        "`--runs 2` or more: runs are compared with the first",
        command("simkit certify ball.sdf --runs 1", {"ball.sdf": BALL}),
    ),
    Code(
        "SK-CERT-002",
        "error",
        "a scenario has plugins that were made in Python, which a fresh process cannot be given",
        "write the scenario as a Python file with `scenario = Scenario(..., plugins=(...))`, or name them in the world",
        python(_MADE_HERE, {"ball.sdf": BALL}),
    ),
    Code(
        "SK-CERT-004",
        "error",
        "the first process ended without giving its result, or did not end within `--wall-timeout`",
        "its last line is given, and where it stood: a plugin ended the program, or has a loop without an end",
        command("simkit certify quits.sdf --plugin-path . --runs 2", {"quits.sdf": _QUITS, "quitter.py": _QUITTER}),
    ),
)
