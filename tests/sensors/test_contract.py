"""Properties of every kind of sensor, tested for every registered kind."""

from __future__ import annotations

import dataclasses
import functools
import gc
import inspect
import json
import os
import re
import subprocess
import sys
import weakref
from pathlib import Path
from typing import Any, get_type_hints

import contract_worlds as worlds
import pytest
from contract_worlds import digest, load, plain, published_digests, sensor_of

import simkit
from simkit import msgs
from simkit.sensors import sensor_kinds
from simkit.sensors.noise import NoiseModel

ROOT = Path(__file__).resolve().parents[2]
PAGES = {
    **dict.fromkeys(("ray", "gpu_ray", "gpu_lidar"), "lidar"),
    "anemometer": "air",
    "depth": "depth_camera",
    "dsros_dvl": "dvl",
    "gps": "navsat",
    "thermal": "thermal_camera",
    "wideanglecamera": "wide_angle_camera",
    "segmentation": "segmentation_camera",
    "boundingbox": "boundingbox_camera",
}
"""Page of each kind whose page has another name: under `docs/sensors` of the core, or under `docs` of a pack."""


KINDS = list(sensor_kinds())
kinds = pytest.mark.parametrize("kind", KINDS)


@functools.cache
def first_run(kind: str) -> list[tuple[int, str, str]]:
    with load(kind, noisy=True) as sim:
        found = published_digests(sim)
        assert found, "nothing was published"
        return found


@kinds
def test_a_reset_repeats(kind: str) -> None:
    with load(kind, noisy=True) as sim:
        assert published_digests(sim) == first_run(kind)
        sim.reset()
        assert sensor_of(sim).latest is None
        sim.model("m").set_velocity((0.5, 0.2, -1.0), (1.0, -0.5, 0.7))
        assert published_digests(sim) == first_run(kind)


@pytest.mark.slow
def test_another_process_gives_the_same_bits() -> None:
    script = Path(worlds.__file__)
    path = os.pathsep.join([str(ROOT), str(script.parent)])
    environment = {**os.environ, "PYTHONHASHSEED": "4711", "PYTHONPATH": path}
    # drawing an image takes longer than the rest of the test
    asked = [k for k in KINDS if not worlds.is_rendered(k) or k == "rgbd_camera"]
    done = subprocess.run([sys.executable, str(script), *asked], env=environment, capture_output=True, check=True)
    there = json.loads(done.stdout)
    for kind in asked:
        assert [tuple(one) for one in there[kind]] == first_run(kind), kind


@kinds
@pytest.mark.parametrize("is_read", [True, False])
def test_a_removed_sensor_keeps_no_reference_to_its_world(kind: str, is_read: bool) -> None:
    with load(kind) as sim:
        # a reset returns to the world of the file, so the model of the file stays
        sim.spawn('<sdf version="1.9"><model name="post"><static>1</static><link name="l"/></model></sdf>')
        sensor = sensor_of(sim)
        subscriptions = [sim.subscribe(topic, keep=1) for topic in sensor._topics.values() if is_read]
        sim.run(0.1)
        there = weakref.ref(sim.engine.structure)
        sim.remove("m")
        sim.step()
        gc.collect()
        assert there() is None
        assert all(subscription.latest is not None for subscription in subscriptions)


@kinds
def test_a_restored_run_repeats(kind: str) -> None:
    with load(kind, noisy=True) as sim:
        sim.run(0.1)
        state = sim.snapshot()
        before = digest(sensor_of(sim).latest)
        first = published_digests(sim, 0.15)
        sim.restore(state)
        assert digest(sensor_of(sim).latest) == before
        assert published_digests(sim, 0.15) == first


@kinds
def test_the_time_of_subscription_changes_no_reading(kind: str) -> None:
    with load(kind, noisy=True) as late, load(kind, noisy=True) as unread, load(kind, noisy=True) as kept:
        late.run(0.1)
        assert published_digests(late, worlds.DURATION - 0.1) == [m for m in first_run(kind) if m[0] > 100]
        unread.run(worlds.DURATION)
        assert digest(sensor_of(unread).latest) == digest(sensor_of(late).latest)
        assert digest(sensor_of(unread).truth) == digest(sensor_of(late).truth)
        topic = sensor_of(kept).topic
        waiting = kept.subscribe(topic)
        kept.run(worlds.DURATION)
        assert [digest(m) for m in waiting.messages] == [d for _, t, d in first_run(kind) if t == topic]


@kinds
def test_the_truth_has_no_noise(kind: str) -> None:
    with load(kind) as clean, load(kind, noisy=True) as noisy:
        for _ in range(3):
            clean.run(0.06)
            noisy.run(0.06)
            said, known = sensor_of(clean), sensor_of(noisy)
            assert plain(known.truth) == plain(said.truth)
            if kind != "encoder":  # whose counts are no noise
                assert plain(said.latest) == plain(said.truth)
            if kind in worlds.NOISY:
                assert plain(known.latest) != plain(known.truth)


@kinds
def test_a_kind_that_reads_noise_has_a_noisy_example(kind: str) -> None:
    """Without an entry in `NOISY`, all tests of noise here would pass without noise."""
    with load(kind) as sim:
        if has_noise_model(sensor_of(sim).options):
            assert kind in worlds.NOISY or kind in worlds.NOISELESS, f"add {kind!r} to NOISY of contract_worlds.py"


def has_noise_model(value: object) -> bool:
    """Check whether options contain a noise model, also in a tuple or in further options."""
    if isinstance(value, NoiseModel):
        return True
    if dataclasses.is_dataclass(value):
        return any(has_noise_model(getattr(value, field.name)) for field in dataclasses.fields(value))
    return isinstance(value, tuple) and any(map(has_noise_model, value))


@kinds
def test_samples_lie_on_the_grid_and_carry_its_times(kind: str) -> None:
    period = 1000 // worlds.RATE
    with load(kind) as sim:
        stamps: list[tuple[int, int]] = []
        sim.communication.bus.tap(sensor_of(sim).topic, lambda m: stamps.append((sim.tick, msgs.stamp_ns(stamp_of(m)))))
        sim.run(worlds.DURATION)
        assert stamps
        for tick, stamp in stamps:
            assert stamp == tick * 1_000_000
            assert tick == 1 or tick % period == 0
        latest = sensor_of(sim).latest
        assert msgs.stamp_ns(stamp_of(latest)) == worlds.DURATION * 1000 // period * period * 1_000_000


def stamp_of(message: Any) -> Any:
    return message.header.stamp if hasattr(message, "header") else message.stamp


@kinds
def test_latency_shifts_the_arrival_and_not_the_content(kind: str) -> None:
    with load(kind, noisy=True, extra="<latency>0.0555</latency>") as sim:
        expected = [(tick + 56, topic, d) for tick, topic, d in first_run(kind)]
        assert published_digests(sim) == [m for m in expected if m[0] <= worlds.DURATION * 1000]


# ---------------------------------------------------------------------- documents


@pytest.mark.parametrize("kind", list(sensor_kinds()))
def test_a_kind_has_a_page_that_names_it(kind: str) -> None:
    name = f"{PAGES.get(kind, kind)}.md"
    pages = [page for page in (ROOT / "docs" / "sensors" / name, *ROOT.glob(f"packs/*/docs/{name}")) if page.is_file()]
    assert len(pages) == 1
    assert re.search(rf"[`\"]{kind}[`\"]", pages[0].read_text(encoding="utf-8"))


def numeric(hint: Any) -> bool:
    """Check whether a field has a unit: a number with a point, or its noise."""
    parts = getattr(hint, "__args__", ())
    return hint in (float, NoiseModel) or any(numeric(p) for p in parts if p is not Ellipsis)


_UNIT = re.compile(
    r"\[[^\]]+\]|\bin (m|rad|s|Pa|T)\b|\b1 m\b|\b(degrees?|ratio|factor|year|unit vector|from 0 to 1|of 1)\b"
)


@pytest.mark.parametrize("kind", list(sensor_kinds()))
def test_options_say_their_units(kind: str) -> None:
    """Each attribute has its unit in its own line under "Attributes:", or the summary has one unit for all."""
    with simkit.load(worlds.source(kind)) as sim:
        options = type(sensor_of(sim).options)
    assert dataclasses.is_dataclass(options)
    summary, _, attributes = inspect.cleandoc(options.__doc__ or "").partition("Attributes:")
    assert summary and not summary.startswith(f"{options.__name__}(")
    for name, hint in get_type_hints(options).items():
        if numeric(hint):
            own = re.search(rf"^ {{4}}[\w, ]*\b{name}\b[\w, ]*:(.*?)(?=^ {{4}}\w|\Z)", attributes, re.M | re.S)
            said = own[1] if own else ""
            assert _UNIT.search(said) or _UNIT.search(summary), f"{options.__name__}.{name} has no unit"


@kinds
def test_the_description_for_inspect_is_plain_json(kind: str) -> None:
    with simkit.load(worlds.source(kind)) as sim:
        json.dumps(sensor_of(sim).describe())
