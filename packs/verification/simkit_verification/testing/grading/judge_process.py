"""Process that judges one run of an exercise: it starts the process of the hand-in and evaluates its stream.

No code of the hand-in runs in this process.
"""

from __future__ import annotations

import ctypes
import json
import os
import queue
import secrets
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from simkit import RunSpec, render_view
from simkit.child_process import OutputTail, exit_immediately, exit_with_parent, last_lines
from simkit.errors import InputError, LoadError, RenderError, SimkitError
from simkit.extend import Diagnostics
from simkit.loaders import Resolver
from simkit.loaders.resources.world_interfaces import read_interfaces
from simkit.process_control import kill_process_tree
from simkit.run_spec import JsonObject
from simkit.testing import Watch, open_scenario
from simkit.testing.conditions.check_list import CheckList
from simkit.testing.conditions.checks import CheckResult
from simkit_verification.testing.grading import run_stream
from simkit_verification.testing.grading.callback_limit import CallbackLimit, CallbackPosition
from simkit_verification.testing.grading.exercise import Exercise, ExerciseRun, read_exercise
from simkit_verification.testing.grading.lab_files import copy_lab, replaced_modules
from simkit_verification.testing.grading.recorded_view import Key, RecordedNames, RecordedView
from simkit_verification.testing.grading.run_stream import (
    CLOCK,
    NUMBER,
    READY,
    DamagedStreamError,
    FrameReader,
    read_json,
)

_KINDS_OF_SOURCES = frozenset(("pose", "twist", "joint", "exists", "contacts", "latest", "count"))
_MOST_SOURCES = 10_000


class RunJudge:
    """Judge of one run.

    Args:
        scenario: Scenario of the run with its checks, from the exercise and not from the hand-in.

    Attributes:
        end: JSON values of the end of the run; None before the end.
    """

    def __init__(self, scenario: RunSpec) -> None:
        self._scenario = scenario
        self._view = RecordedView()
        self._checks: CheckList | None = None
        self._sources: list[Key] = []
        self._steps = 0
        self._foreign: tuple[str, ...] = ()
        self.end: JsonObject | None = None

    @property
    def time(self) -> float:
        """Simulated time of the newest frame [s]."""
        return self._view.clock.time

    def is_over(self) -> bool:
        """Check whether the run has ended: later frames have no meaning."""
        return self.end is not None

    def take(self, kind: int, content: bytes) -> None:
        """Take the next frame.

        Raises:
            DamagedStreamError: The frame is invalid, or does not follow from the ones before.
            InputError: The checks do not fit the recorded world.
        """
        if kind == run_stream.VALUE:
            self._view.set_value(self._source(content), content[NUMBER.size :])
        elif kind == run_stream.STEP:
            self._take_step(content)
        elif kind in (run_stream.OBSERVE, run_stream.BEAT):
            self._set_clock(content)
            if kind == run_stream.OBSERVE:
                self._view.observe("", 100.0)
        elif kind in (run_stream.MESSAGE, run_stream.FEED):
            topic = self._source(content)[1]
            self._set_clock(content[NUMBER.size :])
            if kind == run_stream.MESSAGE:
                self._view.count_message(topic)
            else:
                self._view.observe(topic)
        elif kind == run_stream.SOURCE:
            self._add_source(read_json(content))
        elif kind == run_stream.NAMES:
            self._take_names(RecordedNames.from_json(read_json(content)))
        elif kind == run_stream.END:
            self.end = read_json(content)

    def results(self) -> tuple[Sequence[CheckResult], str]:
        """Return the results of all checks after the end of the run, and the reason if the run has no valid end."""
        if self._checks is None or self.end is None:
            raise DamagedStreamError("it has no steps")
        for topic, rate in dict(self.end.get("rates", {})).items():
            self._view.rates[str(topic)] = None if rate is None else float(rate)
        reason = str(self.end.get("reason", ""))
        if self._checks.ended:
            return self._checks.results("until"), ""
        if reason == "wall_timeout":
            return self._checks.results(reason), ""
        if self.time < self._scenario.longest - 1.5 * self._view.clock.timestep - 1e-9:
            return (), f"the run ended at t = {self.time:.6g} s, before t = {self._scenario.longest:g} s"
        return self._checks.results("timeout" if self._scenario.until else "duration"), ""

    def foreign_text(self) -> str:
        """Return an error text if the hand-in publishes on a topic of the exercise; else an empty text."""
        if not self._foreign:
            return ""
        return f"the hand-in publishes on {', '.join(self._foreign[:3])}, which only the exercise may do"

    # ------------------------------------------------------------------ frames

    def _take_step(self, content: bytes) -> None:
        before = self._view.clock.tick
        self._set_clock(content)
        if self._checks is None:
            self._checks = CheckList(
                self._view, self._scenario.checks, until=self._scenario.until, timeout=self._scenario.longest
            )
            self._checks.begin()
            return
        if self._checks.ended:
            raise DamagedStreamError("the run goes on after its end")
        if self._checks.need_every_step and self._view.clock.tick > before + 1:
            raise DamagedStreamError(f"steps before t = {self.time:.6g} s are missing")
        self._view.observe("", None)
        self._checks.look()

    def _take_names(self, names: RecordedNames) -> None:
        self._foreign = self._foreign or names.foreign
        self._view.set_names(names)
        if self._checks is not None:
            self._checks.bind_waiting()

    def _add_source(self, source: JsonObject) -> None:
        key = source.get("key")
        texts = tuple(text for text in key if isinstance(text, str)) if isinstance(key, list) else ()
        if len(texts) < 2 or texts[0] not in _KINDS_OF_SOURCES or len(self._sources) >= _MOST_SOURCES:
            raise DamagedStreamError("a source is invalid")
        self._sources.append(texts)

    def _source(self, content: bytes) -> Key:
        number = NUMBER.unpack_from(content)[0] if len(content) >= NUMBER.size else len(self._sources)
        if number >= len(self._sources):
            raise DamagedStreamError("a source is unknown")
        return self._sources[number]

    def _set_clock(self, content: bytes) -> None:
        if len(content) != CLOCK.size:
            raise DamagedStreamError("a time is invalid")
        clock = self._view.clock
        clock.tick, clock.time_ns, clock.time = CLOCK.unpack(content)


_SPARE_SECONDS: Final = 20.0  # additional wall time for starting and ending the process of a run [s]
_MAX_LINES_SHOWN: Final = 20  # maximum number of printed lines in a grade; the last ones are stored
_CHUNK: Final = 1 << 16
_WAITING_CHUNKS: Final = 256
_END_WAIT: Final = 2.0  # [s] longest wait for the end of a process that closed its stream
_LEAST_POLL: Final = 0.02  # [s]
_SET_DUMPABLE: Final = 4  # of prctl
_EMPTY_WORLD: Final = '<sdf version="1.9"><world name="empty"/></sdf>'


def main(job_file: str) -> None:
    """Run and judge one variation of an exercise, and write the result to a JSON file.

    Args:
        job_file: JSON file with the job: `exercise` (file), `folders` in which it may name files, `allow_code` for its
            plugin folders, `hand_in` (file; empty for none), `folder` and `files` of the hand-in of a lab (`folder` is
            empty if the hand-in stays where it is), `number` of the run, `target` (file for the result), `picture`
            (file for a picture of the path; empty for none), `limit` of a callback, and `token`, which is copied to the
            result. The file is removed before the hand-in runs.
    """
    job = json.loads(Path(job_file).read_text(encoding="utf-8"))
    Path(job_file).unlink()
    _hide_memory()
    result = _judge(job)
    Path(job["target"]).write_text(json.dumps({**result, "token": job["token"]}), encoding="utf-8")


def _hide_memory() -> None:
    """Deny other processes of the user, such as the one of the hand-in, to read or write the memory of this process."""
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(_SET_DUMPABLE, 0, 0, 0, 0)


def _judge(job: JsonObject) -> JsonObject:
    exercise = read_exercise(job["exercise"], job["folders"], allow_code=job["allow_code"])
    variation = exercise.runs[job["number"]]
    with tempfile.TemporaryDirectory(prefix="simkit-grade-", ignore_cleanup_errors=True) as name:
        folder = Path(name).resolve()
        stacks = folder / "stacks"
        stacks.touch()
        staged, hand_in, files = exercise.file, job["hand_in"], [job["hand_in"]] if job["hand_in"] else []
        if job["folder"]:
            lab = folder / "lab"
            try:
                copied = copy_lab(exercise.file.parent, Path(job["folder"]), job["files"], lab)
            except InputError as error:
                return {"error": str(error), "time": 0.0, "printed": ""}
            files = [str(file) for file in copied]
            staged, hand_in = lab / exercise.file.name, str(lab / exercise.hand_in) if exercise.hand_in else ""
        elif hand_in:
            folders = [Path(path) for path in variation.scenario.options.get("plugin_paths", ())]
            replaced = replaced_modules(Path(hand_in), folders)
            if replaced:
                message = f"the folder of the hand-in has another {', '.join(replaced)} than the exercise"
                return {"error": f"{message}\nhelp: remove it, or hand in a folder without it", "time": 0.0}
        task = {
            "exercise": str(staged.absolute()),
            "folders": job["folders"],
            "allow_code": job["allow_code"],
            "hand_in": hand_in,
            "files": [str(Path(file).resolve()) for file in files],
            "number": job["number"],
            "picture": job["picture"],
            "stacks": str(stacks),
        }
        spec = variation.scenario
        if job["folder"]:
            spec = read_exercise(staged, job["folders"], allow_code=job["allow_code"]).runs[job["number"]].scenario
        _register_interfaces(spec)
        result = _JudgedRun(exercise, variation, task, job["limit"]).run()
        if job["folder"]:
            result = _renamed(result, str(folder / "lab"), job["folder"])
    return result


def _renamed(result: JsonObject, copy: str, folder: str) -> JsonObject:
    """Name the student's folder instead of its copy in all texts."""
    return {key: value.replace(copy, folder) if isinstance(value, str) else value for key, value in result.items()}


def _register_interfaces(scenario: RunSpec) -> None:
    """Read the definitions of messages that the world uses; they are data, also those of a hand-in."""
    options = scenario.options
    resolver = Resolver(options.get("resource_paths", ()), package_paths=options.get("package_paths"))
    with suppress(SimkitError):  # the other process reports the same error
        read_interfaces(options.get("interfaces", ()), scenario.source, resolver, Diagnostics())


class _JudgedRun:
    """One run in the other process.

    Args:
        exercise: Exercise.
        variation: Run.
        task: Job of the other process, without its key.
        limit: Limit of a callback [s]; 0 for none.
    """

    def __init__(self, exercise: Exercise, variation: ExerciseRun, task: JsonObject, limit: float) -> None:
        self._exercise, self._variation, self._task, self._limit = exercise, variation, task, limit
        self._judge = RunJudge(variation.scenario)
        self._wall_limit = (variation.scenario.wall_timeout or 0.0) + _SPARE_SECONDS

    def run(self) -> JsonObject:
        """Return the results of the checks, or an error."""
        key = secrets.token_bytes(32)
        reader = FrameReader(key)
        with _process({**self._task, "key": key.hex()}) as (process, tail, chunks):
            end = self._follow(process, reader, chunks)
            kill_process_tree(process)
            code = process.wait()
            printed = "\n".join(last_lines(tail.text(), _MAX_LINES_SHOWN))
        if end is None:
            end = self._ended_early(code) if self._judge.end is None and not self._judge.is_over() else self._verdict()
        return {"time": self._judge.time, **end, "printed": printed}

    def _follow(
        self, process: subprocess.Popen[bytes], reader: FrameReader, chunks: queue.Queue[bytes]
    ) -> JsonObject | None:
        """Judge the stream until the end of the run; return an error if there is one."""
        callback = CallbackLimit(process.pid, Path(self._task["stacks"]), 0.0, self._is_of_hand_in)
        deadline = time.monotonic() + self._wall_limit
        poll = max(_LEAST_POLL, 0.1 * self._limit) if self._limit else 1.0
        while not self._judge.is_over():
            if time.monotonic() > deadline:
                limit = f"{self._wall_limit:g} s of wall time"
                message = f"the run was stopped after {limit}; the plugin may have an endless loop"
                return {"error": message, "stuck": 0.0 < self._limit < callback.idle_time}
            try:
                content = chunks.get(timeout=poll)
            except queue.Empty:
                stuck = callback.exceeded()
                if stuck is not None:
                    return {"error": _stuck_text(stuck, self._limit), "stuck": True}
                continue
            if not content:
                with suppress(subprocess.TimeoutExpired):
                    process.wait(_END_WAIT)
                return None
            callback.note_progress()
            try:
                for kind, frame in reader.feed(content):
                    if kind == READY:  # from now on, the process can be asked for its stack
                        callback.limit = 0.0 if read_json(frame).get("debugged") else self._limit
                    self._judge.take(kind, frame)
                    if self._judge.is_over():
                        break
            except (DamagedStreamError, ValueError, TypeError, LookupError, ArithmeticError) as error:
                return {"error": f"the recording of the run is damaged: {error}"}
            except InputError as error:
                return self._attribute(str(error), [error.code])
        return None

    def _is_of_hand_in(self, file: str) -> bool:
        """Check whether a file on the stack is one of the hand-in, or beside a hand-in in a folder of its own."""
        path, name = Path(file).resolve(), self._task["hand_in"]
        if str(path) in self._task["files"]:
            return True
        return (
            bool(name) and path.parent == Path(name).resolve().parent != Path(self._task["exercise"]).resolve().parent
        )

    def _ended_early(self, code: int) -> JsonObject:
        how = f"with {code}" if code >= 0 else f"by signal {-code}"
        return {"error": f"the process ended {how} before the run was complete", "time": 0.0}

    def _verdict(self) -> JsonObject:
        """Return the results after the end of the run, or its error."""
        end = self._judge.end or {}
        listed = end.get("codes")
        codes = [str(code) for code in listed] if isinstance(listed, list) else []
        if "problem" in end:
            return self._attribute(str(end["problem"]), codes)
        if "fault" in end:
            is_renderer_missing = not self._task["hand_in"] or not self._can_render()
            return {"fault" if is_renderer_missing else "error": str(end["fault"]), "code": codes[0] if codes else ""}
        if "error" in end:
            return {"error": str(end["error"])}
        foreign = self._judge.foreign_text()
        if foreign:
            return {"error": foreign}
        try:
            results, error = self._judge.results()
        except (DamagedStreamError, ValueError, TypeError, AttributeError) as problem:
            return {"error": f"the recording of the run is damaged: {problem}"}
        if error:
            return {"error": error}
        return {"results": [(result.passed, result.message, result.time) for result in results]}

    def _attribute(self, problem: str, codes: list[str]) -> JsonObject:
        """Return a problem of the world or the checks as a fault of the exercise, or as an error of the hand-in."""
        if self._task["hand_in"] and (
            (not self._exercise.robot and codes and set(codes) == {"SK-PLUGIN-008"}) or self._is_sound(codes)
        ):
            return {"error": problem, "time": self._judge.time}
        return {"fault": problem, "code": codes[0] if codes else ""}

    def _is_sound(self, codes: list[str]) -> bool:
        """Check whether the world and the checks of the exercise are valid without the hand-in."""
        scenario = self._variation.scenario
        try:
            with open_scenario(scenario) as sim:
                Watch(sim, scenario.checks, until=scenario.until, absent="wait")
        except LoadError as error:
            own_codes = {diagnostic.code for diagnostic in error.diagnostics if diagnostic.severity == "error"}
            return own_codes == {"SK-PLUGIN-001"} and "SK-PLUGIN-001" not in codes  # only the hand-in is missing
        except SimkitError:
            return False
        return True

    def _can_render(self) -> bool:
        """Check whether this machine can draw the world of the exercise, without the hand-in."""
        scenario = self._variation.scenario
        plain = RunSpec(_EMPTY_WORLD, options={"renderer": scenario.options.get("renderer")})
        for spec in (scenario, plain):  # the world of the exercise may need the hand-in
            try:
                with open_scenario(spec) as sim:
                    render_view(sim, 16, 16)
                return True
            except RenderError:
                return False
            except SimkitError:
                continue
        return True


def _stuck_text(stuck: CallbackPosition, limit: float) -> str:
    return (
        f"{stuck.callback_text} made no progress for {limit:g} s, and was stopped at {stuck.text}\n"
        "help: end the loop; --limit S allows a longer time, and 0 any time"
    )


@contextmanager
def _process(task: JsonObject) -> Iterator[tuple[subprocess.Popen[bytes], OutputTail, queue.Queue[bytes]]]:
    """Start the process of the hand-in: process, its printed output, and the bytes of its stream (empty at the end)."""
    process = subprocess.Popen(
        [sys.executable, "-P", "-m", "simkit_verification.testing.grading.grading_process"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )  # in the process group of the judge, which is killed at the end with all processes in it
    assert process.stdin is not None and process.stdout is not None
    tail = OutputTail(process.stderr)
    chunks: queue.Queue[bytes] = queue.Queue(_WAITING_CHUNKS)
    threading.Thread(target=_read_into(chunks), args=(process.stdout.fileno(),), daemon=True).start()
    try:
        with suppress(OSError):  # the process has ended already
            process.stdin.write(json.dumps(task).encode() + b"\n")
            process.stdin.flush()
        yield process, tail, chunks
    finally:
        kill_process_tree(process)
        process.wait()


def _read_into(chunks: queue.Queue[bytes]) -> Callable[[int], None]:
    def read(pipe: int) -> None:
        with suppress(OSError):
            while content := os.read(pipe, _CHUNK):
                chunks.put(content)
        chunks.put(b"")

    return read


if __name__ == "__main__":
    exit_with_parent()
    main(*sys.argv[1:])
    exit_immediately(0)
