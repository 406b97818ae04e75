"""Command `simkit map`: write the true occupancy map of a world."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.json_report import report_errors
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import print_diagnostics, print_json, print_line, print_note, without_interrupt_message
from simkit.writers.atomic_output import check_writable, write_atomically

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.sensors.occupancy_map import OccupancyMap

Place = tuple[float, float]
"""x and y in the world [m]."""

_SUFFIXES = (".pgm", ".yaml")


@report_errors
@without_interrupt_message
@with_run_options("file", "world", usual={"model_world": "empty space"})
def map(
    world: Annotated[str, argument("World or model.", "WORLD", completion.worlds)],
    output: Annotated[Path, option("Map to write: OUT.pgm and OUT.yaml.", "OUT", "--output", "-o")] = Path("map"),
    height: Annotated[float, option("Height of the slice [m].", "Z")] = 0.2,
    resolution: Annotated[float, option("Side of a cell [m].", "R", min=1e-4, max=1e3)] = 0.05,
    start: Annotated[
        str | None, option("Free place; what cannot be reached from it is unknown (default: the robot).", "X,Y")
    ] = None,
    everywhere: Annotated[bool, Option("--everywhere", help="Make every cell free that is not occupied.")] = False,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,
) -> None:
    """Write the true occupancy map of a world as PGM and YAML."""
    from simkit.build import load
    from simkit.sensors.occupancy_map import map_error

    place = None if start is None else _parse_place(start)
    if place is not None and everywhere:
        raise map_error("--start and --everywhere exclude each other", "leave one of them out")
    if output.name in ("", ".."):
        raise map_error(f"--output {str(output)!r} is a folder", "write the name of a file, without its ending: -o map")
    stem = output.with_suffix("") if output.suffix.lower() in _SUFFIXES else output
    image, description = (stem.with_name(stem.name + suffix) for suffix in _SUFFIXES)
    for path in (image, description):
        check_writable(path)
    with load(world, **given.load_arguments()) as sim:
        print_diagnostics(sim.diagnostics, verbose=False)
        grid = _make(sim, height, resolution, place, everywhere=everywhere)
    text = grid.description(image.name).encode()  # before the image: the name may not be valid UTF-8
    write_atomically(image, grid.image())
    write_atomically(description, text)
    rows, columns = grid.cells.shape
    counts = {
        name: int((grid.cells == value).sum()) for name, value in (("occupied", 100), ("free", 0), ("unknown", -1))
    }
    if json_:
        print_json({"output": [str(image), str(description)], "rows": rows, "columns": columns, **counts})
    else:
        cells = ", ".join(f"{count} {name}" for name, count in counts.items())
        print_line(f"{image}, {description}: {columns} × {rows} cells of {resolution:g} m at z = {height:g} m; {cells}")


def _make(sim: Simulation, height: float, resolution: float, start: Place | None, *, everywhere: bool) -> OccupancyMap:
    """Return the map; without a start, it begins at the first model that can move and has joints, if that is free."""
    from simkit.sensors.occupancy_map import make_map, map_error

    robot = next((model for model in sim.models.values() if not model.static and model.joints), None)
    is_given, begin = start is not None, start
    if begin is None and robot is not None and not everywhere:
        x, y, _ = robot.pose.position.tolist()
        begin = x, y
    contained = [begin] if begin is not None and not is_given else []
    full_map = make_map(sim.mj_model, sim.engine.physics.fresh(), height, resolution, contained)
    if begin is None:
        return full_map
    reachable = full_map.reachable_from(begin)
    if reachable is None and is_given:
        message = f"the start ({begin[0]:g}, {begin[1]:g}) is occupied or outside of the map"
        raise map_error(message, "--start X,Y chooses a free place")
    if reachable is None and robot is not None:
        print_note(f"note: {robot.name} is not in a free cell, so every cell is free that is not occupied")
    return reachable or full_map


def _parse_place(text: str) -> Place:
    """Return x and y [m] of a text `X,Y`."""
    from simkit.sensors.occupancy_map import map_error

    try:
        x, y = (float(part) for part in text.split(","))
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise map_error(f"--start {text!r}: expected two numbers, X,Y [m]", "write for example --start 0,1.5")
    return x, y
