"""An exercise with a cart that a hand-in has to push."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from simkit_verification.testing.grading.exercise import read_exercise
from simkit_verification.testing.grading.exercise_grading import Grade, grade

CART = """<sdf version="1.9"><world name="track"><model name="cart"><pose>0 0 0.05 0 0 0</pose><link name="body">
<gravity>false</gravity><inertial><mass>1</mass></inertial></link></model>
<plugin name="referee" filename="referee.py"/></world></sdf>"""

REFEREE = """
from simkit import WorldPlugin

class Referee(WorldPlugin):
    after_step_rate = 100.0

    def load(self, parent, params):
        self.found = self.advertise("/referee/distance", "std_msgs/msg/Float64")

    def after_step(self):
        self.found.publish({"data": float(self.sim.model("cart").pose.position[0])})
"""

EXERCISE = """
world: cart.sdf
plugin_paths: [.]
duration: 0.3
goals:
  - {name: goes far, that: "pose('cart').x > 0.1"}
at_end:
  - {name: the referee says so, that: "topic('/referee/distance').data > 0.1 and count('/referee/distance') > 20"}
exercise:
  title: Push the cart
  hand_in: push.py
  robot: cart
  runs:
    - {name: as it stands}
    - {name: again, seed: 2}
"""

HAND_IN = """
import gc, json, os, sys, time
from simkit import ModelPlugin

class Push(ModelPlugin):
    def load(self, parent, params):
        self.cart, self.steps = parent, 0
        LOAD

    def before_step(self):
        self.steps += 1
        BEFORE
"""


@pytest.fixture
def graded(tmp_path: Path) -> Callable[..., Grade]:
    """Return a function that grades a hand-in with statements for `load` and `before_step`."""
    exercise = tmp_path / "exercise"
    exercise.mkdir()
    (exercise / "cart.sdf").write_text(CART)
    (exercise / "referee.py").write_text(REFEREE)
    (exercise / "push.yaml").write_text(EXERCISE)

    def run(load: str = "pass", before: str = "pass", *, limit: float = 5.0, **changes: str) -> Grade:
        text = EXERCISE
        for old, new in changes.values():
            assert old in text
            text = text.replace(old, new)
        (exercise / "push.yaml").write_text(text)
        file = tmp_path / "hand_in" / "push.py"
        file.parent.mkdir(exist_ok=True)
        indented = [code.replace("\n", "\n        ") for code in (load, before)]
        file.write_text(HAND_IN.replace("LOAD", indented[0]).replace("BEFORE", indented[1]))
        return grade(read_exercise(exercise / "push.yaml"), file, limit=limit, allow_code=True)

    return run
