"""Module `numpy` of a program, with names of NumPy 1 that NumPy 2 has left out.

ROS 2 Humble and Jazzy have NumPy 1.21 and 1.26, for which most nodes are written.
"""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram

_NAMES: Final[dict[str, Any]] = {
    "Inf": np.inf,
    "Infinity": np.inf,
    "infty": np.inf,
    "PINF": np.inf,
    "NINF": -np.inf,
    "NaN": np.nan,
    "PZERO": 0.0,
    "NZERO": -0.0,
    "alltrue": np.all,
    "asfarray": lambda a, dtype=np.float64: np.asarray(a, dtype),
    "cfloat": np.complex128,
    "complex_": np.complex128,
    "cumproduct": np.cumprod,
    "float_": np.float64,
    "in1d": lambda ar1, ar2, **options: np.isin(ar1, ar2, **options).ravel(),
    "longcomplex": np.clongdouble,
    "longfloat": np.longdouble,
    "mat": np.asmatrix,
    "msort": lambda a: np.sort(a, axis=0),
    "product": np.prod,
    "round_": np.round,
    "row_stack": np.vstack,
    "singlecomplex": np.complex64,
    "sometrue": np.any,
    "string_": np.bytes_,
    "trapz": np.trapezoid,
    "unicode_": np.str_,
}


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Add the names that the installed NumPy does not have, and give the program its own random numbers."""
    program.process.note_import()
    for name, value in _NAMES.items():
        if name not in vars(module):
            setattr(module, name, value)
