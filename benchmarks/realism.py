"""Real robots beside simulated ones: tables of rows and plots of `docs/realism.md`.

`python benchmarks/realism.py` prints the tables; `--write docs/realism.md` replaces those of the page and draws the
plots again. The runs have a fixed seed, so the numbers are the same on every machine.
"""

from __future__ import annotations

import argparse
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import realism_turtlebot3
from realism_rows import SCREENS, measure, reached_speed, wall_row

HERE = Path(__file__).resolve().parent
DURATION = 30.0
X3_SET, X3_WORLD = "rosmaster_x3", "x3_room"
SIGMAS = {0.45: 1.3, 0.63: 1.9, 0.83: 2.0, 1.12: 2.5, 1.63: 5.7, 2.6: 18.4, 3.6: 39.3}
"""Residuals about the fitted wall of the real camera [mm] by distance [m]: docs/depth_camera_calibration.md."""
SHARES = {0.45: 35.4, 0.63: 61.1, 1.12: 57.0, 3.6: 48.0}
"""Shares of valid pixels of the real camera in front of a wall [%] by distance [m], from the same page."""
CELLS = ((0, 4, 74, 82, 85, 85, 85, 41), (0, 0, 12, 77, 100, 100, 100, 47), (0, 0, 0, 3, 79, 100, 100, 48),
         (0, 0, 0, 0, 41, 100, 100, 48), (0, 0, 0, 0, 13, 73, 71, 31), (0, 0, 0, 0, 0, 0, 0, 0))  # fmt: skip
"""Valid pixels in each cell of the real image at 0.45 m [%], from the same page."""
FRAMES = {1: 0.331, 2: 0.1852, 3: 0.1538, 4: 0.0901, 5: 0.0526, 6: 0.0466, 7: 0.0283, 8: 0.0223, 9: 0.0202, 10: 0.0132,
          11: 0.0132, 12: 0.0061, 13: 0.0091, 14: 0.0051, 15: 0.004, 16: 0.001, 17: 0.004, 18: 0.004, 19: 0.002,
          20: 0.002, 23: 0.001, 24: 0.001, 25: 0.001, 28: 0.001, 32: 0.001, 34: 0.001}  # fmt: skip
"""Shares of the frames from one cloud to the next, from sensor_profiles.yaml."""


COMMANDS = (("linear", "x", 0.1, 0.0957), ("linear", "x", 0.2, 0.1896), ("linear", "x", 0.3, 0.2906),
            ("linear", "x", -0.1, -0.0727), ("linear", "x", -0.2, -0.1776), ("angular", "z", 1.0, 0.685),
            ("angular", "z", -1.0, -0.507))  # fmt: skip
"""Constant commands and the speeds that the odometry of the real robot showed, from real_robot_contract.yaml."""


def value_text(value: Any) -> str:
    """Return a value of a row as it is printed."""
    if isinstance(value, list):
        return " to ".join(map(value_text, value))
    return f"{value:.4g}" if isinstance(value, (int, float, np.floating)) else str(value)


def is_reached(row: dict[str, Any], value: Any) -> bool:
    """Check whether a measured value is the real one within the tolerance of the row."""
    real = row["real"]
    if isinstance(real, str) or isinstance(value, str):
        return bool(real == value)
    low, high = real if isinstance(real, list) else (real, real)
    return bool(low - row["tolerance"] <= value <= high + row["tolerance"])


def x3_values(realism: str | None) -> tuple[dict[str, Any], dict[str, Any], dict[float, dict[str, Any]]]:
    """Return the values of all rows, data for the plots, and what is measured in front of a wall by distance."""
    values, data = measure(X3_WORLD, realism, DURATION)
    walls = {distance: wall_row(realism, distance) for distance in SCREENS}
    good = [walls[d] for d in (0.63, 0.83, 1.12, 1.63)]
    values["scale"] = float(np.mean([wall["scale"] for wall in good]))
    values["sigma_1.63"] = 1e3 * walls[1.63]["sigma"]
    values["floor"] = walls[0.63]["floor"]
    values["blind"] = 100 - walls[0.45]["valid"]
    # the wedge leaves the image where all columns of the upper half have returns
    full = [d for d in SCREENS if walls[d]["grid"][:3].min() > 0.5 * walls[d]["grid"][:3].max()]
    values["least_range"] = min(full)
    return values, data, walls


def x3_table(values: dict[str, dict[str, Any]]) -> Iterator[str]:
    """Yield the lines of the table of the X3."""
    rows = tomllib.loads((HERE / "realism_x3.toml").read_text(encoding="utf-8"))["row"]
    reached = dict.fromkeys(values, 0)
    lines = []
    for row in rows:
        cells = []
        for name, found in values.items():
            is_good = "key" in row and is_reached(row, found[row["key"]])
            reached[name] += is_good
            text = value_text(found[row["key"]]) if "key" in row else "-"
            cells.append(f"**{text}**" if is_good else text)
        published = f"{value_text(row['real'])} | {value_text(row['gazebo'])}"
        if "key" in row and not row.get("is_setting"):
            lines.append(f"| {row['name']} | {published} | {' | '.join(cells)} |")
    counts = ", ".join(f"{count} with {name}" for name, count in reached.items())
    yield f"Of {len(rows)} rows, these are within the tolerance: {counts} (bold). Rows that a file can set, such as"
    yield "rates, sizes and frames, and rows without a measurement are left out.\n"
    yield f"| row | real X3 | Gazebo | {' | '.join(f'simkit, {name}' for name in values)} |"
    yield "|---|---|---|" + "---|" * len(values)
    yield from lines


def command_table() -> Iterator[str]:
    """Yield the lines of the table of commands and the speeds that the odometry shows."""
    yield "| command | real X3 | simkit, ideal | simkit, rosmaster_x3 |"
    yield "|---|---|---|---|"
    for part, axis, command, real in COMMANDS:
        speeds = [reached_speed(X3_WORLD, choice, part, axis, command) for choice in ("ideal", X3_SET)]
        unit = "m/s" if part == "linear" else "rad/s"
        yield f"| {command:g} {unit} | {real:g} | {speeds[0]:.4g} | {speeds[1]:.4g} |"


def replace_part(page: str, name: str, lines: list[str]) -> str:
    """Return a page with other lines between the marks of a part."""
    begin, end = f"<!-- {name}: made by benchmarks/realism.py -->", f"<!-- end of {name} -->"
    text = f"{begin}\n\n" + "\n".join(lines) + f"\n\n{end}"
    return re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _: text, page, count=1, flags=re.DOTALL)


def main(arguments: list[str]) -> None:
    """Measure, then print or write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", type=Path, help="page whose tables and plots are replaced")
    parser.add_argument("--images", type=Path, metavar="DIR", help="only draw the plots, in this folder")
    given = parser.parse_args(arguments)
    page, images = given.write, given.images
    if page is not None and images is None:
        images = page.parent / "images" / "realism"
    ideal = x3_values("ideal")
    real = x3_values(X3_SET)
    if images is not None:
        from realism_plots import draw_x3

        draw_x3(images, real, ideal, SIGMAS, SHARES, CELLS, FRAMES)
    if page is None and images is not None:
        return
    parts = {
        "X3 rows": list(x3_table({"ideal": ideal[0], X3_SET: real[0]})),
        "X3 commands": list(command_table()),
        "TurtleBot3 rows": list(realism_turtlebot3.table()),
    }
    if page is None:
        print("\n\n".join("\n".join(lines) for lines in parts.values()))
        return
    text = page.read_text(encoding="utf-8")
    for name, lines in parts.items():
        text = replace_part(text, name, lines)
    page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
