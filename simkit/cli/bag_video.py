"""Command `simkit bag video`: film a bag in its world."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from simkit.cli.run_loop import Interrupts
from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import completion, film_options, options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import print_diagnostics, print_json, print_line, print_note, report_errors_quietly


@report_errors_quietly
@with_run_options("file", "world", usual={"model_world": "empty space"})
def video(
    recording: options.Recording,
    world: Annotated[str, argument("World of the recorded run.", "WORLD", completion.worlds)],
    output: Annotated[Path, option("Film to write: OUT.mp4, OUT.webm or OUT.gif.", "OUT", "--output", "-o")] = Path(
        "bag.mp4"
    ),
    resolution: film_options.Resolution = None,
    fps: film_options.Fps = None,
    camera: film_options.FilmCamera = "auto",
    start: options.Start = None,
    end: options.End = None,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,
) -> int:
    """Film a bag: its poses or odometry, joint states and scans, drawn in its world."""
    from simkit.build import load
    from simkit.cli.run_pictures import check_renderer
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.recording.films.film import film_bag
    from simkit.recording.films.film import film_options as read_options
    from simkit.sensors.cameras.overview_image import render_view

    is_gif = output.suffix.lower() == ".gif"
    found = read_options(output if is_gif else None, None if is_gif else output, resolution, fps, camera)
    assert found is not None
    with open_bag_to_read(recording) as bag, Interrupts() as interrupts:
        with load(world, **given.load_arguments()) as sim:
            check_renderer(sim)
            print_diagnostics(sim.diagnostics, verbose=False)
            count, moved = film_bag(sim, bag, found, render_view, (start, end), lambda: interrupts.exit_code != 0)
        if not moved:
            print_note(f"note: {recording} moves no model of {world}: it has no odometry or poses of its models")
    if json_:
        print_json({"output": str(output), "frames": count, "models": sorted(moved)})
    else:
        print_line(f"{output}: {count} frames, {float(found.frame_rate):g} per second")
    return interrupts.exit_code
