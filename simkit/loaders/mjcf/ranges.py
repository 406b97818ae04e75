"""Length ranges of muscles, measured in a process of its own.

MuJoCo finds the shortest and longest length of a muscle by pulling the model until it rests. Where the model flies
apart instead, that never ends and nothing can stop it, so it is done where it can be given up.
"""

from __future__ import annotations

import base64
import json
import subprocess
import sys
from typing import Final

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.mjcf.bundle import Bundle

PATIENCE: Final = 30.0
"""[s] of wall time."""

Ranges = dict[str, tuple[float, float]]

_WORK: Final = """
import base64, json, sys
import mujoco
mujoco.set_mju_user_warning(lambda text: None)
given = json.load(sys.stdin)
models, assets = ({k: base64.b64decode(v) for k, v in given[kind].items()} for kind in ("models", "assets"))
try:
    model = mujoco.MjSpec.from_string(given["text"], include=models, assets=assets).compile()
except Exception as problem:
    json.dump({"problem": str(problem)}, sys.stdout)
else:
    json.dump({"ranges": model.actuator_lengthrange.tolist()}, sys.stdout)
"""


def measured_ranges(bundle: Bundle, names: list[str], where: Where, diagnostics: Diagnostics) -> Ranges | None:
    """The length ranges of a file's actuators by name; None, with an error recorded, where they cannot be found.

    A file that does not compile for another reason has none, and says why when it is compiled here.
    """
    files = {"models": bundle.models, "assets": bundle.assets}
    texts = {kind: {k: base64.b64encode(v).decode() for k, v in held.items()} for kind, held in files.items()}
    given = json.dumps({"text": bundle.text, **texts})
    try:
        done = subprocess.run(
            [sys.executable, "-I", "-c", _WORK],
            input=given.encode(),
            capture_output=True,
            timeout=PATIENCE,
            check=False,
        )
        found = json.loads(done.stdout) if done.returncode == 0 else {}
    except (subprocess.TimeoutExpired, OSError, ValueError):
        found = {}
    if "ranges" in found:
        return {name: (low, high) for name, (low, high) in zip(names, found["ranges"], strict=False)}
    why = found.get("problem", f"it did not come to rest within {PATIENCE:g} s")
    diagnostics.error(
        "SK-MJCF-014",
        f"the length ranges of the muscles cannot be found: {' '.join(str(why).split())}",
        where,
        "give each muscle its lengthrange, or its tendon or joint a range and <lengthrange uselimit='true'/>",
    )
    return None
