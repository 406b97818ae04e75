"""The power of a panel that follows the sun and of one on a stand, through a day: `python solar.py [OUT.png]`.

The robot, its world and its controller are in `examples/solar_tracker`.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import plots

TRACKER = Path(__file__).resolve().parents[1] / "solar_tracker" / "day.py"
LABELS = {"tracker": "follows the sun", "stand": "on a stand, 35° to the south"}


def main(out: Path) -> None:
    spec = importlib.util.spec_from_file_location("day", TRACKER)
    assert spec is not None and spec.loader is not None
    day = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(day)

    figure, (power, angle) = plots.figure("Solar sensor: a day in Prague, 21 June", rows=2, sharex=True)
    for (name, record), colour in zip(day.run().items(), (plots.ORANGE, plots.BLUE), strict=True):
        power.plot(record.hours, record.power, color=colour, label=f"{LABELS[name]}: {record.energy / 1000:.2f} kW·h")
        up = record.power > 0
        angle.plot(record.hours, np.where(up, np.degrees(record.incidence), np.nan), color=colour)
        shaded = record.hours[record.shadow != ""]
        if len(shaded):
            for ax in (power, angle):
                ax.axvspan(shaded[0], shaded[-1], color=plots.TRUTH, alpha=0.12, linewidth=0)
            power.text(shaded.mean(), 238, "chimney's shadow", horizontalalignment="center")
    power.set_ylabel("power [W]")
    power.set_ylim(-10, 320)
    power.legend(loc="upper center", ncol=2)
    angle.set_ylabel("sun to normal [°]")
    angle.set_xlabel("time [h UTC]")
    angle.set_xticks(range(3, 21, 3))
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "solar.png")
