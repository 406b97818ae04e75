"""A sweep on a Ray cluster of two nodes: the same table as on one machine, also if a node dies."""

from __future__ import annotations

import logging
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from sweep_worlds import BOX

from simkit import RunSpec
from simkit_learning.sweeps.design import Design
from simkit_learning.sweeps.metrics import FileMetric
from simkit_learning.sweeps.parameter_space import parameter_space
from simkit_learning.sweeps.result_store import ResultStore
from simkit_learning.sweeps.result_table import read_table
from simkit_learning.sweeps.sweep import run_sweep
from simkit_learning.sweeps.sweep_spec import SweepSpec

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]


def test_two_nodes_give_the_table_of_one_machine_and_one_node_may_die(tmp_path: Path) -> None:
    ray: Any = pytest.importorskip("ray", reason="pip install 'simkit-robotics[cluster]'")
    from ray.cluster_utils import Cluster

    (tmp_path / "box.sdf").write_text(BOX, encoding="utf-8")
    (tmp_path / "cost.py").write_text("def cost(sim):\n    return sim.seed / 7\n", encoding="utf-8")
    spaces = (parameter_space("box::l.inertial.mass", {"uniform": [-0.1, 2]}),)
    metrics = {"z": "pose('box').z", "cost": FileMetric("cost.py:cost", tmp_path)}
    spec = SweepSpec(RunSpec("box.sdf", duration=0.5, folder=tmp_path), Design(spaces, range(400)), metrics, keep=2)
    run_sweep(spec, tmp_path / "one", jobs=2)
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1})
    try:
        second = cluster.add_node(num_cpus=1)
        store = ResultStore(tmp_path / "two")

        def kill_second() -> None:
            while not any((tmp_path / "two" / "rows").glob("0*")):
                time.sleep(0.05)
            cluster.remove_node(second, allow_graceful=False)

        killer = threading.Thread(target=kill_second)
        killer.start()
        run_sweep(spec, tmp_path / "two", cluster=cluster.address)
        killer.join()
        store.open()
        assert store.finished_count() == 400
    finally:
        ray.shutdown()
        cluster.shutdown()
        logging.shutdown()
    assert read_table(tmp_path / "one").equals(read_table(tmp_path / "two"))
    assert len(list((tmp_path / "two" / "runs").glob("*.zip"))) == 2
