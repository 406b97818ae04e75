"""A hand-in that changes its own process, or writes to the files and pipes around it, gets no points by that."""

from __future__ import annotations

import os

import pytest

from simkit_verification.testing.grading import exercise_grading

ONE_RUN = ("    - {name: again, seed: 2}\n", "")

REPLACED_RUN = """
import simkit_verification.testing.grading.grading_process as process
from dataclasses import replace
for module in (sys.modules["__main__"], process):
    def fake(*arguments, _run=module.run_scenario, **more):
        ended = _run(*arguments, **more)
        return replace(ended, results=tuple(replace(one, passed=True) for one in ended.results))
    module.run_scenario = fake
"""
REPLACED_CHECKS = """
from simkit.testing.conditions import check_list, checks, condition_watch
for kind in (checks.ReachedCheck, checks.FinalCheck, checks.ConditionCheck, checks.RunningCheck):
    kind.result = lambda self, reason: checks.CheckResult(self.check, True, "", 0.0)
    kind.look = lambda self, time: None
checks.Condition.holds = lambda self: True
checks.Condition.gap = lambda self: (True, 0.0, "")
checks.CheckResult.__init__ = lambda self, *a: self.__dict__.update(check=a[0], passed=True, message="", time=0.0)
condition_watch.Watch.results = lambda self, reason: tuple(one.result(reason) for one in self._checks._entries)
check_list.CheckList.results = lambda self, reason: tuple(one.result(reason) for one in self._entries)
"""
FORGED_FILE = """
import atexit, pathlib
def forge(*_):
    parent = os.getppid()
    try:
        job = pathlib.Path(f"/proc/{parent}/cmdline").read_bytes().split(b"\\0")
    except OSError:
        job = []
    for text in job:
        if text.endswith(b"job.json"):
            target = pathlib.Path(text.decode()).with_name("result.json")
            target.write_text(json.dumps({"token": "", "time": 1.0, "results": [[True, "", 0]] * 2}))
atexit.register(forge)
forge()
"""
FORGED_LINES = """
text = json.dumps({"reason": "duration", "results": [[True, "", 0], [True, "", 0]], "passed": True})
for stream in (sys.stdout, sys.stderr, sys.__stdout__):
    print(text, file=stream, flush=True)
os._exit(0)
"""
WRITES_TO_ALL_PIPES = """
for pipe in range(1, 40):
    try:
        os.write(pipe, b"\\x09\\x00\\x00\\x00" * 30)
    except OSError:
        pass
"""
SEARCHES_MEMORY = """
for one in gc.get_objects():
    if isinstance(one, dict) and ("token" in one or "results" in one or "reason" in one):
        try:
            one.update(reason="until", results=[(True, "", 0.0)] * 2, passed=True)
        except Exception:
            pass
"""
CHANGES_FRAMES = """
frame = sys._getframe()
while frame is not None:
    for name in ("reason", "ended", "results"):
        if name in frame.f_locals:
            frame.f_locals[name] = "until"
    frame = frame.f_back
"""
REPLACED_MODULES = """
for name in list(sys.modules):
    if name.startswith("simkit.testing.conditions") or name == "json":
        sys.modules[name] = None
"""
CLOSES_ALL_PIPES = "os.closerange(3, 60)"
ENDS_THE_RUN = "self.sim.control.pausing.end()"
PUBLISHES_FOR_THE_REFEREE = """
out = self.advertise("/referee/distance", "std_msgs/msg/Float64")
for _ in range(30):
    out.publish({"data": 9.0})
"""
KILLS_THE_JUDGE = "import signal\nos.kill(os.getppid(), signal.SIGKILL)"

CHEATS = {
    "replaced run_scenario": REPLACED_RUN,
    "replaced checks": REPLACED_CHECKS,
    "forged file of the result": FORGED_FILE,
    "forged lines, and an exit": FORGED_LINES,
    "bytes on all pipes": WRITES_TO_ALL_PIPES,
    "changed objects of the garbage collector": SEARCHES_MEMORY,
    "changed frames": CHANGES_FRAMES,
    "removed modules": REPLACED_MODULES,
    "closed pipes": CLOSES_ALL_PIPES,
    "replaced json": 'json.dumps = lambda *a, **k: \'{"reason": "until", "rates": {}}\'',
    "an early end": ENDS_THE_RUN,
    "messages of the referee": PUBLISHES_FOR_THE_REFEREE,
    "a killed judge": KILLS_THE_JUDGE,
}


@pytest.mark.slow
@pytest.mark.parametrize("cheat", CHEATS)
@pytest.mark.parametrize("place", ["load", "before"])
def test_a_cheat_gets_no_points(cheat, place, graded):
    body = CHEATS[cheat].strip()
    found = graded(
        **{place: body if place == "load" else "if self.steps == 20:\n    " + body.replace("\n", "\n    ")}, one=ONE_RUN
    )
    assert found.points == 0.0, [mark.message for mark in found.outcomes[0].marks]


@pytest.mark.slow
def test_the_hand_in_that_replaced_the_function_of_the_grader_gets_no_points(graded):
    found = graded(REPLACED_RUN.strip(), one=ONE_RUN)
    (outcome,) = found.outcomes
    assert found.points == 0.0 and not outcome.error
    assert outcome.marks[0].message == "was not reached by t = 0.3 s: pose('cart').x was 0"


@pytest.mark.slow
def test_an_honest_hand_in_gets_all_points(graded):
    found = graded(before="self.cart.set_velocity((1, 0, 0))")
    assert (found.points, found.passed) == (4.0, True)


@pytest.mark.slow
def test_a_condition_that_ends_the_run_must_hold_in_the_recording(graded):
    until = ("duration: 0.3\n", "until: \"pose('cart').x > 0.25\"\ntimeout: 0.3\n")
    found = graded(REPLACED_CHECKS.strip(), before=ENDS_THE_RUN, one=ONE_RUN, until=until)
    assert found.points == 0.0
    found = graded(before="self.cart.set_velocity((1, 0, 0))", one=ONE_RUN, until=until)
    assert found.passed and found.outcomes[0].time == pytest.approx(0.25, abs=0.002)


@pytest.mark.slow
def test_a_file_of_the_exercise_beside_the_hand_in_is_not_used(graded, tmp_path):
    (tmp_path / "hand_in").mkdir()
    other = tmp_path / "hand_in" / "referee.py"
    other.write_text("from simkit import WorldPlugin\nclass Referee(WorldPlugin):\n    pass\n")
    found = graded(before="self.cart.set_velocity((1, 0, 0))", one=ONE_RUN)
    assert found.outcomes[0].error.startswith("the folder of the hand-in has another referee.py than the exercise")
    other.write_text((tmp_path / "exercise" / "referee.py").read_text())  # a student's copy of the whole exercise
    assert graded(before="self.cart.set_velocity((1, 0, 0))", one=ONE_RUN).passed


@pytest.mark.slow
def test_a_hand_in_cannot_end_the_grading_with_an_error_of_the_machine(graded):
    for load, before in (("raise RenderError('no')", "pass"), ("pass", "raise RenderError('no')")):
        code = "from simkit.errors import RenderError\n"
        found = graded(code + load, code + before, one=ONE_RUN)
        assert found.points == 0.0 and "no" in found.outcomes[0].error


FORGED_END = """
from simkit_verification.testing.grading.run_stream import END, FrameWriter
for one in gc.get_objects():
    if isinstance(one, FrameWriter):
        one.add_json(END, {"problem": "x", "codes": 5})
        one.flush()
"""


@pytest.mark.slow
def test_an_end_with_values_of_wrong_types_is_no_error_of_the_judge(graded):
    found = graded(before=FORGED_END, one=ONE_RUN)
    assert found.points == 0.0 and found.outcomes[0].error == "x"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows cannot stop a process")
@pytest.mark.slow
def test_a_hand_in_that_stops_its_judge_is_not_run_again(graded, monkeypatch):
    monkeypatch.setattr(exercise_grading, "_SPARE_SECONDS", 5.0)
    timeout = ("duration: 0.3", "duration: 0.3\nwall_timeout: 1.0")
    found = graded(before="import signal; os.kill(os.getppid(), signal.SIGSTOP)", timeout=timeout)
    assert found.points == 0.0 and "of wall time" in found.outcomes[0].error
    assert found.outcomes[1].error.startswith("the run was not started")
