"""Runs with programs have the same bits in two processes with different hash seeds."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
import asyncio, logging, queue, random, threading, time, uuid
from concurrent.futures import ThreadPoolExecutor
import numpy as np
logging.basicConfig(level=logging.INFO, format="%(asctime)s %(threadName)s %(thread)d %(message)s")
items = queue.Queue()
def work(number):
    for _ in range(5):
        time.sleep(random.uniform(0.001, 0.01))
        items.put((number, time.time(), threading.get_ident()))
threads = [threading.Thread(target=work, args=(number,)) for number in range(5)]
for thread in threads:
    thread.start()
for _ in range(25):
    print(items.get(), np.random.normal())
with ThreadPoolExecutor(3) as executor:
    print(list(executor.map(lambda x: (time.sleep(0.001 * x), time.time(), uuid.uuid4()), range(6))))
async def main():
    print(await asyncio.gather(*(asyncio.sleep(random.random() / 100, k) for k in range(5))), time.time())
asyncio.run(main())
logging.info("end %s", threading.current_thread())
"""

RUN = """
import sys, simkit
with simkit.load(sys.argv[1], seed=3) as sim:
    nodes = [sim.add_node(file) for file in sys.argv[2:]]
    sim.run(1.0)
for node in nodes:
    assert node.done and node.error is None, node.log
"""


@pytest.mark.slow
def test_another_process_with_another_hash_seed_prints_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    world = tmp_path / "empty.sdf"
    world.write_text('<sdf version="1.9"><world name="w"/></sdf>')
    files = [tmp_path / f"{name}.py" for name in "ab"]
    for file in files:
        file.write_text(PROGRAM)
    arguments = ["-c", str(world), *map(str, files)]
    monkeypatch.setattr(sys, "argv", arguments)
    exec(RUN, {})
    here = capsys.readouterr()
    seed = "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"
    command = [sys.executable, "-c", RUN, *arguments[1:]]
    environment = {**os.environ, "PYTHONHASHSEED": seed}
    run = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert (run.stdout, run.stderr) == (here.out, here.err)
    assert run.stdout.count("\n") == 54 and "end <_MainThread" in run.stderr
