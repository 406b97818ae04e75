"""A callback of a hand-in that does not end is stopped after some seconds, and its line is told once."""

from __future__ import annotations

import pytest

from simkit_verification.testing.grading.callback_limit import callback_position, is_debugged

ENDLESS = {
    "a loop": ("while True: pass", "while True: pass"),
    "a loop in C": ("import re; re.match('(a+)+$', 'a' * 99 + 'b')", "import re; re.match("),
    "a wait": ("time.sleep(1e6)", "time.sleep(1e6)"),
    "a wait for a lock": ("import threading; a = threading.Lock(); a.acquire(); a.acquire()", "a.acquire()"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", ENDLESS)
@pytest.mark.skipif(is_debugged(), reason="a debugger or a coverage tool traces this process")
def test_an_endless_callback_is_stopped_and_told_once(name, graded):
    code, line = ENDLESS[name]
    found = graded(before=f"if self.steps > 50:\n    {code}", limit=1.0)
    first, second = found.outcomes
    assert first.error.startswith("the callback before_step made no progress for 1 s, and was stopped at push.py:13: ")
    assert line in first.error and "--limit S" in first.error
    assert first.time == pytest.approx(0.05, abs=0.05)
    assert second.error == "the run was not started, because a callback was stopped in an earlier run"
    assert found.points == 0.0


@pytest.mark.slow
@pytest.mark.skipif(is_debugged(), reason="a debugger or a coverage tool traces this process")
def test_an_endless_load_is_stopped_too(graded):
    found = graded("while True: pass", limit=1.0)
    assert "the callback load made no progress" in found.outcomes[0].error


@pytest.mark.slow
def test_a_long_callback_within_the_limit_is_not_stopped(graded):
    wait = "if self.steps == 50: time.sleep(1.5)\nself.cart.set_velocity((1, 0, 0))"
    one = ("    - {name: again, seed: 2}\n", "")
    assert graded(before=wait, limit=5.0, one=one).passed
    assert graded(before=wait, limit=0.0, one=one).passed


STACK = """Current thread 0x00007f33bd47a740 (most recent call first):
  File "/usr/lib/python3.11/re/__init__.py", line 166 in match
  File "/srv/anna/push.py", line 23 in helper
  File "/srv/anna/push.py", line 12 in before_step
  File "/opt/simkit/runtime/hooks.py", line 91 in call
"""


def test_the_position_is_the_innermost_line_of_the_hand_in_and_its_outermost_function():
    found = callback_position(STACK, lambda file: file == "/srv/anna/push.py")
    assert found is not None
    assert (found.callback, found.file, found.line, found.imports) == ("before_step", "/srv/anna/push.py", 23, False)
    assert callback_position(STACK, lambda file: False) is None
    assert callback_position("", lambda file: True) is None


def test_an_import_is_told_apart():
    stack = '  File "<frozen importlib._bootstrap>", line 241 in _call_with_frames_removed\n' + STACK.partition("\n")[2]
    found = callback_position(stack, lambda file: file == "/srv/anna/push.py")
    assert found is not None and found.imports
