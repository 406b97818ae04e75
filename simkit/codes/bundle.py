"""Bundles: runs in one file."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import python

_RUN = """
import json, zipfile
import simkit
from simkit.bundle import keep, replay, write_bundle

WORLD = '<sdf version="1.9"><world name="w"><model name="m"><link name="l"/></model></world></sdf>'
with simkit.load(WORLD) as sim, keep(sim):
    sim.run(0.1)
    write_bundle(sim, "run.zip")
with zipfile.ZipFile("run.zip") as archive:
    files = {name: archive.read(name) for name in archive.namelist()}
page = json.loads(files["bundle.json"])
"""
_WRITE = """
files["bundle.json"] = json.dumps(page).encode()
with zipfile.ZipFile("run.zip", "w", zipfile.ZIP_DEFLATED) as archive:
    for name, data in files.items():
        archive.writestr(name, data)
try:
    replay("run.zip")
except simkit.InputError as error:
    print(error)
"""


def _of(change: str) -> Example:
    """A bundle that was changed."""
    return python(_RUN + change + _WRITE)


_EDITED = """
import simkit
from pathlib import Path
from simkit.bundle import keep, write_bundle

world = Path("world.sdf")
world.write_text('<sdf version="1.9"><world name="w"><model name="m"><link name="l"/></model></world></sdf>')
with simkit.load(world) as sim, keep(sim):
    sim.run(0.1)
    world.unlink()
    try:
        write_bundle(sim, "run.zip")
    except simkit.InputError as error:
        print(error)
"""
_LATE = """
import simkit
from simkit.bundle import keep

with simkit.load('<sdf version="1.9"><world name="w"><model name="m"><link name="l"/></model></world></sdf>') as sim:
    sim.run(0.1)
    try:
        keep(sim)
    except simkit.InputError as error:
        print(error)
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-BUNDLE-001",
        "error",
        "a file is no bundle, breaks off, or is not what its first page says of it",
        "fetch it once more; a bundle is not to be edited by hand",
        _of('files["commands.jsonl"] = b"edited"'),
    ),
    Code(
        "SK-BUNDLE-002",
        "error",
        "a later simkit made the bundle",
        "open it with that one: `simkit replay --list` of a newer simkit says which it was",
        _of('page["format"] = 99'),
    ),
    Code(
        "SK-BUNDLE-003",
        "error",
        "a file in a bundle has a name that is refused: it leaves its folder, is a link, or is there twice",
        "simkit makes no such bundle; do not trust it",
        _of('files["world/../../escape.sdf"] = b""'),
    ),
    Code(
        "SK-BUNDLE-004",
        "error",
        "a bundle would become larger than one may be",
        "simkit makes no such bundle; do not trust it",
        _of('files["world/zeros"] = bytes(200 << 20)'),
    ),
    Code(
        "SK-BUNDLE-005",
        "error",
        "a bundle brings code of plugins, which does not run unasked",
        "read it (`simkit replay --extract DIR`), then allow it with `--allow-code`",
        _of('files["code/0/drive.py"] = b""\npage["code"] = ["code/0/drive.py"]\n'
            'page["files"]["code/0/drive.py"] = {"size": 0, "sha256": '
            '"e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"}'),
    ),
    Code(
        "SK-BUNDLE-006",
        "error",
        "the world of a run cannot be packed, or a bundle does not hold a model that is to be spawned",
        "leave the files of a run where they are until it is packed",
        python(_EDITED),
    ),
    Code(
        "SK-BUNDLE-007",
        "error",
        "a bundle is wanted of a run that was not kept from its beginning",
        "call `simkit.bundle.keep(sim)` right after `simkit.load`",
        python(_LATE),
    ),
)  # fmt: skip
