"""Modules `random` and `uuid` of a program: seeds and identifiers follow from the run's seed."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Seed the module, where Python would use random bytes of the operating system."""
    if module.__name__ == "uuid":
        module.uuid1 = lambda node=None, clock_seq=None: module.uuid4()  # type: ignore[attr-defined]
        return
    make_seed = module.Random.seed

    def seed(self: object, a: object = None, version: int = 2) -> None:
        make_seed(self, program.random.getrandbits(64) if a is None else a, version)

    module.Random.seed = seed
    module.seed = module._inst.seed  # type: ignore[attr-defined]
    module.seed()
