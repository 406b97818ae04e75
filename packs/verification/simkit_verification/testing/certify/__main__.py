"""Child process for one run of a certificate: `python -m simkit_verification.testing.certify REQUEST RESULT`."""

from __future__ import annotations

import faulthandler
import sys
import traceback
from pathlib import Path

from simkit.child_process import exit_immediately, exit_with_parent
from simkit.errors import InputError
from simkit.memory_error import find_memory_error
from simkit_verification.testing.certify.child_run import ChildRequest, run_child
from simkit_verification.testing.certify.outcome import STACK_FILE, RunOutcome, read_pickle, write_pickle


def main(request: str, result: str) -> None:
    """Read the request, run it, write the result, and exit at once, even if plugins have running threads.

    If the run times out or is stopped, the stack trace of the process is written to a file beside the result.
    """
    exit_with_parent()
    child_request = read_pickle(Path(request), ChildRequest)
    with open(Path(result).with_name(STACK_FILE), "w", encoding="utf-8") as stack:
        faulthandler.enable(stack)
        if child_request.limit is not None:
            faulthandler.dump_traceback_later(child_request.limit, exit=True, file=stack)
        try:
            write_pickle(Path(result), run_child(child_request))
        except BaseException as ended:  # includes SystemExit, which a plugin may raise
            frames = reversed(traceback.extract_tb(ended.__traceback__))
            stack.writelines(f'  File "{f.filename}", line {f.lineno} in {f.name}\n' for f in frames)
            out_of_memory = find_memory_error(ended)
            if out_of_memory is None:
                raise
            failure = InputError(out_of_memory.code, str(out_of_memory), shows_code=False)
            write_pickle(Path(result), RunOutcome(failure=failure))
        faulthandler.cancel_dump_traceback_later()
        faulthandler.disable()
    exit_immediately(0)


if __name__ == "__main__":
    main(*sys.argv[1:])
