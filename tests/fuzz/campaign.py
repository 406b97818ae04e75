"""Many inputs of one kind, by several readers at once, for a time or up to a number; the rate is printed."""

from __future__ import annotations

import itertools
import os
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

from reader import Reader

WORKERS = int(os.environ.get("SIMKIT_FUZZ_WORKERS", "0")) or min(os.cpu_count() or 1, 4)
MOST = int(os.environ.get("SIMKIT_FUZZ_INPUTS", "1000000"))  # inputs of a kind; the time ends it, too
SHOWN = 20  # finds in the message of a failed test


def several_readers(resources: list[Path] | None = None) -> Iterator[list[Reader]]:
    """Yield a reader for each processor, for a fixture; print their reports at the end."""
    with ExitStack() as stack:
        made = [stack.enter_context(Reader(resources)) for _ in range(WORKERS)]
        yield made
        for reader in made:
            print(f"\n{reader.report()}")  # noqa: T201 -- read with -s


def try_many(
    kind: str,
    one: Callable[[Reader, int], str],
    readers: Sequence[Reader],
    seconds: float = float("inf"),
    most: int = MOST,
) -> None:
    """Try inputs until the time or their number ends; print each find at once, and the rate at the end.

    Args:
        kind: name of the inputs in the output.
        one: tries the input of a number with a reader, and returns what is wrong; empty if nothing is.
        readers: each of them is used by a thread of its own.
        seconds: wall time after which no input begins.
        most: number of inputs after which none begins.
    """
    began, numbers, tried = time.monotonic(), itertools.count(), [0] * len(readers)
    found: list[str] = []
    raised: list[BaseException] = []

    def work(place: int) -> None:
        try:
            while time.monotonic() < began + seconds and not raised and (index := next(numbers)) < most:
                if text := one(readers[place], index):
                    found.append(text)
                    print(f"\n{kind} {index}: {text}", flush=True)  # noqa: T201 -- read with -s
                tried[place] += 1
        except BaseException as error:  # noqa: BLE001 -- raised again by the test
            raised.append(error)

    threads = [threading.Thread(target=work, args=(place,)) for place in range(len(readers))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    took, count = time.monotonic() - began, sum(tried)
    rate = f"{count} inputs in {took:.0f} s, {count / took:.0f} a second"
    print(f"\n{kind}: {rate}, {len(found)} finds", flush=True)  # noqa: T201 -- read with -s
    if raised:
        raise raised[0]
    assert not found, f"{len(found)} of {count}\n" + "\n".join(found[:SHOWN])
