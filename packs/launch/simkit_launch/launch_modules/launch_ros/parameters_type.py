"""Types of parameters, for annotations."""

from __future__ import annotations

from typing import Any

__all__ = [
    "EvaluatedParameterValue",
    "EvaluatedParameters",
    "ParameterValue",
    "Parameters",
    "ParametersDict",
    "SomeParameterFile",
    "SomeParameterName",
    "SomeParameterValue",
    "SomeParameters",
    "SomeParametersDict",
]

EvaluatedParameterValue = EvaluatedParameters = ParameterValue = Parameters = ParametersDict = Any
SomeParameterFile = SomeParameterName = SomeParameterValue = SomeParameters = SomeParametersDict = Any
