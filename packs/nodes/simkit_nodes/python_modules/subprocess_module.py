"""Module `subprocess` of a program: it starts real processes, which is told because they follow wall time."""

from __future__ import annotations

import subprocess as _python
from typing import Any

from simkit_nodes.tasks import current_task

__all__ = ["Popen", "call", "check_call", "check_output", "getoutput", "getstatusoutput", "run"]


def _tell() -> None:
    task = current_task()
    if task is not None:
        task.program.tell("SK-NODE-052")


class Popen(_python.Popen[Any]):
    """Real process."""

    def __init__(self, *args: Any, **options: Any) -> None:
        _tell()
        super().__init__(*args, **options)


def _telling(name: str) -> Any:
    function = getattr(_python, name)

    def start(*args: object, **options: object) -> Any:
        _tell()
        return function(*args, **options)

    start.__name__, start.__doc__ = name, function.__doc__
    return start


run = _telling("run")
call = _telling("call")
check_call = _telling("check_call")
check_output = _telling("check_output")
getoutput = _telling("getoutput")
getstatusoutput = _telling("getstatusoutput")
