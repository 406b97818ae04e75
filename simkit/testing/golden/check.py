"""Check of a golden run: run the same scenario again, compare the results, explain differences, draw both worlds."""

from __future__ import annotations

import os
import shlex
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import Diagnostics, Where
from simkit.errors import InputError, RenderError, SimkitError
from simkit.recording.pictures.camera import Camera
from simkit.recording.pictures.frames import Look, choose_camera, draw_frame
from simkit.recording.pictures.overlay import Marks
from simkit.recording.pictures.subject import find_subject
from simkit.run_spec import FilePath, JsonMapping, RunSpec
from simkit.sensors.cameras.overview_image import render_view
from simkit.testing.golden.cause import explain, world_changes
from simkit.testing.golden.cause.world_patch import patch_world
from simkit.testing.golden.compare.difference import Verdict
from simkit.testing.golden.compare.runs import compare
from simkit.testing.golden.store import (
    MAIN_FILE,
    golden_folder,
    is_golden,
    line_of_key,
    read_golden,
    read_history,
    write_golden,
)
from simkit.testing.run_record.fingerprint import RENDERER
from simkit.testing.run_record.record import RunRecord
from simkit.testing.run_record.run_recorder import ENVIRONMENT_VARIABLES, record_run
from simkit.testing.scenarios.code_permission import check_requests, permit_code
from simkit.testing.scenarios.readable_files import OUTSIDE, ReadableFiles, Refusal, label
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.testing.scenarios.scenario_run import open_scenario

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.testing.run_record.record import RunRecord


CAUSE_BUDGET_SECONDS: Final = 60.0
"""Wall-clock limit of the search for causes [s]."""
_MAX_NAMED: Final = 5  # maximum number of world changes in an error message
_MAX_DIFFERENCES: Final = 12  # maximum number of differences that the history stores for one blessing


def check_golden(
    folder: str | os.PathLike[str],
    *,
    scenario: RunSpec | None = None,
    bless: str | None = None,
    other_renderer: bool = False,
    causes: bool = True,
    budget_s: float = CAUSE_BUDGET_SECONDS,
    pictures: bool = False,
    allow_code: bool = False,
    plugin_paths: Sequence[FilePath] = (),
    folders: Sequence[FilePath] = (),
) -> Verdict:
    """Run the scenario of a golden run again and compare the results.

    Args:
        folder: Folder of the golden run.
        scenario: Scenario to run. If None, the file of the scenario is read again; without a file, the scenario
            stored in the golden run is used.
        bless: Reason why the differences are correct; the new run then becomes golden. Without
            differences of outputs and of the version of simkit, nothing is written.
        other_renderer: Allow a blessing of pictures that come from another renderer.
        causes: Search for the causes of differences.
        budget_s: Wall-clock limit of the search for causes [s].
        pictures: Draw the worlds of both runs if their results differ.
        folders: Folders in which the golden run may name files, beside its own folder, the folder that contains it, and
            its project.
        allow_code: Allow the code that the golden run and its scenario name: plugin folders, or a scenario in Python.
            The code has the same rights as the user.
        plugin_paths: Allow the code in these folders only.

    Returns:
        Verdict. After a blessing, the verdict lists the differences from the previous golden run.

    Raises:
        InputError: SK-GOLDEN-002 to SK-GOLDEN-004 the golden run cannot be read; SK-GOLDEN-006 its scenario cannot be
            run here; SK-GOLDEN-007 the run must not be blessed; SK-SCEN-008 it needs code that is not allowed;
            SK-URI-003 it names a file elsewhere; or the world cannot be loaded.
        RenderError: The scenario has pictures, and no renderer is available.
    """
    if bless is not None and not bless.strip():
        raise InputError(
            "SK-GOLDEN-007", "--bless has no reason", help="state one, such as --bless 'wheels are 1 mm larger'"
        )
    place = golden_folder(folder)
    golden = read_golden(place)
    current_scenario = scenario or _current_scenario(place, golden, folders, allow_code, plugin_paths)
    current_scenario = permit_code(current_scenario, allow_code, plugin_paths)
    with _recorded_environment(golden.environment), _run_today(golden, current_scenario) as (run, elapsed):
        comparison = compare(golden, run)
        verdict = Verdict(place.resolve().name, golden, run, comparison, None, run.checks, elapsed)
        if comparison.can_be_blessed and bless is not None:
            make_golden(place, verdict, bless.strip(), other_renderer=other_renderer)
        elif not comparison.passed and causes:
            verdict.explanation = explain(golden, run, comparison, budget_s=budget_s)
        if pictures and not comparison.passed:
            verdict.world_pictures, verdict.world_note = draw_worlds(golden, run)
        return verdict


@contextmanager
def _run_today(golden: RunRecord, scenario: RunSpec) -> Iterator[tuple[RunRecord, float]]:
    """Run a scenario and yield its record and its wall time [s]; close the simulation at the end of the block."""
    started = time.perf_counter()
    try:
        run = record_run(scenario)
    except InputError as error:
        raise _append_world_changes(error, golden, scenario) from None
    try:
        yield run, time.perf_counter() - started
    finally:
        if run.simulation is not None:
            run.simulation.close()
            run.simulation = None


def _append_world_changes(error: InputError, golden: RunRecord, scenario: RunSpec) -> InputError:
    """Add the changes of the world to an error, because a change may have removed a topic that the scenario needs."""
    still = replace(scenario, commands=(), play="", play_topics=(), checks=(), until="", timeout=None, duration=0.0)
    try:
        run = record_run(still)
    except SimkitError:
        return error  # the error is that the world cannot be loaded
    if run.simulation is not None:
        run.simulation.close()
    changes = world_changes(golden, run)
    if not changes:
        return error
    lines = [f"{change.words} ({change.where})" if change.where else change.words for change in changes[:_MAX_NAMED]]
    if len(changes) > len(lines):
        lines.append(f"{len(changes) - len(lines)} more")
    text = "\n".join(f"    changed since the golden run: {line}" for line in lines)
    return InputError(error.code, f"{error}\n{text}", shows_code=False)


def golden_scenario(
    folder: FilePath,
    *,
    folders: Sequence[FilePath] = (),
    allow_code: bool = False,
    plugin_paths: Sequence[FilePath] = (),
) -> RunSpec | None:
    """Return the scenario of a golden run, which a check would run; None if a path is not a golden run.

    Args:
        folder: Folder.
        folders: Folders in which the golden run may name files, as in `check_golden`.
        allow_code: Allow the code that the golden run and its scenario name.
        plugin_paths: Allow the code in these folders only.

    Raises:
        InputError: See `check_golden`.
    """
    if not is_golden(folder):
        return None
    place = golden_folder(folder)
    return _current_scenario(place, read_golden(place), folders, allow_code, plugin_paths)


def _current_scenario(
    place: Path,
    golden: RunRecord,
    folders: Sequence[FilePath],
    allow_code: bool,
    plugin_paths: Sequence[FilePath],
) -> RunSpec:
    """Return the scenario to run. If the scenario has a file, read the file again, because it may have been changed."""
    stored = golden.scenario
    if stored.file is not None or not (stored.test or stored.plugins):
        refused_files(place, stored, folders).raise_if_errors()
    if stored.file is not None and stored.file.is_file():
        scripts = [request for request in stored.code_requests if request.path == stored.file]
        check_requests(scripts, allow_code, plugin_paths)  # reading a scenario in Python runs it
        return read_scenario(stored.file, folders)
    if stored.file is not None:
        problem = f": its scenario {stored.file.resolve()} does not exist"
        help_ = "restore the file, or record anew"
    elif stored.test:
        test = shlex.quote(os.path.normpath(place / "../../.." / stored.test))
        problem, help_ = " belongs to a test that creates plugins or steps the simulation", f"run pytest {test}"
    elif stored.plugins:
        problem = f" was recorded with plugins created in Python ({', '.join(map(str, stored.plugins))}), unknown here"
        help_ = (
            "check the run in the program that creates the plugins: use the fixture sensor_regression, or "
            "simkit.testing.golden.check.check_golden(folder, scenario=...)"
        )
    else:
        return stored
    raise InputError("SK-GOLDEN-006", f"{place}{problem}", help=help_)


def refused_files(place: Path, scenario: RunSpec, folders: Sequence[FilePath] = ()) -> Diagnostics:
    """Return an error for each file that a golden run names and may not name.

    Args:
        place: Folder of the golden run.
        scenario: Scenario that the golden run stores.
        folders: Folders of the user.
    """
    diagnostics = Diagnostics()
    file = place / MAIN_FILE
    refused: Iterator[tuple[tuple[object, ...], Refusal]]
    files = ReadableFiles(file, folders, container=_container(place.absolute()))
    if scenario.file is not None:  # it is read again, and names the other files
        refusal = files.refusal(scenario.file)
        refused = iter([] if refusal is None else [(("file",), refusal)])
    else:
        refused = files.refused(scenario)
    for keys, (problem, hint) in refused:
        diagnostics.error(
            OUTSIDE, f"{label(keys)}: {problem}", Where(str(file), line_of_key(place, str(keys[0]))), hint
        )
    return diagnostics


def _container(place: Path) -> Path:
    """Return the folder that contains a golden run; for `FOLDER/golden/NAME` and the layout of pytest, `FOLDER`."""
    layout = next((folder for folder in (place.parent, place.parent.parent) if folder.name == "golden"), place)
    return layout.parent


@contextmanager
def _recorded_environment(environment: Mapping[str, str]) -> Iterator[None]:
    """Set the environment variables that describe the world to their recorded values."""
    original = {name: os.environ.get(name) for name in ENVIRONMENT_VARIABLES if name in environment}
    try:
        os.environ.update({name: environment[name] for name in original})
        yield
    finally:
        for name, value in original.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def make_golden(place: Path, verdict: Verdict, reason: str, *, other_renderer: bool = False) -> None:
    """Replace a golden run by the run of a verdict and add the differences to the history.

    Args:
        place: Folder of the golden run.
        verdict: New run and its differences.
        reason: Reason why the differences are correct.
        other_renderer: Allow pictures of another renderer.

    Raises:
        InputError: SK-GOLDEN-007 the run failed, or its pictures come from another renderer.
    """
    golden, run = verdict.golden, verdict.run
    refuse_failed(run, place)
    if not other_renderer:
        before, now = golden.fingerprint.get(RENDERER), run.fingerprint.get(RENDERER)
        if before and now and before != now:
            raise InputError(
                "SK-GOLDEN-007",
                f"{place} is not blessed: its pictures come from {before}, the new pictures from {now}; "
                "on other machines the pictures would differ",
                help="bless the run on a machine with the first renderer (CI), or add --bless-other-renderer",
            )
    words = [difference.words for difference in verdict.comparison.differences]
    more = len(words) - _MAX_DIFFERENCES
    changed = [*words[:_MAX_DIFFERENCES], *([f"and {more} more"] if more > 0 else [])]
    history: list[JsonMapping] = read_history(place)
    write_golden(place, run, reason=reason, changed=changed, history=history)


def refuse_failed(run: RunRecord, place: Path) -> None:
    """Raise an error if a run failed, because a failed run must not become golden.

    Raises:
        InputError: SK-GOLDEN-007 the run failed.
    """
    if run.error is not None:
        raise InputError("SK-GOLDEN-007", f"{place}: the run failed and cannot become golden: {run.error}")


_SIZE: Final = (800, 500)  # [px]
_JPEG_QUALITY: Final = 88
_ROOM: Final = 20.0  # size of a room that is shown whole, in sizes of the robots


def draw_worlds(golden: RunRecord, run: RunRecord) -> tuple[tuple[tuple[str, bytes], ...], str]:
    """Draw both worlds at the beginning of their runs.

    Args:
        golden: record of the golden run; its values are set in the world of the new run.
        run: record of the new run.

    Returns:
        Name and JPEG file of each picture, and a note that explains missing pictures; one of both is empty.
    """
    edits = [edit for change in world_changes(golden, run) for edit in change.edits if edit.kind != "scenario"]
    if not edits:
        return (), "the worlds of both runs are equal"
    if run.scenario.plugins:
        return (), "no pictures of the worlds: the plugins of the run were created in Python"
    scenario = replace(run.scenario, duration=0.0, until="", timeout=None, wall_timeout=None, checks=())
    values = {edit.path: edit.golden for edit in edits}
    pictures = []
    try:
        with open_scenario(scenario) as sim:
            picture, camera = _draw(sim, None)
            pictures.append(("run", picture))
        with open_scenario(
            scenario, change_world=lambda world: patch_world(world, run.leaves, values, order=golden.leaves)
        ) as sim:
            pictures.append(("golden", _draw(sim, camera)[0]))
    except RenderError as error:
        return (), f"no pictures of the worlds: {error}"
    except SimkitError as error:
        return (), f"no pictures of the worlds: the golden world cannot be built again ({str(error).splitlines()[0]})"
    except Exception as error:  # noqa: BLE001 - golden values come from a file and may cause any error
        return (), f"no pictures of the worlds: the golden world cannot be built again ({type(error).__name__})"
    return tuple(reversed(pictures)), ""


def _draw(sim: Simulation, camera: Camera | None) -> tuple[bytes, Camera]:
    """Return a picture as a JPEG file, and its camera."""
    import cv2

    look = Look(*_SIZE)
    subject = find_subject(sim, [], _ROOM)
    camera = choose_camera(sim, render_view, subject, look) if camera is None else camera
    colours = draw_frame(sim, render_view, camera, look, Marks(), subject)
    _, data = cv2.imencode(".jpg", colours[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
    return data.tobytes(), camera
