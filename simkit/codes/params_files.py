"""Parameter files that a run is given."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.control import _YAML, _urdf
from simkit.codes.sketch import python

CODES: tuple[Code, ...] = (
    Code(
        "SK-CONTROL-060",
        "warning",
        "a parameter file that a run is given has nobody who reads it",
        "the closest model is named; a robot needs a control plugin",
        python(
            "import simkit\n\nsim = simkit.load('arm.urdf', params_files=['amr=arm.yaml'])\n",
            {"arm.urdf": _urdf("", ""), "arm.yaml": _YAML},
        ),
    ),
)
