"""Golden runs on disk: reproducible bytes, atomic writes, and validation of all data."""

from __future__ import annotations

import contextlib
import json
import os
import random
import shutil
import signal
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from falling import ball

from simkit.errors import InputError
from simkit.run_spec import Check, RunSpec, Tolerance
from simkit.testing.golden.array_packing import Packer, PackingError, Unpacker
from simkit.testing.golden.record_encoding import decode_scenario, encode_scenario
from simkit.testing.golden.store import find_goldens, read_golden, read_history, write_golden
from simkit.testing.run_record.record import RunRecord
from simkit.testing.run_record.run_recorder import record_run
from simkit.testing.scenarios.code_permission import permit_code


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> RunRecord:
    found = record_run(RunSpec(str(ball(tmp_path_factory.mktemp("ball"))), duration=0.5))
    found.simulation.close()
    return found


def test_a_golden_run_is_read_as_it_was_written(tmp_path: Path, record: RunRecord) -> None:
    write_golden(tmp_path / "g", record)
    golden = read_golden(tmp_path / "g")
    assert golden.leaves == record.leaves and golden.sources == record.sources
    assert golden.states.names == record.states.names and golden.states.digest == record.states.digest
    for name in ("marks", "inputs", "ticks", "values", "input_values"):
        assert np.array_equal(getattr(golden.states, name), getattr(record.states, name), equal_nan=True)
    assert set(golden.streams) == set(record.streams)
    for topic, stream in record.streams.items():
        other = golden.streams[topic]
        assert other.digest == stream.digest and other.chunks == stream.chunks and other.words == stream.words
        assert np.array_equal(other.times_ns, stream.times_ns)
        for path, column in stream.columns.items():
            kept = other.columns[path]
            assert kept.values.dtype == column.values.dtype and kept.values.shape == column.values.shape
            if column.values.dtype.kind != "f":
                assert np.array_equal(kept.values, column.values)
                continue
            finite = np.isfinite(column.values)
            assert np.array_equal(np.isfinite(kept.values), finite)
            slack = 0.5 * kept.step + 1e-6 * np.abs(column.values[finite])  # float32 rounds once more
            assert (np.abs(kept.values[finite] - column.values[finite]) <= slack).all()
    assert all(np.array_equal(golden.fields[name], record.fields[name], equal_nan=True) for name in record.fields)


def test_recording_twice_gives_the_same_bytes(tmp_path: Path, record: RunRecord) -> None:
    again = record_run(record.scenario)
    again.simulation.close()
    again.fingerprint = record.fingerprint
    for name, one in (("a", record), ("b", again)):
        write_golden(tmp_path / name, one)
    first, second = (sorted((tmp_path / name).iterdir()) for name in "ab")
    assert [p.name for p in first] == [p.name for p in second]
    assert [p.read_bytes() for p in first] == [p.read_bytes() for p in second]


def test_a_golden_run_in_another_checkout_finds_its_world(tmp_path: Path, record: RunRecord) -> None:
    (tmp_path / "a" / "worlds").mkdir(parents=True)
    world = shutil.copy(record.scenario.world, tmp_path / "a" / "worlds")
    write_golden(tmp_path / "a" / "golden" / "ball", replace(record, scenario=RunSpec(str(world))))
    shutil.move(tmp_path / "a", tmp_path / "b")
    source = Path(read_golden(tmp_path / "b" / "golden" / "ball").scenario.source)
    assert source.resolve() == tmp_path / "b" / "worlds" / "ball.sdf"


def test_a_scenario_is_decoded_as_it_was_encoded(tmp_path: Path) -> None:
    ball(tmp_path)
    scenario = RunSpec(
        "ball.sdf", 3.0, 4, "falls", ("gravity=0 0 -1",), topics=("/imu",), skip=("/tf*",),
        commands=({"at": 1.0, "topic": "/cmd_vel", "message": {"linear": {"x": 0.5}}, "where": "x.yaml:3"},),
        tolerances=(Tolerance("/imu", absolute=0.1),), checks=(Check("apart", models=("a", "b")),),
        options={"plugin_paths": (tmp_path / "plugins",), "xacro_args": {"a": "1"}}, folder=tmp_path,
    )  # fmt: skip
    plain = encode_scenario(scenario, tmp_path / "golden" / "g")
    back = decode_scenario(json.loads(json.dumps(plain)), tmp_path / "golden" / "g")
    assert back.code_requests and "plugin_paths" not in back.options
    back = permit_code(back, allow_code=True)
    assert encode_scenario(back, tmp_path / "golden" / "g") == plain
    assert plain["world"] == "../../ball.sdf"
    assert back.tolerances == scenario.tolerances and back.checks == scenario.checks
    assert Path(back.options["plugin_paths"][0]).resolve() == tmp_path / "plugins"


def test_old_data_files_and_unfinished_files_are_removed(tmp_path: Path, record: RunRecord) -> None:
    write_golden(tmp_path, record)
    (tmp_path / ".golden-1.tmp").write_bytes(b"half")
    changed = replace(record, leaves={**record.leaves, "gravity": [0, 0, 0]})
    write_golden(tmp_path, changed, reason="on the way to Mars", changed=["gravity"], history=read_history(tmp_path))
    assert len(list(tmp_path.iterdir())) == 2
    assert [one["reason"] for one in read_history(tmp_path)] == ["recorded", "on the way to Mars"]


def _written_but_killed(folder: Path, golden: RunRecord, at: int) -> int:
    """Write in another process, which kills itself at the `at`-th call that opens, renames or removes a file."""
    child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    seen = 0

    def count(event: str, given: tuple[object, ...]) -> None:
        nonlocal seen
        if event in ("open", "os.rename", "os.remove", "os.mkdir") and str(folder) in str(given[0]):
            seen += 1
            if seen == at:
                os.kill(os.getpid(), signal.SIGKILL)

    try:
        sys.addaudithook(count)
        write_golden(folder, golden, reason="again")
        os._exit(0)
    finally:
        os._exit(1)


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="a process cannot be forked here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_killed_write_leaves_the_old_or_the_new_golden_run(tmp_path: Path, record: RunRecord) -> None:
    write_golden(tmp_path, record)
    outcomes = []
    for at in range(1, 20):
        new = replace(record, leaves={**record.leaves, "gravity": [0.0, 0.0, float(at)]})
        code = _written_but_killed(tmp_path, new, at)
        outcomes.append(
            (code, read_golden(tmp_path).leaves["gravity"][2] == at)
        )  # raises an error for an incomplete golden run
        if code == 0:
            break
    killed = [is_new for code, is_new in outcomes if code == -signal.SIGKILL]
    assert len(killed) >= 4
    assert not killed[0]
    assert outcomes[-1] == (0, True)
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda said: said.update(format=2), "SK-GOLDEN-004"),
        (lambda said: said.update(format="x"), "SK-GOLDEN-003"),
        (lambda said: said.update(data={"file": "../../etc/passwd", "sha256": "0"}), "SK-GOLDEN-003"),
        (lambda said: said["data"].update(sha256="0" * 64), "SK-GOLDEN-003"),
        (lambda said: said["scenario"].update(model_world=[0.0] * 5000), "SK-GOLDEN-003"),
        (lambda said: said.update(scenario={"world": 3, "duration": "x"}), "SK-GOLDEN-003"),
        (lambda said: said.pop("fingerprint"), "SK-GOLDEN-003"),
        (lambda said: said.update(sources=[1]), "SK-GOLDEN-003"),
        (lambda said: said.update(diagnostics={"a": "x"}), "SK-GOLDEN-003"),
    ],
)
def test_each_invalid_expression_has_a_code(tmp_path: Path, record: RunRecord, change: object, code: str) -> None:
    write_golden(tmp_path, record)
    said = json.loads((tmp_path / "golden.json").read_text())
    change(said)  # type: ignore[operator]
    (tmp_path / "golden.json").write_text(json.dumps(said))
    with pytest.raises(InputError) as caught:
        read_golden(tmp_path)
    assert caught.value.code == code


@pytest.mark.parametrize("text", ["", "[]", "{", '{"format": 1}', "[" * 100_000, "\xff\xfe", '{"format": 1e999}'])
def test_a_folder_without_a_golden_run_is_an_error(tmp_path: Path, text: str) -> None:
    (tmp_path / "golden.json").write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError, match="SK-GOLDEN-003"):
        read_golden(tmp_path)


def test_changed_data_bytes_cause_an_input_error(record: RunRecord, tmp_path: Path) -> None:
    """Some bytes are changed and the hash is correct, as in a manipulated file."""
    import hashlib
    import lzma

    write_golden(tmp_path, record)
    main = tmp_path / "golden.json"
    said = json.loads(main.read_text())
    whole = bytearray(lzma.decompress((tmp_path / said["data"]["file"]).read_bytes()))
    draw = random.Random(1)
    failed = 0
    for _ in range(150):
        bad = bytearray(whole)
        for _ in range(draw.choice((1, 1, 4))):
            bad[draw.randrange(min(len(bad), draw.choice((64, 4000, len(bad)))))] = draw.randrange(256)
        data = lzma.compress(bytes(bad), preset=0)
        digest = hashlib.sha256(data).hexdigest()
        said["data"] = {"file": f"data-{digest[:12]}.xz", "sha256": digest}
        (tmp_path / said["data"]["file"]).write_bytes(data)
        main.write_text(json.dumps(said))
        with contextlib.suppress(InputError):
            read_golden(tmp_path)
            failed -= 1
        failed += 1
    assert failed > 30


def test_a_block_that_would_unpack_to_too_many_bytes_is_rejected() -> None:
    import lzma

    with pytest.raises(PackingError):
        Unpacker(lzma.compress(b"SKGOLD\x01\n" + b"\xff" * 20))
    packer = Packer()
    packer.add(np.zeros((2, 3)))
    block = lzma.decompress(packer.block({}))
    huge = block.replace(b"[2,3]", b"[999999999,9]")
    huge = huge[:8] + (int.from_bytes(huge[8:12], "little") + len(huge) - len(block)).to_bytes(4, "little") + huge[12:]
    with pytest.raises(PackingError, match="too large"):
        Unpacker(lzma.compress(huge))


@pytest.mark.parametrize(
    "values",
    [
        np.array([], np.float64),
        np.zeros((0, 3), np.float32),
        np.array([np.nan, np.inf, -np.inf, -0.0, 1e300, 5e-324]),
        np.array([2**63 - 1, -(2**63), 0]),
        np.array([2**64 - 1, 0], np.uint64),
        np.random.default_rng(0).integers(0, 256, (50, 4)).astype(np.uint8),
        np.cumsum(np.ones((40, 5, 2)), axis=0),
        np.array([True, False, True]),
    ],
)
def test_arrays_are_unpacked_bit_by_bit(values: np.ndarray) -> None:
    packer = Packer()
    number = packer.add(values)
    back = Unpacker(packer.block(None)).array(number)
    assert back.dtype == values.dtype and back.shape == values.shape and back.tobytes() == values.tobytes()


def test_rounded_numbers_are_within_half_a_step() -> None:
    draw = np.random.default_rng(0)
    values = draw.normal(0, 1, (200, 30)).astype(np.float32)
    values[3, 4], values[5, 6], values[7, 8] = np.nan, np.inf, -np.inf
    packer = Packer()
    number = packer.add(values, 2.0**-10)
    back = Unpacker(packer.block(None)).array(number)
    finite = np.isfinite(values)
    assert np.abs(back[finite] - values[finite]).max() <= 2.0**-11
    assert np.array_equal(back[~finite], values[~finite], equal_nan=True)


def test_goldens_are_found_in_folders(tmp_path: Path, record: RunRecord) -> None:
    for name in ("b", "a/c"):
        write_golden(tmp_path / name, record)
    assert find_goldens(tmp_path) == [tmp_path / "a" / "c", tmp_path / "b"] or find_goldens(tmp_path) == [
        tmp_path / "b", tmp_path / "a" / "c",
    ]  # fmt: skip
    assert find_goldens(tmp_path / "b" / "golden.json") == [tmp_path / "b"]
    with pytest.raises(InputError, match="SK-GOLDEN-002"):
        find_goldens(tmp_path / "none")


@pytest.mark.skipif(os.name == "nt" or getattr(os, "geteuid", lambda: 1)() == 0, reason="everything may be written")
def test_a_folder_that_cannot_be_written_is_an_error(tmp_path: Path, record: RunRecord) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(InputError, match="SK-GOLDEN-005"):
        write_golden(tmp_path / "g", record)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="a process cannot be forked here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize("lock", ["of the folder", "of a file, as on Windows"])
def test_parallel_writers_and_a_reader_see_complete_golden_runs(
    tmp_path: Path, record: RunRecord, lock: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if lock != "of the folder":
        monkeypatch.delattr(os, "O_DIRECTORY", raising=False)
    record = replace(record, fields={}, streams={})  # quickly written
    other = replace(record, end="until")
    write_golden(tmp_path / "g", record)
    children = []
    for number in range(4):
        child = os.fork()
        if child == 0:
            code = 1
            with contextlib.suppress(BaseException):
                for turn in range(8):
                    write_golden(tmp_path / "g", other if (turn + number) % 2 else record, reason=str(number))
                code = 0
            os._exit(code)
        children.append(child)
    for _ in range(20):
        assert read_golden(tmp_path / "g").end in ("duration", "until")
    assert [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in children] == [0, 0, 0, 0]
    assert len(list((tmp_path / "g").iterdir())) == 2


def test_a_long_xml_world_is_stored_with_the_data(tmp_path: Path, record: RunRecord) -> None:
    text = "<sdf>" + "<!-- Größe -->" * 500 + "</sdf>"
    write_golden(tmp_path / "g", replace(record, scenario=RunSpec(text)))
    assert (tmp_path / "g" / "golden.json").stat().st_size < 3000
    assert read_golden(tmp_path / "g").scenario.world == text
