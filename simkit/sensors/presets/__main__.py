"""Command `python -m simkit.sensors.presets [NAME]`: print one preset, or write the page of all."""

from __future__ import annotations

import sys

from simkit.diagnostics import did_you_mean
from simkit.sensors.presets import find, presets
from simkit.sensors.presets.preset_page import describe_preset, presets_page


def main(name: str | None) -> int:
    """Print the presets; return 2 if there is no preset of that name."""
    if name is None:
        sys.stdout.write(presets_page())
        return 0
    presets_of_name = find(name)
    if not presets_of_name:
        sys.stderr.write(f"there is no preset {name!r}; {did_you_mean(name, [p.name for p in presets()])}\n")
        return 2
    sys.stdout.write("\n\n".join(map(describe_preset, presets_of_name.values())) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else None))
