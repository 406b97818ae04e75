"""Child process for one run of an exercise, because a submitted plugin may exit, hang or print anything."""

from __future__ import annotations

import json
import sys
import traceback
from pathlib import Path
from typing import Any

from simkit.child_process import exit_immediately, exit_with_parent
from simkit.diagnostics import Diagnostics, Where
from simkit.errors import InputError, LoadError, PluginError, RenderError, SimkitError
from simkit.run_spec import JsonMapping, JsonObject
from simkit.testing.scenarios.exercise import Exercise, ExerciseRun, read_exercise
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario


def main(job_file: str) -> None:
    """Run one variation of an exercise and write the result to a JSON file.

    Args:
        job_file: JSON file with the job: `exercise` and `hand_in` (files; empty for none), `folders` (in which the
            exercise may name files), `plugin_paths` (folders of the exercise whose code is allowed), `number` of the
            run, `target` (file for the result), `picture` (file for a picture of the path; empty for none), and
            `token`, which is copied to the result. The file is removed at once, so that the plugin cannot read the
            token.
    """
    job = json.loads(Path(job_file).read_text(encoding="utf-8"))
    Path(job_file).unlink()
    exercise = read_exercise(job["exercise"], job["folders"], plugin_paths=job["plugin_paths"])
    hand_in = Path(job["hand_in"]) if job["hand_in"] else None
    found = _run_exercise(exercise, exercise.runs[job["number"]], hand_in, job["picture"])
    try:
        Path(job["target"]).write_text(json.dumps({**found, "token": job["token"]}), encoding="utf-8")
    except OSError as error:  # the plugin removed the folder
        sys.exit(f"the result cannot be written: {error.strerror}")


def _run_exercise(exercise: Exercise, variation: ExerciseRun, hand_in: Path | None, picture: str) -> JsonObject:
    """Run a variation and return the results of its checks, or an error."""
    from simkit.recording.run_picture import DrivenPath, save_picture
    from simkit.runtime.engine.snapshot import state_hash

    sim: Any = None
    try:
        more: JsonObject = {}
        if hand_in is not None:
            paths = (hand_in.parent, *variation.scenario.options.get("plugin_paths", ()))
            more["plugin_paths"] = paths
            if exercise.robot:
                more["plugins"] = (
                    *variation.scenario.plugins,
                    (exercise.robot, _make_plugin(hand_in, variation.parameters)),
                )
        with open_scenario(variation.scenario, **more) as sim:
            driven = DrivenPath(sim) if picture else None
            on_slice = None if driven is None else driven.sample
            ended = run_scenario(variation.scenario, sim, on_slice, absent="wait")
            if driven is not None:
                from simkit.sensors.cameras.overview_image import render_view

                save_picture(sim, Path(picture), render_view, driven)
            results = [(result.passed, result.message, result.time) for result in ended.results]
            return {"end": ended.reason, "time": sim.time, "results": results, "state": state_hash(sim)}
    except (LoadError, InputError) as error:  # either the exercise or the plugin has an error
        is_of_plugin = not exercise.robot and _is_import_failure(error)  # the world itself names the plugin
        if hand_in is None or not (is_of_plugin or _is_sound_without_plugin(variation)):
            return {"fault": str(error), "code": error.code}
        return {"error": str(error), "time": 0.0 if sim is None else sim.time}
    except (KeyboardInterrupt, SystemExit) as error:
        place = _error_position(error, hand_in)
        return {"error": f"{type(error).__name__} ended the run{place}", "time": 0.0 if sim is None else sim.time}
    except PluginError as error:
        place = "" if error.__cause__ is None else _error_position(error.__cause__, hand_in)
        return {"error": f"{error}{place}", "time": error.time}
    except RenderError as error:  # the submission is not the cause: this machine cannot run the exercise
        return {"fault": str(error), "code": error.code}
    except SimkitError as error:
        return {"error": str(error), "time": 0.0 if sim is None else sim.time}


def _is_import_failure(error: InputError) -> bool:
    """Check whether a world cannot be loaded only because Python plugins cannot be imported."""
    found = [one.code for one in error.diagnostics if one.severity == "error"] if isinstance(error, LoadError) else []
    return bool(found) and set(found) == {"SK-PLUGIN-008"}


def _is_sound_without_plugin(variation: ExerciseRun) -> bool:
    """Check whether the world and the checks of an exercise are valid without a submission."""
    from simkit.testing.conditions import Watch

    scenario = variation.scenario
    try:
        with open_scenario(scenario) as sim:
            Watch(sim, scenario.checks, until=scenario.until, absent="wait")
    except SimkitError:
        return False
    return True


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
    found = find_user_plugin(scene_plugin, [file.parent], diagnostics)
    if found is None:
        if not diagnostics.has_errors:
            diagnostics.error("SK-PLUGIN-008", f"{file.name} contains no plugin", where)
        raise LoadError(tuple(diagnostics))
    try:
        return found(**parameters)
    except Exception as error:
        message = f"creating {found.__name__} failed: {type(error).__name__}: {error}{_error_position(error, file)}"
        diagnostics.error("SK-PLUGIN-008", message, where)
        raise LoadError(tuple(diagnostics)) from error


def _error_position(error: BaseException, file: Path | None) -> str:
    """Return the line of the plugin's file in which an error occurred; empty if it occurred in another file."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if file is not None and f.filename == str(file)]
    frames = frames or [
        f for f in traceback.extract_tb(error.__traceback__) if file and Path(f.filename) == file.resolve()
    ]
    return f"\n{Path(frames[-1].filename).name}:{frames[-1].lineno}: {frames[-1].line}" if frames else ""


if __name__ == "__main__":
    exit_with_parent()
    main(*sys.argv[1:])
    sys.stdout.flush()
    exit_immediately(0)
