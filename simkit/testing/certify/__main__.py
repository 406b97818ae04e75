"""One run of a certificate, in its own process: `python -m simkit.testing.certify REQUEST RESULT`."""

from __future__ import annotations

import faulthandler
import sys
import traceback
from pathlib import Path

from simkit.child_process import exit_immediately, exit_with_parent
from simkit.testing.certify.child_run import ChildRequest, run_child
from simkit.testing.certify.outcome import STACK_FILE, read_pickle, write_pickle


def main(request: str, result: str) -> None:
    """Reads the request, runs it, writes the result, and ends at once, whatever threads plugins began.

    Where it stood when its time was over, or when it was ended by something else, is left in a file beside the result.
    """
    exit_with_parent()
    asked: ChildRequest = read_pickle(Path(request))
    with open(Path(result).with_name(STACK_FILE), "w", encoding="utf-8") as stack:
        faulthandler.enable(stack)
        if asked.limit is not None:
            faulthandler.dump_traceback_later(asked.limit, exit=True, file=stack)
        try:
            write_pickle(Path(result), run_child(asked))
        except BaseException as ended:  # what a plugin ends programs with
            frames = reversed(traceback.extract_tb(ended.__traceback__))
            stack.writelines(f'  File "{f.filename}", line {f.lineno} in {f.name}\n' for f in frames)
            raise
        faulthandler.cancel_dump_traceback_later()
        faulthandler.disable()
    exit_immediately(0)


if __name__ == "__main__":
    main(*sys.argv[1:])
