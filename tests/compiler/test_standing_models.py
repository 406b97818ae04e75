"""Heights of models without a given height: they stand on what is below them."""

from __future__ import annotations

import math
from pathlib import Path

import mujoco
import pytest

import simkit

BOX = "<box><size>0.2 0.2 0.2</size></box>"
BALL = "<sphere><radius>0.1</radius></sphere>"


def model(geometry: str, name: str = "m", pose: str = "", *, static: bool = False) -> str:
    placed = f"<pose>{pose}</pose>" if pose else ""
    return (
        f'<model name="{name}">{placed}<static>{str(static).lower()}</static><link name="l"><inertial><mass>1</mass>'
        f'</inertial><collision name="c"><geometry>{geometry}</geometry></collision></link></model>'
    )


def world(*models: str) -> str:
    ground = "<include><uri>model://ground_plane</uri></include>"
    return f'<sdf version="1.9"><world name="w">{ground}{"".join(models)}</world></sdf>'


def write(folder: Path, text: str, name: str = "m.sdf") -> Path:
    file = folder / name
    file.write_text(f'<sdf version="1.9">{text}</sdf>' if name.endswith(".sdf") else text)
    return file


def start_height(sim: simkit.Simulation, name: str = "m") -> float:
    return float(sim.model(name).pose.position[2])


def deepest(sim: simkit.Simulation) -> float:
    mujoco.mj_forward(sim.mj_model, sim.mj_data)
    return min((contact.dist for contact in sim.mj_data.contact), default=0.0)


TABLE = model("<box><size>1 1 0.04</size></box>", "table", "0 0 0.75 0 0 0", static=True)
ROOF = model("<box><size>4 4 0.1</size></box>", "roof", "0 0 2.5 0 0 0", static=True)
TOWER = model("<box><size>1 1 3</size></box>", "tower", "0 0 1.5 0 0 0", static=True)
RAMP = model("<box><size>4 2 0.5</size></box>", "ramp", "0 0 0 0 0.3 0", static=True)
POLE = model(
    "<cylinder><radius>0.005</radius><length>0.5</length></cylinder>", "pole", "0.03 0 0.25 0 0 0", static=True
)
BEAM = model("<box><size>2 0.05 0.05</size></box>", "beam", f"0 0 0.3 {math.pi / 4} 0 0.7", static=True)


@pytest.mark.parametrize(
    ("obstacle", "geometry", "height"),
    [
        ("", BOX, 0.1),
        (TABLE, BOX, 0.87),
        (ROOF, BOX, 0.1),  # 2.45 m are free below the roof
        (TOWER, BOX, 3.1),  # solid down to the ground
        (RAMP, BALL, 0.25 / math.cos(0.3) + 0.1 / math.cos(0.3)),
        (POLE, BOX, 0.6),  # between the corners of the box
        (BEAM, BOX, 0.3 + 0.025 * math.sqrt(2) + 0.1),  # an edge between the columns
    ],
    ids=["ground", "table", "roof", "tower", "ramp", "pole", "beam"],
)
def test_a_model_stands_on_the_highest_surface_below_it(
    tmp_path: Path, obstacle: str, geometry: str, height: float
) -> None:
    file = write(tmp_path, model(geometry))
    with simkit.load(world(obstacle), spawn=[f"{file}:0,0,0.2"]) as sim:
        assert start_height(sim) == pytest.approx(height, abs=1e-4)
        assert deepest(sim) > -1e-5


def test_a_given_height_is_taken_as_written(tmp_path: Path) -> None:
    file = write(tmp_path, model(BOX))
    spawn = [f"{file}:0,0,0.02,0:low", f"{file}:3,0,2,0,0,0.5:high"]
    with simkit.load(world(), spawn=spawn) as sim:
        assert start_height(sim, "low") == 0.02
        assert start_height(sim, "high") == 2.0


def test_the_height_of_a_pose_in_the_file_is_replaced_and_small_gaps_stay(tmp_path: Path) -> None:
    high = write(tmp_path, model(BOX, pose="9 9 0.5 0 0 0"), "high.sdf")
    near = write(tmp_path, model(BOX, pose="9 9 0.1009 0 0 0"), "near.sdf")
    alone = write(tmp_path, model(BOX, pose="5 0 0.5 0 0 0"), "alone.sdf")
    with simkit.load(world(), spawn=[f"{high}:0,0,0:a", f"{near}:1,0,0:b", f"{alone}"]) as sim:
        assert start_height(sim, "a") == pytest.approx(0.1, abs=1e-9)
        assert start_height(sim, "b") == 0.1009
        assert start_height(sim, "m") == 0.5  # the file's own pose is taken as written
        moved = [d for d in sim.diagnostics if d.code == "SK-SPAWN-003"]
        assert [d.message.split()[0] for d in moved] == ["a"]


def test_models_stand_on_those_that_were_spawned_before_them(tmp_path: Path) -> None:
    file = write(tmp_path, model(BOX))
    with simkit.load(world(), spawn=[f"{file}:0,0,0:a", f"{file}:0,0,0:b", f"{file}:0,0,0:c"]) as sim:
        assert [round(start_height(sim, n), 6) for n in "abc"] == [0.1, 0.3, 0.5]


def test_all_links_and_sensors_of_a_robot_move_together() -> None:
    with simkit.load(world(TABLE), spawn=["turtlebot3_burger:0,0,0:r"]) as sim:
        assert start_height(sim, "r") == pytest.approx(0.77, abs=1e-3)
        assert sim.sensor("r::imu_link::imu").pose.position[2] > 0.77
        sim.run(1.0)
        assert start_height(sim, "r") == pytest.approx(0.77, abs=2e-3)


def test_static_models_and_models_fixed_to_the_world_are_not_moved(tmp_path: Path) -> None:
    file = write(tmp_path, model(BOX, static=True))
    post = '<joint name="j" type="fixed"><parent>world</parent><child>l</child></joint></model>'
    fixed = write(tmp_path, model(BOX).replace("</model>", post), "fixed.sdf")
    with simkit.load(world(), spawn=[f"{file}:0,0,0", f"{fixed}:1,0,0:post"]) as sim:
        assert start_height(sim) == start_height(sim, "post") == 0.0
        (note,) = (d for d in sim.diagnostics if d.code.startswith("SK-SPAWN"))
        assert note.code == "SK-SPAWN-004" and "0.1 m below" in note.message


def test_a_model_stands_on_a_mesh_and_with_a_mesh(tmp_path: Path) -> None:
    """A tetrahedron that points down touches with its tip; a wedge of 45° carries a ball."""
    (tmp_path / "tip.obj").write_text("v 0 0 0\nv 1 0 1\nv -1 1 1\nv -1 -1 1\nf 1 3 2\nf 1 4 3\nf 1 2 4\nf 2 3 4\n")
    (tmp_path / "wedge.obj").write_text(
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 2\nv 1 1 2\n"
        "f 1 3 2\nf 1 4 3\nf 2 3 6\nf 2 6 5\nf 1 2 5\nf 4 6 3\nf 1 5 6\nf 1 6 4\n"
    )
    mesh = "<mesh><uri>{}</uri></mesh>"
    tip = write(tmp_path, model(mesh.format("tip.obj"), pose="0 0 0.5 0 0 0"), "tip.sdf")
    ball = write(tmp_path, model(BALL), "ball.sdf")
    wedge = model(mesh.format(tmp_path / "wedge.obj"), "wedge", static=True)
    with simkit.load(world(wedge), spawn=[f"{tip}:5,0,0:tip", f"{ball}:0,0,0:ball"], resource_paths=[tmp_path]) as sim:
        assert start_height(sim, "tip") == pytest.approx(0.0, abs=1e-6)
        assert start_height(sim, "ball") == pytest.approx(1.0 + 0.1 * math.sqrt(2), abs=1e-4)


def test_without_anything_below_a_model_keeps_its_height(tmp_path: Path) -> None:
    file = write(tmp_path, model(BOX, pose="0 0 3 0 0 0"))
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>', spawn=[f"{file}:1,0,0"]) as sim:
        assert sim.model("m").pose.position.tolist() == [1.0, 0.0, 3.0]
