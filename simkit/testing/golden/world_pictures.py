"""Pictures of the world of a golden run and of the world of a new run, from the same side."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from simkit.errors import RenderError, SimkitError
from simkit.recording.pictures.camera import Camera
from simkit.recording.pictures.frames import Look, choose_camera, draw_frame
from simkit.recording.pictures.overlay import Marks
from simkit.recording.pictures.subject import find_subject
from simkit.testing.golden.cause import world_changes
from simkit.testing.golden.cause.world_patch import patch_world
from simkit.testing.scenarios.scenario_run import open_scenario

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.testing.run_record.record import RunRecord

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
    found = []
    try:
        with open_scenario(scenario) as sim:
            picture, camera = _draw(sim, None)
            found.append(("run", picture))
        with open_scenario(
            scenario, change_world=lambda world: patch_world(world, run.leaves, values, order=golden.leaves)
        ) as sim:
            found.append(("golden", _draw(sim, camera)[0]))
    except RenderError as error:
        return (), f"no pictures of the worlds: {error}"
    except SimkitError as error:
        return (), f"no pictures of the worlds: the golden world cannot be built again ({str(error).splitlines()[0]})"
    except Exception as error:  # noqa: BLE001 - golden values come from a file and may cause any error
        return (), f"no pictures of the worlds: the golden world cannot be built again ({type(error).__name__})"
    return tuple(reversed(found)), ""


def _draw(sim: Simulation, camera: Camera | None) -> tuple[bytes, Camera]:
    """Return a picture as a JPEG file, and its camera."""
    import cv2

    from simkit.sensors.cameras.overview_image import render_view

    look = Look(*_SIZE)
    subject = find_subject(sim, [], _ROOM)
    camera = choose_camera(sim, render_view, subject, look) if camera is None else camera
    colours = draw_frame(sim, render_view, camera, look, Marks(), subject)
    _, data = cv2.imencode(".jpg", colours[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
    return data.tobytes(), camera
