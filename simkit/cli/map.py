"""Command `simkit map`: write the true occupancy map of a world."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit.cli.run_options import load_options
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import (
    print_diagnostics,
    print_json,
    print_line,
    print_note,
    report_errors_quietly,
)
from simkit.errors import InputError
from simkit.writers.atomic_output import check_writable, write_atomically

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.sensors.occupancy_map import OccupancyMap

_SUFFIXES = (".pgm", ".yaml")


@report_errors_quietly
def map(
    world: Annotated[str, argument("World or model.", "WORLD", completion.worlds)],
    output: Annotated[Path, option("Map to write: OUT.pgm and OUT.yaml.", "OUT", "--output", "-o")] = Path("map"),
    height: Annotated[float, option("Height of the slice [m].", "Z")] = 0.2,
    resolution: Annotated[float, option("Side of a cell [m].", "R", min=1e-4, max=1e3)] = 0.05,
    start: Annotated[
        str | None, option("Free place; what cannot be reached from it is unknown (default: the robot).", "X,Y")
    ] = None,
    everywhere: Annotated[bool, Option("--everywhere", help="Make every cell free that is not occupied.")] = False,
    set_: options.Overrides = [],
    spawn: options.Spawns = [],
    resource_path: options.ResourcePaths = [],
    package_path: options.PackagePaths = [],
    plugin_path: options.PluginPaths = [],
    xacro_arg: options.XacroArgs = [],
    base: options.Base = "auto",
    json_: options.Json = False,
) -> None:
    """Write the true occupancy map of a world as PGM and YAML."""
    from simkit.build import load
    from simkit.sensors.occupancy_map import parse_place

    place = None if start is None else parse_place(start)
    if place is not None and everywhere:
        raise InputError("SK-CLI-054 --start and --everywhere exclude each other", "SK-CLI-054")
    stem = output.with_suffix("") if output.suffix.lower() in _SUFFIXES else output
    image, description = (stem.with_name(stem.name + suffix) for suffix in _SUFFIXES)
    for path in (image, description):
        check_writable(path)
    loading = load_options(resource_path, package_path, xacro_arg, base, plugin_path)
    with load(world, overrides=tuple(set_), spawn=tuple(spawn), **loading) as sim:
        print_diagnostics(sim.diagnostics, verbose=False)
        found = _make(sim, height, resolution, place, everywhere=everywhere)
    write_atomically(image, found.image())
    write_atomically(description, found.description(image.name).encode())
    rows, columns = found.cells.shape
    counts = {
        name: int((found.cells == value).sum()) for name, value in (("occupied", 100), ("free", 0), ("unknown", -1))
    }
    if json_:
        print_json({"output": [str(image), str(description)], "rows": rows, "columns": columns, **counts})
    else:
        cells = ", ".join(f"{count} {name}" for name, count in counts.items())
        print_line(f"{image}, {description}: {columns} × {rows} cells of {resolution:g} m at z = {height:g} m; {cells}")


def _make(
    sim: Simulation, height: float, resolution: float, start: tuple[float, float] | None, *, everywhere: bool
) -> OccupancyMap:
    """Return the map; without a start, it begins at the first model that can move and has joints, if that is free."""
    from simkit.sensors.occupancy_map import make_map

    data = sim.engine.physics.fresh()
    if start is None and not everywhere:
        robot = next((model for model in sim.models.values() if not model.static and model.joints), None)
        if robot is not None:
            x, y, _ = robot.pose.position.tolist()
            try:
                return make_map(sim.mj_model, data, height, resolution, (x, y))
            except InputError as error:
                if "the start" not in str(error):
                    raise
                print_note(f"note: {robot.name} is not in a free cell, so every cell is free that is not occupied")
    return make_map(sim.mj_model, data, height, resolution, start)
