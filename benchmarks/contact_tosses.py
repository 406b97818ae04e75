"""Cases of `contact.py` from recorded tosses of a cube, which are read from a folder.

The recordings of ContactNets (Pfrommer, Halm and Posa 2020; github.com/DAIRLab/contact-nets, folder `data`) are 570
tosses at 148 Hz: `params_processed/experiment.json` and one file of PyTorch for each toss, with a row for each sample.
A row has position, quaternion (w, x, y, z), velocity and angular velocity (in the cube's axes); lengths are in units of
half the cube's width. Each toss starts from its first sample and is then predicted without correction.
"""

from __future__ import annotations

import json
import pickle
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from contact_record import Floats, Record, matrices
from contact_scene import Body, Case, Found, Quantity, Shape, Table

from simkit.linear_algebra import matmul
from simkit.pose import rpy_from_quat

HALF_WIDTH = 0.0524  # of the cube [m]
EVERY = 4  # toss that is run
QUICK_EVERY = 40
TYPES = {"DoubleStorage": np.float64, "FloatStorage": np.float32}


class _Storage:
    """A class of PyTorch's that a file names; only its name counts."""

    def __init__(self, name: str) -> None:
        self.name = name


class _Reader(pickle.Unpickler):
    """Reads a tensor from a file of PyTorch's format of before 1.6, without PyTorch and without any other class."""

    def __init__(self, file: BinaryIO) -> None:
        super().__init__(file)
        self.storages: dict[str, tuple[str, int]] = {}

    def find_class(self, module: str, name: str) -> Any:
        if module == "torch._utils" and name.startswith("_rebuild_tensor"):
            return lambda key, offset, size, stride, *_: (key, offset, size, stride)
        if module == "torch" and name in TYPES:
            return _Storage(name)
        if (module, name) == ("collections", "OrderedDict"):
            return dict
        raise pickle.UnpicklingError(f"{module}.{name} is not expected in a tensor")

    def persistent_load(self, pid: Any) -> str:
        _, storage, key, _, count, *_ = pid
        self.storages[key] = storage.name, count
        return str(key)


def read_tensor(path: Path) -> Floats:
    """Return the tensor of a file of PyTorch's format of before 1.6, a row for each of its last dimension.

    Raises:
        pickle.UnpicklingError: the file has something else than one tensor of floating-point numbers.
    """
    with path.open("rb") as file:
        for _ in range(3):  # magic number, version, sizes of the machine
            _Reader(file).load()
        reader = _Reader(file)
        key, offset, size, stride = reader.load()
        if _Reader(file).load() != [key]:
            raise pickle.UnpicklingError(f"{path}: several storages")
        kind = np.dtype(TYPES[reader.storages[key][0]])
        count = int.from_bytes(file.read(8), "little")
        values = np.frombuffer(file.read(count * kind.itemsize), kind)
    strides = [kind.itemsize * step for step in stride]
    view = np.lib.stride_tricks.as_strided(values[offset:], size, strides)
    return np.array(view, dtype=np.float64).reshape(-1, size[-1])


@dataclass(frozen=True)
class Prediction:
    """The measure of a predicted toss: mean distance from the recorded one.

    Attributes:
        samples: recorded rows, shape (t + 1, 19).
    """

    samples: Floats

    def __call__(self, r: Record) -> Found:
        position = HALF_WIDTH * self.samples[:, :3]
        distance = np.linalg.norm(r.positions[:, 0] - position, axis=1)
        turns = matrices(self.samples[:, 3:7] / np.linalg.norm(self.samples[:, 3:7], axis=1)[:, None])
        traces = np.einsum("tij,tij->t", turns, r.rotations[:, 0])
        angles = np.degrees(np.arccos(np.clip((traces - 1) / 2, -1, 1)))
        return {"position": 100.0 * float(distance.mean()) / (2 * HALF_WIDTH), "rotation": float(angles.mean())}


def toss(name: str, samples: Floats, settings: Mapping[str, float], bounce: float | None, step: float) -> Case:
    """A recorded toss; the step is the divisor of the sampling period next to `step`."""
    period = settings["dt"]
    stride = max(1, round(period / step))
    first = samples[0]
    turn = first[3:7] / np.linalg.norm(first[3:7])
    cube = Body(
        "cube",
        Shape("box", (HALF_WIDTH,) * 3),
        settings["mass"],
        tuple((HALF_WIDTH * first[:3]).tolist()),
        tuple(rpy_from_quat(turn).tolist()),
        settings["mu"],
        tuple((HALF_WIDTH * first[7:10]).tolist()),
        tuple(matmul(matrices(turn), first[10:13]).tolist()),
        (settings["inertia"] / settings["mass"] * HALF_WIDTH**2,) * 3,
    )
    return Case(
        name,
        "e = 0, the default" if bounce is None else f"e = {bounce:g}",
        Prediction(samples),
        (cube,),
        timestep=period / stride,
        settle=0.0,
        duration=period * (len(samples) - 1),
        gravity=settings["g"] * HALF_WIDTH,
        restitution=bounce,
        stride=stride,
    )


def _tosses(folder: Path, step: float, quick: bool) -> Iterator[Case]:
    settings = json.loads((folder / "params_processed" / "experiment.json").read_text(encoding="utf-8"))
    files = sorted((folder / "tosses_processed").glob("*.pt"), key=lambda path: int(path.stem))
    for path in files[:: QUICK_EVERY if quick else EVERY]:
        for bounce in (None, settings["restitution"]):
            name = f"toss_{path.stem}" + ("" if bounce is None else f"_e{bounce:g}")
            yield toss(name, read_tensor(path), settings, bounce, step)


def tosses(folder: Path | None) -> Table:
    """The table of the tosses in a folder; it has no cases where there is none."""
    return Table(
        "tosses",
        "Real tosses of a cube",
        "A cube of 105 mm with μ 0.18 was tossed and recorded at 148 Hz (ContactNets: Pfrommer, Halm and Posa "
        "2020). Every fourth of 570 tosses is predicted from its first sample. Mean error of the position [% "
        "of the cube's width] and of the rotation [°] over all samples.",
        {"position": Quantity("position", "%", mean=True), "rotation": Quantity("rotation", "°", mean=True)},
        partial(_tosses, folder) if folder else lambda step, quick: iter(()),
        steps=(0.00097, 0.00068, 0.00017),
        quick_steps=(0.00097,),
        by_step=True,
    )
