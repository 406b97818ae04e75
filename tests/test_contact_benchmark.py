"""The benchmark of contact: its references, its page, and the recordings that it reads."""

from __future__ import annotations

import importlib
import math
import pickle
import struct
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "benchmarks"

Import = Callable[[str], Any]


@pytest.fixture(scope="module")
def benchmark() -> Iterator[Import]:
    """A function that imports a module of the benchmark; afterwards its modules are forgotten."""
    before = set(sys.modules)
    sys.path.insert(0, str(FOLDER))
    yield importlib.import_module
    sys.path.remove(str(FOLDER))
    for name in set(sys.modules) - before:
        if name.startswith(("contact", "measure")):
            del sys.modules[name]


def test_a_ball_that_lands_obliquely_rolls_away_at_five_sevenths_of_its_speed(benchmark: Import) -> None:
    hit = benchmark("contact_hits").rigid_hit
    radius = 0.1
    vx, vz, spin = hit((3.0, -3.0, 0.0), (0.0, -radius), 0.4 * radius**2, 0.6)
    assert vx == pytest.approx(3.0 * 5 / 7)
    assert vz == 0.0
    assert radius * spin == pytest.approx(vx)
    assert hit((3.0, -3.0, 0.0), (0.0, -radius), 0.4 * radius**2, 0.2)[0] == pytest.approx(3.0 - 0.2 * 3.0)


def test_the_reference_of_no_hit_gains_energy_or_leaves_the_contact_closing(benchmark: Import) -> None:
    hits, record = benchmark("contact_hits"), benchmark("contact_record")
    cases = list(hits._hits(0.001, False))
    assert len(cases) > 150
    for case in cases:
        body, (vx, vz, w), gyration = case.bodies[0], case.measure.after, case.measure.gyration
        turn = record.matrices(hits.np.array(hits.quaternion(body.rpy)))
        x, z = hits._arm(body.shape, turn)
        energy = vx**2 + vz**2 + gyration * w**2
        assert energy <= hits.SPEED**2 + 1e-9, case.name
        is_flat = "face" in case.row
        closing = vz if is_flat else vz - w * x
        assert closing == pytest.approx((case.restitution or 0.0) * case.measure.closing, abs=1e-9), case.name
        assert z < 0


def test_a_log_that_does_not_slip_leaves_the_edge_where_its_weight_no_longer_holds_it(benchmark: Import) -> None:
    turning = benchmark("contact_turning")
    speed, radius, gravity = 0.2, turning.EDGE_RADIUS, 9.8
    cosine = 4 / 7 * (1 + 3 * speed**2 / (4 * gravity * radius))
    spin = math.sqrt(gravity * cosine / radius)
    found = turning.over_the_edge(speed, 1e3)
    assert found == pytest.approx((radius * spin * cosine, spin), rel=2e-3)


def test_the_disc_starts_in_the_steady_precession_of_a_thin_disc(benchmark: Import) -> None:
    body = benchmark("contact_turning").disc(0.001).bodies[0]
    radius, sine = body.shape.size[0], math.sin(body.rpy[1])
    thin = math.sqrt(4 * 9.8 / (radius * sine)) * sine
    assert math.hypot(*body.angular) == pytest.approx(thin, rel=0.05)


@pytest.mark.parametrize("kind", ["cylinder", "capsule"])
def test_the_torque_of_the_contact_turns_the_angular_momentum_of_a_body_in_steady_precession(
    benchmark: Import, kind: str
) -> None:
    turning = benchmark("contact_turning")
    np, incline, spin = turning.np, 0.4, 50.0
    shape = turning.Shape(kind, (0.05, 0.01))
    speed, (x, _, z) = turning.steady_precession(shape, incline, spin)
    axis, upwards = np.array([math.sin(incline), 0.0, math.cos(incline)]), np.array([0.0, 0.0, 1.0])
    contact, angular = np.array([x, 0.0, z]), spin * axis + speed * upwards
    velocity = -np.cross(angular, contact)  # the contact point rests
    force = speed * np.cross(upwards, velocity) + 9.8 * upwards
    across, _, along = shape.inertia
    momentum = across * angular + (along - across) * axis * sum(axis * angular)
    assert np.cross(contact, force) == pytest.approx(speed * np.cross(upwards, momentum), abs=1e-9)


def test_each_case_has_a_name_of_its_own_in_its_table_and_each_table_of_the_page_a_section(benchmark: Import) -> None:
    page = (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8")
    tables = benchmark("contact").tables(None)
    for table in tables:
        assert page.count(f"<!-- contact.py: {table.name} -->") == table.is_on_page
        assert page.count(f"<!-- end of {table.name} -->") == table.is_on_page
        names = [case.name for case in table.cases(table.steps[0], False)]
        assert len(set(names)) == len(names)
        quick = [case.name for case in table.cases(table.steps[0], True)]
        assert set(quick) <= set(names)
    assert len({table.name for table in tables}) == len(tables)


def test_a_section_of_a_page_is_replaced_and_the_rest_stays(benchmark: Import) -> None:
    replace = benchmark("contact_tables").replace_sections
    page = "# Title\n\n<!-- contact.py: hits -->\n\nold\n\n<!-- end of hits -->\n\nrest\n"
    new = replace(page, {"hits": r"a \1 new"})
    assert new == page.replace("old", r"a \1 new")
    with pytest.raises(ValueError, match="no section <!-- contact.py: dice -->"):
        replace(page, {"dice": ""})


def test_a_cell_has_the_worst_of_its_cases_and_a_time_also_its_ratio(benchmark: Import) -> None:
    tables, scene = benchmark("contact_tables"), benchmark("contact_scene")
    quantities = {"error": scene.Quantity("error", "%", 1.0)}
    table = scene.Table("t", "T", "", quantities, lambda step, quick: iter(()), engines=("simkit", "MuJoCo's law"))
    results = tables.Results(table, (0.001,))
    results.add("row", "simkit", 0.001, {"error": -3.0, "step_us": 30.0})
    results.add("row", "simkit", 0.001, {"error": 2.0, "step_us": 10.0})
    results.add("row", "MuJoCo's law", 0.001, {"error": math.nan, "step_us": 10.0})
    text = tables.markdown(results)
    assert "| row | simkit | -3.00 | 20.0 (2.00) |" in text
    assert "| row | MuJoCo's law | diverged | 10.0 (1.00) |" in text


def test_the_page_has_a_column_for_each_engine_with_the_quantities_that_exist_for_a_row(benchmark: Import) -> None:
    tables, scene = benchmark("contact_tables"), benchmark("contact_scene")
    quantities = {key: scene.Quantity(key, "%") for key in ("first", "second", "third")}
    engines = ("simkit", "MuJoCo's law")
    for by_step, headline, expected in (
        (True, (), ["| case, step 1 ms | simkit | MuJoCo's law |", "| row | 2.00 / 3.00 / 0 | 4.00 / – / 0 |"]),
        (False, ("first", "second"), ["| case: first [%] / second [%] | simkit |", "| other | 5.00 | – |"]),
    ):
        table = scene.Table("t", "T", "", quantities, lambda *_: iter(()), (0.002, 0.001), engines=engines)
        results = tables.Results(replace(table, by_step=by_step, headline=headline), (0.002, 0.001))
        results.add("row", "simkit", 0.001, {"first": 2.0, "second": 3.0, "third": 0.0})
        results.add("row", "MuJoCo's law", 0.001, {"first": 4.0, "third": 0.0})
        results.add("other", "simkit", 0.001, {"first": 5.0})
        assert all(line in tables.page_table(results) for line in expected)


def test_a_hit_runs_in_simkit_and_in_its_option_for_the_contacts_of_mujoco(benchmark: Import) -> None:
    contact, hits = benchmark("contact"), benchmark("contact_hits")
    case = hits.hit("ball", hits.THROWN["ball"], 0.3, 45.0, 0.004)
    results = contact.run_case(case, hits.HITS, contact.engines(["simkit", "MuJoCo's law"]))
    assert results["simkit"]["error"] < 3.0
    assert 0.0 < results["MuJoCo's law"]["error"] < 100.0


def _tensor_file(rows: list[list[float]], name: bytes = b"torch._utils\n_rebuild_tensor_v2") -> bytes:
    """The bytes of a tensor in PyTorch's format of before 1.6."""
    height, width = len(rows), len(rows[0])
    storage = b"(X\x07\x00\x00\x00storagectorch\nDoubleStorage\nX\x01\x00\x00\x000X\x03\x00\x00\x00cpu"
    storage += b"K" + bytes([height * width]) + b"Nt"
    sizes = b"K" + bytes([height]) + b"K" + bytes([width]) + b"\x86"
    strides = b"K" + bytes([width]) + b"K\x01\x86"
    tensor = (
        b"\x80\x02c" + name + b"\n(" + storage + b"QK\x00" + sizes + strides + b"\x89ccollections\nOrderedDict\n)RtR."
    )
    head = b"".join(pickle.dumps(value, 2) for value in (1, 1001, {}))
    values = [value for row in rows for value in row]
    return head + tensor + pickle.dumps(["0"], 2) + struct.pack(f"<q{len(values)}d", len(values), *values)


def test_a_recorded_toss_is_read_without_pytorch(benchmark: Import, tmp_path: Path) -> None:
    path = tmp_path / "0.pt"
    path.write_bytes(_tensor_file([[1.0, 2.0, 3.0], [4.0, 5.0, 6.5]]))
    assert benchmark("contact_tosses").read_tensor(path).tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.5]]


def test_a_recorded_toss_calls_no_other_function(benchmark: Import, tmp_path: Path) -> None:
    path = tmp_path / "0.pt"
    path.write_bytes(_tensor_file([[1.0]], b"os\nsystem"))
    with pytest.raises(pickle.UnpicklingError, match=r"os\.system"):
        benchmark("contact_tosses").read_tensor(path)
