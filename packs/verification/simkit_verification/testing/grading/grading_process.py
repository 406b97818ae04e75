"""Process that runs an exercise with a hand-in and streams the run to its judge; it computes no verdict.

A hand-in may exit, hang, print anything, and change everything in this process.
"""

from __future__ import annotations

import json
import os
import sys
import traceback
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.child_process import exit_immediately, exit_with_parent
from simkit.errors import InputError, LoadError, PluginError, RenderError, SimkitError
from simkit.extend import Diagnostics, Where
from simkit.run_spec import JsonMapping, JsonObject
from simkit.testing import open_scenario, run_scenario
from simkit_verification.testing.grading.callback_limit import is_debugged, write_stacks_to
from simkit_verification.testing.grading.exercise import Exercise, ExerciseRun, read_exercise
from simkit_verification.testing.grading.run_stream import END, READY, FrameWriter

if TYPE_CHECKING:
    from simkit.recording.run_picture import DrivenPath

_PROGRESS_SECONDS: Final = 0.02  # simulated time between two signs of progress [s]


def main() -> None:
    """Read the job from standard input, run it, and write the stream to the pipe that standard output was.

    The job is one line of JSON: `exercise` (file), `folders` in which it may name files, `allow_code` for its plugin
    folders, `hand_in` (file; empty for none), `files` of the hand-in, `number` of the run, `picture` (file for a
    picture of the path; empty for none), `stacks` (file for the stack of this process) and `key` of the stream.
    """
    job = json.loads(_first_line())
    exit_with_parent()
    writer = FrameWriter(_take_standard_output(), bytes.fromhex(job.pop("key")))
    with open(job["stacks"], "a", encoding="utf-8") as stacks:
        write_stacks_to(stacks)
        writer.add_json(READY, {"debugged": is_debugged()})
        writer.flush()
        exercise = read_exercise(job["exercise"], job["folders"], allow_code=job["allow_code"])
        hand_in = Path(job["hand_in"]) if job["hand_in"] else None
        files = [Path(file) for file in job["files"]]
        try:
            end = _run_exercise(exercise, exercise.runs[job["number"]], hand_in, files, job["picture"], writer)
            if end is not None:
                writer.add_json(END, end)
                writer.flush()
        except OSError as error:  # the judge has all it needs, or the hand-in closed the pipe
            sys.exit(f"the recording cannot be written: {error.strerror}")
        sys.stdout.flush()
        exit_immediately(0)


def _first_line() -> bytes:
    """Return the first line of standard input, and leave the rest in the pipe."""
    line = bytearray()
    while not line.endswith(b"\n"):
        content = os.read(0, 1)
        if not content:
            break
        line += content
    return bytes(line)


def _take_standard_output() -> int:
    """Return a new descriptor for the pipe of standard output; what is printed goes to standard error."""
    pipe = os.dup(1)
    os.dup2(2, 1)
    return pipe


def _run_exercise(
    exercise: Exercise,
    variation: ExerciseRun,
    hand_in: Path | None,
    files: list[Path],
    picture: str,
    writer: FrameWriter,
) -> JsonObject | None:
    """Run a variation and stream it; return the reason if the run did not reach its end."""
    from simkit.recording.run_picture import DrivenPath, save_picture
    from simkit_verification.testing.grading.run_recorder import RunRecorder

    scenario = variation.scenario
    mistake = _syntax_error(files)
    if mistake:
        return {"error": mistake}
    try:
        more: JsonObject = {}
        if hand_in is not None:
            paths = [Path(path) for path in scenario.options.get("plugin_paths", ())]
            is_shadowed = not exercise.robot and any((path / hand_in.name).is_file() for path in paths)
            # the exercise's modules go first, unless one has the name of the hand-in
            more["plugin_paths"] = (hand_in.parent, *paths) if is_shadowed else (*paths, hand_in.parent)
            if exercise.node is not None:
                scenario = replace(scenario, nodes=(*scenario.nodes, {**exercise.node, "program": str(hand_in)}))
            elif exercise.robot:
                more["plugins"] = (*scenario.plugins, (exercise.robot, _make_plugin(hand_in, variation.parameters)))
        with open_scenario(scenario, **more) as sim:
            driven = DrivenPath(sim) if picture else None
            with RunRecorder(sim, scenario, writer, files) as recorder:
                on_slice = _on_slice(recorder.show_progress, driven)
                ended = run_scenario(
                    scenario, sim, on_slice, absent="wait", judged=False, slice_seconds=_PROGRESS_SECONDS
                )
                if driven is not None:
                    from simkit.sensors.cameras.overview_image import render_view

                    save_picture(sim, Path(picture), render_view, driven)
                recorder.finish({"reason": ended.reason})
        return None
    except (LoadError, InputError) as error:  # either the exercise or the plugin has an error
        codes = (
            [diagnostic.code for diagnostic in error.diagnostics if diagnostic.severity == "error"]
            if isinstance(error, LoadError)
            else []
        )
        return {"problem": str(error), "codes": codes or [error.code]}
    except (KeyboardInterrupt, SystemExit) as error:
        return {"error": f"{type(error).__name__} ended the run{_error_position(error, hand_in)}"}
    except PluginError as error:
        return {"error": _exception_text(error, files)}
    except RenderError as error:  # the submission is not the cause: this machine cannot run the exercise
        return {"fault": str(error), "codes": [error.code]}
    except SimkitError as error:
        return {"error": str(error)}


def _on_slice(show_progress: Callable[[], None], driven: DrivenPath | None) -> Callable[[], None]:
    """Return the function that is called between two steps."""
    if driven is None:
        return show_progress

    def on_slice() -> None:
        driven.sample()
        show_progress()

    return on_slice


def _make_plugin(file: Path, parameters: JsonMapping) -> object:
    """Create an instance of the plugin class in a file.

    Raises:
        LoadError: SK-PLUGIN-008 the file has no plugin, or running the file or creating the plugin failed.
    """
    from simkit.params import Params
    from simkit.plugins.discovery.user_plugins import find_user_plugin
    from simkit.scene import ScenePlugin

    diagnostics = Diagnostics()
    where = Where(str(file))
    scene_plugin = ScenePlugin(file.stem, file.name, "", Params("plugin", "", {}, (), where), where)
    plugin_class = find_user_plugin(scene_plugin, [file.parent], diagnostics)
    if plugin_class is None:
        if not diagnostics.has_errors:
            diagnostics.error("SK-PLUGIN-008", f"{file.name} contains no plugin", where)
        raise LoadError(tuple(diagnostics))
    try:
        return plugin_class(**parameters)
    except Exception as error:
        message = (
            f"creating {plugin_class.__name__} failed: {type(error).__name__}: {error}{_error_position(error, file)}"
        )
        diagnostics.error("SK-PLUGIN-008", message, where)
        raise LoadError(tuple(diagnostics)) from error


def _syntax_error(files: Sequence[Path]) -> str:
    """Return the place and the text of a syntax error in a Python file of the hand-in; empty if there is none."""
    for file in files:
        if file.suffix != ".py":
            continue
        try:
            compile(file.read_bytes(), str(file), "exec", dont_inherit=True)
        except SyntaxError as error:
            code = (error.text or "").strip()
            return f"{file}:{error.lineno or 1}: {type(error).__name__}: {error.msg}" + (f"\n{code}" if code else "")
        except (OSError, ValueError):
            continue  # the import reports it
    return ""


def _exception_text(error: PluginError, files: Sequence[Path]) -> str:
    """Return the place, the text and the moment of an exception in one line, then the line of code.

    The place is the innermost line of the hand-in; without one, the text is that of the plugin's error.
    """
    cause, names = error.__cause__, {str(file) for file in files} | {str(file.resolve()) for file in files}
    frames = [] if cause is None else [f for f in traceback.extract_tb(cause.__traceback__) if f.filename in names]
    if cause is None or not frames:
        return str(error)
    kind = type(cause).__name__
    text = f"{kind}: {cause}" if str(cause) else kind
    moment = f"in {error.hook} at t = {error.time:.6g} s"
    return f"{Path(frames[-1].filename).name}:{frames[-1].lineno}: {text}, {moment}\n{frames[-1].line}"


def _error_position(error: BaseException, file: Path | None) -> str:
    """Return the line of the plugin's file in which an error occurred; empty if it occurred in another file."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if file is not None and f.filename == str(file)]
    frames = frames or [
        f for f in traceback.extract_tb(error.__traceback__) if file and Path(f.filename) == file.resolve()
    ]
    return f"\n{Path(frames[-1].filename).name}:{frames[-1].lineno}: {frames[-1].line}" if frames else ""


if __name__ == "__main__":
    main()
