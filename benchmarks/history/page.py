"""Page `docs/speed.md` with its plot, from the entries and the figures of others in `figures.toml`."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cases import CASES

FOLDER = Path(__file__).resolve().parent
DOCS = FOLDER.parents[1] / "docs"
Entry = Mapping[str, Any]

_HEAD = """## Against MuJoCo alone

Both take turns in one process, on the same compiled model. A ratio of 1 is the speed of MuJoCo; less is faster. The
rest of a ratio above 1 is what a simulator adds: plugins, sensors with their noise, and messages.

The robot of the first rows is a TurtleBot3 waffle in `turtlebot3_world`, with steps of 1 ms. "Main job" is its drive of
36 s; recorded, it writes nine topics to a bag. [Other benchmarks](../benchmarks/README.md) measure parts, and
[entries](../benchmarks/history/entries) name their commit, processor and versions:

    python benchmarks/history measure          # measures the last commit and adds an entry
    python benchmarks/history measure COMMIT   # an older one
    python benchmarks/history check            # exit 1 if a ratio grew by 8 % from the commit before
    python benchmarks/history check BEFORE AFTER --case main_job
    python benchmarks/history page             # writes this page
"""


def read_entries() -> list[Entry]:
    """Return all entries, the oldest commit first."""
    found = [json.loads(file.read_text(encoding="utf-8")) for file in sorted((FOLDER / "entries").glob("*.json"))]
    return sorted(found, key=lambda entry: str(entry["date"]))


def write_page() -> None:
    """Write the page and its plot."""
    entries = read_entries()
    draw(entries, DOCS / "images" / "speed.svg")
    (DOCS / "speed.md").write_text(page_text(entries), encoding="utf-8")


def page_text(entries: Sequence[Entry]) -> str:
    """Return the text of the page."""
    figures = tomllib.loads((FOLDER / "figures.toml").read_text(encoding="utf-8"))
    costs = (FOLDER / "costs.md").read_text(encoding="utf-8")
    return "\n".join(("# Speed\n", costs, _HEAD, last_entry(entries), history(), peers(figures), memory(figures)))


def amount(name: str, value: float) -> str:
    """Return a time or a size in readable units."""
    if CASES[name].clock is None:
        return f"{value / 1e6:.0f} MB"
    value /= CASES[name].units
    units = ("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)
    unit, scale = next((row for row in units if value >= row[1]), units[-1])
    return f"{value / scale:.3g} {unit}"


def machine(entry: Entry) -> str:
    """Return the machine of an entry in words."""
    here = entry["machine"]
    return (
        f"{here['processor']}, {here['cores']} cores, Python {here['python']}, MuJoCo {here['mujoco']}, "
        f"NumPy {here['numpy']}"
    )


def last_entry(entries: Sequence[Entry]) -> str:
    """Return the table of the newest entry."""
    entry = entries[-1]
    lines = [
        "## Last entry\n",
        f"Commit `{entry['commit'][:10]}` of {entry['date'][:10]}, {machine(entry)}. Times are of a step unless the",
        "row names something else; one row alone: `python benchmarks/history measure --case NAME`.\n",
        "| name | work of simkit | work of MuJoCo | time of simkit | ratio |",
        "|---|---|---|---|---|",
    ]
    for name, case in CASES.items():
        if found := entry["ratios"].get(name):
            time = amount(name, found["ours"])
            lines.append(f"| `{name}` | {case.title} | {case.beside} | {time} | {found['ratio']:.2f} |")
    return "\n".join(lines) + "\n"


def history() -> str:
    """Return the plot of all entries."""
    lines = [
        "## By version\n",
        "![Ratio to MuJoCo alone of each measurement, over the commits](images/speed.svg)\n",
        "Two entries of one commit differ by up to 10 %; the check of two commits alternates, and is more exact.",
    ]
    return "\n".join(lines) + "\n"


def peers(figures: Mapping[str, Any]) -> str:
    """Return the table of other simulators."""
    lines = [
        "## Beside other simulators\n",
        'Published figures are of the machines of their authors; the column "source" says so. Measured figures are of',
        "one machine with two shared cores, both sides in turn.\n",
        "| work | simulator | its figure | figure of simkit | source | command |\n|---|---|---|---|---|---|",
    ]
    for row in figures["peer"]:
        command = f"`{row['command']}`" if "command" in row else ""
        cells = (row["what"], row["simulator"], row["figure"], row.get("simkit", ""), row["source"], command)
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def memory(figures: Mapping[str, Any]) -> str:
    """Return the table of memory and sizes."""
    lines = ["## Memory and size\n", "| world or file | figure | command |\n|---|---|---|"]
    lines += [f"| {row['what']} | {row['figure']} | `{row['command']}` |" for row in figures["memory"]]
    return "\n".join([*lines, "", figures["memory_notes"].strip()]) + "\n"


_PANELS = {
    "steps": ("compiled_model", "step", "plugin", "imu_later"),
    "messages": ("imu_messages", "all_sensors", "fleet"),
    "main job": ("main_job", "main_job_bag"),
    "scans and pictures": ("scan", "dense_scan", "rgbd"),
    "learning": ("learning_step", "learning_reset"),
    "loading and memory": ("loading", "command", "memory"),
}
_STYLES = "-", "--", ":"


def draw(entries: Sequence[Entry], file: Path) -> None:
    """Draw the ratios over the entries: a colour for each case, a style of line for each machine."""
    import matplotlib as mpl

    mpl.use("Agg")
    mpl.rcParams.update({"svg.hashsalt": "speed", "svg.fonttype": "none", "font.size": 8})
    from matplotlib import pyplot as plt

    machines = list(dict.fromkeys(machine(entry) for entry in entries))
    figure, grid = plt.subplots(2, 3, figsize=(10, 5.5), sharex=True)
    for axes, (title, names) in zip(grid.flat, _PANELS.items(), strict=True):
        for colour, name in enumerate(names):
            for number, of_one in enumerate(machines):
                drawn = [
                    (place, entry["ratios"][name]["ratio"])
                    for place, entry in enumerate(entries)
                    if name in entry["ratios"] and machine(entry) == of_one
                ]
                style = {"color": f"C{colour}", "ls": _STYLES[number % len(_STYLES)], "marker": "o", "ms": 3, "lw": 1}
                axes.plot([x for x, _ in drawn], [y for _, y in drawn], label=name if number == 0 else None, **style)
        axes.axhline(1.0, color="k", lw=0.5)
        axes.set_ylim(bottom=0)
        axes.set_title(title)
        axes.legend(fontsize=7)
    for axes in grid[-1]:
        axes.set_xticks(range(len(entries)), [entry["commit"][:7] for entry in entries], rotation=45)
    figure.tight_layout()
    figure.savefig(file, metadata={"Date": None})
    plt.close(figure)
