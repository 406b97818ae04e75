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

_HEAD = """# Speed

How fast simkit is, version by version, as the ratio to MuJoCo alone on the same compiled model. Both take turns in one
process. A ratio of 1 is the speed of MuJoCo; less is faster. `python benchmarks/history page` writes this page.

    python benchmarks/history measure          # measures the last commit and adds an entry
    python benchmarks/history measure COMMIT   # an older one
    python benchmarks/history check            # exit 1 if a ratio grew by 8 % from the commit before
    python benchmarks/history check BEFORE AFTER --case main_job

Each entry in [benchmarks/history/entries](../benchmarks/history/entries) names its commit, processor and versions. The
robot of the first rows is a TurtleBot3 waffle in `turtlebot3_world`, with steps of 1 ms. [The other
benchmarks](../benchmarks/README.md) measure parts in more detail.
"""


def read_entries() -> list[Entry]:
    """Return all entries, the oldest commit first."""
    found = [json.loads(file.read_text(encoding="utf-8")) for file in sorted((FOLDER / "entries").glob("*.json"))]
    return sorted(found, key=lambda entry: str(entry["date"]))


def write_page() -> None:
    """Write the page and its plot."""
    entries = read_entries()
    figures = tomllib.loads((FOLDER / "figures.toml").read_text(encoding="utf-8"))
    draw(entries, DOCS / "images" / "speed.svg")
    sections = (_HEAD, last_entry(entries), history(entries), peers(figures), memory(figures))
    (DOCS / "speed.md").write_text("\n".join(sections), encoding="utf-8")


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
        "| name | simkit | beside | simkit | MuJoCo | ratio |\n|---|---|---|---|---|---|",
    ]
    for name, case in CASES.items():
        if found := entry["ratios"].get(name):
            values = amount(name, found["ours"]), amount(name, found["bare"])
            lines.append(
                f"| `{name}` | {case.title} | {case.beside} | {values[0]} | {values[1]} | {found['ratio']:.2f} |"
            )
    return "\n".join(lines) + "\n"


def history(entries: Sequence[Entry]) -> str:
    """Return the plot and the table of all entries."""
    lines = [
        "## By version\n",
        "![Ratio to MuJoCo alone of each measurement, over the commits](images/speed.svg)\n",
        "Two entries of one commit differ by up to 5 %, on a machine with other programs up to 10 %; the check of two",
        "commits alternates between them and is more exact.\n",
        "| | " + " | ".join(f"`{entry['commit'][:8]}`" for entry in entries) + " |",
        "|---|" + "---|" * len(entries),
        "| date | " + " | ".join(entry["release"] or entry["date"][:10] for entry in entries) + " |",
    ]
    for name in CASES:
        ratios = (entry["ratios"].get(name) for entry in entries)
        lines.append(f"| `{name}` | " + " | ".join(f"{found['ratio']:.2f}" if found else "" for found in ratios) + " |")
    lines.append("\nAn empty cell: the commit has no such function, or not under its present name.")
    return "\n".join(lines) + "\n"


def peers(figures: Mapping[str, Any]) -> str:
    """Return the table of other simulators."""
    lines = [
        "## Beside other simulators\n",
        'Published figures are of the machines of their authors; the column "of whom" says so. Measured figures are of',
        "one machine with two shared cores, both sides in turn.\n",
        "| what | simulator | figure | simkit | of whom | command |\n|---|---|---|---|---|---|",
    ]
    for row in figures["peer"]:
        command = f"`{row['command']}`" if "command" in row else ""
        cells = (row["what"], row["simulator"], row["figure"], row.get("simkit", ""), row["source"], command)
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def memory(figures: Mapping[str, Any]) -> str:
    """Return the table of memory and sizes."""
    lines = ["## Memory and size\n", "| what | figure | command |\n|---|---|---|"]
    lines += [f"| {row['what']} | {row['figure']} | `{row['command']}` |" for row in figures["memory"]]
    return "\n".join([*lines, "", figures["memory_notes"].strip()]) + "\n"


def draw(entries: Sequence[Entry], file: Path) -> None:
    """Draw the ratios over the entries, a panel for each case and a colour for each machine."""
    import matplotlib as mpl

    mpl.use("Agg")
    mpl.rcParams.update({"svg.hashsalt": "speed", "svg.fonttype": "none", "font.size": 8})
    from matplotlib import pyplot as plt

    machines = list(dict.fromkeys(machine(entry) for entry in entries))
    columns = 4
    figure, grid = plt.subplots(-(-len(CASES) // columns), columns, figsize=(10, 9), sharex=True)
    for axes, name in zip(grid.flat, CASES, strict=False):
        for colour, of_one in enumerate(machines):
            drawn = [
                (place, entry["ratios"][name]["ratio"])
                for place, entry in enumerate(entries)
                if name in entry["ratios"] and machine(entry) == of_one
            ]
            axes.plot(*zip(*drawn, strict=True) if drawn else ([], []), "o-", color=f"C{colour}", ms=3, lw=1)
        axes.axhline(1.0, color="k", lw=0.6, ls=":")
        axes.set_ylim(bottom=0)
        axes.set_title(name)
        axes.grid(alpha=0.3)
        axes.set_xticks(range(len(entries)), [entry["commit"][:7] for entry in entries], rotation=60)
    for axes in grid.flat[len(CASES) :]:
        axes.set_axis_off()
    figure.tight_layout()
    figure.savefig(file, metadata={"Date": None})
    plt.close(figure)
