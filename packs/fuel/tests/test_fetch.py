"""`simkit fetch`: what a world names comes from a Fuel server into Gazebo's cache, with a lock file."""

from __future__ import annotations

import hashlib
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor
from io import BytesIO
from pathlib import Path
from threading import Barrier
from typing import Any

import pytest
from PIL import Image

import simkit
from packs.fuel.tests.fuel_server import BOX, Fuel, archive, lock, model, run, write_world
from simkit_fuel.fetch import FetchOptions, fetch

MESH = "<visual name='v'><geometry><mesh><uri>{}</uri></mesh></geometry></visual>"
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


LAMP = '<light name="lamp" type="point"/>'


def described_lights() -> list[str]:
    """Return the names of the lights of the first link in the world."""
    link: Any = simkit.describe("w.sdf")["worlds"][0]["models"][0]["links"][0]
    return [light["name"] for light in link["lights"]]


def cached(fuel: Fuel, resource: str) -> Path:
    return Path("cache", f"127.0.0.1:{fuel.port}", resource)


def test_a_world_opens_after_its_models_are_fetched(fuel: Fuel) -> None:
    fuel.archives["o/models/coke can"] = [model(), model()]
    write_world(f"{fuel.url}/1.0/O/models/Coke Can")
    missing = list(simkit.check("w.sdf"))
    assert [d.code for d in missing] == ["SK-URI-002"] and "`simkit fetch w.sdf`" in missing[0].hint
    assert not fuel.requests, "only the command fetch may download"

    result = run("fetch", "w.sdf")
    assert result.exit_code == 0, result.output
    assert "fetched:" in result.output and "version 2" in result.output
    assert (cached(fuel, "o/models/coke can/2") / "model.sdf").is_file()
    assert not [d for d in simkit.check("w.sdf") if d.severity != "note"]
    content = fuel.archives["o/models/coke can"][1]
    assert lock() == {
        "Coke Can": {
            "name": "O/models/Coke Can",
            "url": f"{fuel.url}/1.0/O/models/Coke Can",
            "version": 2,
            "sha256": hashlib.sha256(content).hexdigest(),
            "size": len(content),
        }
    }


def test_a_second_fetch_needs_no_network(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    write_world(f"{fuel.url}/1.0/o/models/box")
    run("fetch", "w.sdf")
    before = Path("simkit.lock").read_bytes()
    result = run("fetch", "w.sdf")
    assert result.exit_code == 0 and "in the cache" in result.output
    assert len(fuel.requests) == 1 and Path("simkit.lock").read_bytes() == before


def test_the_models_in_fetched_models_and_worlds_are_fetched(fuel: Fuel) -> None:
    inner = f"<include><uri>{fuel.url}/1.0/o/models/cup/1</uri></include>"
    table = '<sdf version="1.9"><model name="table">{}<link name="l"/></model></sdf>'
    fuel.archives["o/models/cup"] = [model(), model()]
    fuel.archives["o/models/table"] = [archive({"model.sdf": table.format(inner), "meshes/": b""})]
    url = f"{fuel.url}/o/models/table"
    room = f'<sdf version="1.9"><world name="w"><include><uri>{url}</uri></include></world></sdf>'
    fuel.archives["o/worlds/room"] = [archive({"room.sdf": room})]
    result = run("fetch", f"{fuel.url}/1.0/o/worlds/room")
    assert result.exit_code == 0, result.output
    assert fuel.downloads() == ["room tip", "table tip", "cup 1"]
    with simkit.load(cached(fuel, "o/worlds/room/1") / "room.sdf") as sim:
        assert list(sim.models) == ["table"]
    assert set(lock()) == {"room", "table", "cup"}


def test_the_models_in_local_models_are_fetched(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    include = f"<include><uri>{fuel.url}/1.0/o/models/box</uri></include>"
    Path("models/rack").mkdir(parents=True)
    Path("models/rack/model.sdf").write_text(f'<sdf version="1.9"><model name="r">{include}</model></sdf>')
    write_world("model://rack")
    assert run("fetch", "w.sdf", "--resource-path", "models").exit_code == 0
    assert fuel.downloads() == ["box tip"]


def test_files_of_models_are_found_by_url_and_by_model_uri(fuel: Fuel) -> None:
    mesh = MESH.format("model://Cup/meshes/cup.obj") + MESH.replace("'v'", "'w'").format("model://Lid/lid.obj")
    fuel.archives["o/models/cup"] = [model(mesh, **{"meshes/cup.obj": TETRAHEDRON})]
    fuel.archives["o/models/lid"] = [model(**{"lid.obj": TETRAHEDRON})]
    fuel.archives["o/models/tin"] = [model(), model(**{"a/tin.obj": TETRAHEDRON})]
    look = MESH.format(f"{fuel.url}/1.0/o/models/Tin/tip/files/a/tin.obj")
    cup = f"<include><uri>{fuel.url}/1.0/o/models/Cup</uri></include>"
    look = f'<model name="m"><static>1</static><link name="l">{look}</link></model>'
    Path("w.sdf").write_text(f'<sdf version="1.9"><world name="w">{cup}{look}</world></sdf>')
    result = run("fetch", "w.sdf")
    assert result.exit_code == 0, result.output
    assert not [d for d in simkit.check("w.sdf") if d.severity != "note"]
    assert (
        f"{fuel.url}/1.0/o/models/Cup/1/files/meshes/cup.obj"
        in (cached(fuel, "o/models/cup/1") / "model.sdf").read_text()
    ), "Gazebo reads the same folder, and also stores models with these URLs"


def test_textures_are_found_by_url(fuel: Fuel) -> None:
    picture = BytesIO()
    Image.new("RGB", (2, 2), (200, 0, 0)).save(picture, "PNG")
    fuel.archives["o/models/brick"] = [model(**{"materials/textures/red.png": picture.getvalue()})]
    look = f"<albedo_map>{fuel.url}/1.0/o/models/Brick/tip/files/materials/textures/red.png</albedo_map>"
    look = f"<material><pbr><metal>{look}</metal></pbr></material>"
    Path("w.sdf").write_text(
        '<sdf version="1.9"><model name="m"><static>1</static><link name="l"><visual name="v">'
        f"<geometry><box><size>1 1 1</size></box></geometry>{look}</visual></link></model></sdf>"
    )
    (missing,) = simkit.check("w.sdf")
    assert missing.code == "SK-URI-006" and missing.hint == "download it with `simkit fetch w.sdf`"
    assert run("fetch", "w.sdf").exit_code == 0
    assert not list(simkit.check("w.sdf"))


def test_all_missing_resources_are_reported_in_one_run(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    base = f"{fuel.url}/1.0/o/models"
    write_world(f"{base}/nobody", f"{base}/box/tip/files/no.obj", f"{base}/box/7", f"{base}/box", "https://a.b/c")
    result = run("fetch", "w.sdf")
    assert result.exit_code == 2
    for text in ("w.sdf:2: error SK-FETCH-001", "w.sdf:3: error SK-FETCH-001", "w.sdf:4: error SK-FETCH-001"):
        assert text in result.output
    assert "has no file no.obj" in result.output and "w.sdf:6: warning SK-FETCH-008" in result.output
    assert set(lock()) == {"box"}, "what is there is stored nevertheless"


def test_without_a_network_one_error_lists_what_is_missing(fuel: Fuel) -> None:
    write_world(*(f"http://127.0.0.1:9/1.0/o/models/{name}" for name in "abc"))
    result = run("fetch", "w.sdf")
    assert result.exit_code == 1
    assert result.output.count("SK-FETCH-006") == 1
    assert all(f"models/{name}" in result.output for name in "abc")
    assert not list(Path("cache").rglob("*.part"))


def test_a_dry_run_lists_sizes_and_writes_nothing(fuel: Fuel) -> None:
    content = model(**{"data.bin": bytes(range(256)) * 40})
    fuel.archives["o/models/box"] = [content]
    write_world(f"{fuel.url}/1.0/o/models/box")
    result = run("fetch", "w.sdf", "--dry-run")
    assert result.exit_code == 0
    assert f"version 1, {len(content) / 1e6:.3g} MB" in result.output
    assert fuel.downloads() == ["box tip 0-0"] and not Path("cache").exists() and not Path("simkit.lock").exists()


def test_a_world_without_urls_needs_no_server(fuel: Fuel) -> None:
    write_world("https://fuel.gazebosim.org/1.0/OpenRobotics/models/Sun", "model://ground_plane")
    result = run("fetch", "w.sdf")
    assert (result.exit_code, fuel.requests) == (0, [])
    assert "names nothing" in result.output and not Path("simkit.lock").exists()


def test_another_server_answers_for_the_servers_in_the_urls(fuel: Fuel, monkeypatch: pytest.MonkeyPatch) -> None:
    fuel.archives["o/models/box"] = [model()]
    write_world("https://fuel.gazebosim.org/1.0/o/models/box")
    monkeypatch.setenv("GZ_FUEL_SERVER", fuel.url)
    assert run("fetch", "w.sdf").exit_code == 0
    assert Path("cache/fuel.gazebosim.org/o/models/box/1/model.sdf").is_file()
    assert not [d for d in simkit.check("w.sdf") if d.severity != "note"]


def test_the_lock_chooses_the_version_of_a_later_fetch_and_of_a_run(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    write_world(f"{fuel.url}/1.0/o/models/box")
    run("fetch", "w.sdf")
    fuel.archives["o/models/box"].append(model(LAMP))
    shutil.rmtree("cache")
    run("fetch", "w.sdf")
    assert fuel.downloads() == ["box tip", "box 1"]

    (cached(fuel, "o/models/box") / "2").mkdir()
    (cached(fuel, "o/models/box") / "2" / "model.sdf").write_text(BOX.format(LAMP))
    assert described_lights() == []
    Path("simkit.lock").rename("elsewhere.lock")
    assert described_lights() == ["lamp"], "without a lock file, the newest version in the cache counts"

    Path("elsewhere.lock").rename("simkit.lock")
    result = run("fetch", "w.sdf", "--update")
    assert result.exit_code == 0 and "version 2" in result.output
    assert lock()["box"]["version"] == 2
    assert described_lights() == ["lamp"]


def test_an_update_does_not_download_what_is_there(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    write_world(f"{fuel.url}/1.0/o/models/box")
    run("fetch", "w.sdf")
    result = run("fetch", "w.sdf", "--update")
    assert result.exit_code == 0 and "in the cache" in result.output and "0 fetched" in result.output


def test_other_content_than_in_the_lock_is_refused(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    write_world(f"{fuel.url}/1.0/o/models/box")
    run("fetch", "w.sdf")
    before = Path("simkit.lock").read_bytes()
    fuel.archives["o/models/box"] = [model("<!-- other content of the same version -->")]
    (cached(fuel, "o/models/box/1") / "model.sdf").write_text("changed by hand")
    result = run("fetch", "w.sdf")
    assert result.exit_code == 2 and "SK-FETCH-005" in result.output
    assert Path("simkit.lock").read_bytes() == before
    assert (cached(fuel, "o/models/box/1") / "model.sdf").read_text() == "changed by hand"
    assert run("fetch", "w.sdf", "--update").exit_code == 0
    assert lock()["box"]["size"] == len(fuel.archives["o/models/box"][0])


@pytest.mark.parametrize("text", ["", "[]", '{"format": 1, "entries": [{"url": 3}]}', "\0" * 9])
def test_an_invalid_lock_is_an_error(fuel: Fuel, text: str) -> None:
    write_world(f"{fuel.url}/1.0/o/models/box")
    Path("simkit.lock").write_text(text)
    for command in ("fetch", "check"):
        result = run(command, "w.sdf")
        assert result.exit_code == 2 and "simkit.lock: error SK-FETCH-007" in result.output, command
    assert [d.code for d in simkit.check("w.sdf")] == ["SK-URI-002", "SK-FETCH-007"]


@pytest.mark.skipif(sys.platform != "linux", reason="uses a folder in which nobody can write")
def test_a_world_in_a_folder_that_is_not_writable_gets_its_models(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    write_world(f"{fuel.url}/1.0/o/models/box")
    Path("simkit.lock").symlink_to("/proc/nobody/simkit.lock")
    result = run("fetch", "w.sdf")
    assert result.exit_code == 0 and "warning SK-FETCH-009" in result.output
    assert (cached(fuel, "o/models/box/1") / "model.sdf").is_file()


def test_two_fetches_at_once_download_once(fuel: Fuel) -> None:
    fuel.archives["o/models/box"] = [model()]
    url = f"{fuel.url}/1.0/o/models/box"
    start = Barrier(2)

    def one(_: int) -> str:
        start.wait(20.0)
        return fetch(url, FetchOptions()).resources[0].state

    with ThreadPoolExecutor(2) as pool:
        states = sorted(pool.map(one, range(2)))
    assert states in (["fetched", "in the cache"], ["fetched", "fetched"])
    assert len(fuel.requests) == states.count("fetched") == 1
    assert not list(Path("cache/.simkit-fetch").iterdir())
