"""Values of a world as a flat table."""

from __future__ import annotations

from pathlib import Path

import pytest
from falling import ball

import simkit
from simkit.testing.run_record.fingerprint import source_hashes
from simkit.testing.run_record.state_recorder import fields_of_model
from simkit.testing.run_record.world_values import split_path, values_of_simulation


def leaves(path: Path) -> tuple[dict[str, object], dict[str, str]]:
    with simkit.load(str(path)) as sim:
        return values_of_simulation(sim)


def test_a_value_has_a_path_of_names_and_a_source_position(tmp_path: Path) -> None:
    found, places = leaves(ball(tmp_path))
    path = "models[ball].links[l].collisions[c].geometry"
    assert found[path] == "Sphere" and found[path + ".radius"] == 0.1
    assert places[path + ".radius"] == f"{tmp_path / 'ball.sdf'}:5"
    noise = "models[ball].links[l].sensors[imu].params.imu.linear_acceleration.x.noise"
    assert found[noise + ".stddev"] == 0.1 and found[noise + "@type"] == "gaussian"
    assert found["models[ball].pose_world"] == [0, 0, 0.3, 1, 0, 0, 0]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("<radius>0.1</radius>", "<radius>0.101</radius>"),
        ("<stddev>0.1</stddev>", "<stddev>0.12</stddev>"),
        ("<update_rate>100</update_rate>", "<update_rate>101</update_rate>"),
        ("<pose>2 0 0 0 0 0</pose>", "<pose>2.002 0 0 0 0 0</pose>"),
        ("<pose>2 0 0 0 0 0</pose>", "<pose>2 0 0 0 0 0.0175</pose>"),
        ("<samples>36</samples>", "<samples>37</samples>"),
        ("<max>5</max>", "<max>5.05</max>"),
    ],
)
def test_an_effective_change_is_a_difference(tmp_path: Path, before: str, after: str) -> None:
    assert leaves(ball(tmp_path))[0] != leaves(ball(tmp_path, (before, after)))[0]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("<radius>0.1</radius>", "<radius> 0.10 </radius><!-- as bought -->"),
        ("<stddev>0.1</stddev>", "<stddev>1e-1</stddev>"),
        ("</link></model>\n<model", "</link></model>\n\n\n<model"),
        ("<mean>0</mean><stddev>0.1</stddev>", "<stddev>0.1</stddev><mean>0</mean>"),
    ],
)
def test_a_change_of_format_only_is_no_difference(tmp_path: Path, before: str, after: str) -> None:
    assert leaves(ball(tmp_path))[0] == leaves(ball(tmp_path, (before, after)))[0]


def test_paths_are_split_into_steps() -> None:
    assert split_path("models[a].links[b::c].geometry.radius") == [
        ("models", "a"), ("links", "b::c"), ("geometry", ""), ("radius", ""),
    ]  # fmt: skip
    assert split_path("params.image@type") == [("params", ""), ("image", ""), ("@type", "")]
    assert split_path("models[50%25 %5Dodd].name") == [("models", "50% ]odd"), ("name", "")]


def test_the_compiled_model_is_found_by_names(tmp_path: Path) -> None:
    with simkit.load(str(ball(tmp_path))) as sim:
        fields = fields_of_model(sim)
    key = next(name for name in fields if name.startswith("geom ball::l::c") and name.endswith(" size"))
    assert fields[key][0] == 0.1
    assert fields["option engine timestep"] == 0.001


def test_code_of_a_plugin_and_content_of_a_mesh_are_sources(tmp_path: Path) -> None:
    (tmp_path / "tri.stl").write_text(
        "solid t\n"
        + "".join(
            f"facet normal 0 0 1\nouter loop\n{vertices}endloop\nendfacet\n"
            for vertices in (
                "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n",
                "vertex 0 0 0\nvertex 0 0 1\nvertex 1 0 0\n",
                "vertex 0 0 0\nvertex 0 1 0\nvertex 0 0 1\n",
                "vertex 1 0 0\nvertex 0 0 1\nvertex 0 1 0\n",
            )
        )
        + "endsolid t\n"
    )
    (tmp_path / "breeze.py").write_text(
        "import simkit\nclass Breeze(simkit.WorldPlugin):\n    def load(self, sim, params):\n        pass\n"
    )
    path = ball(
        tmp_path,
        ("<box>\n<size>0.1 4 4</size></box>", "<mesh><uri>tri.stl</uri></mesh>"),
        ("</world>", '<plugin filename="breeze.py" name="Breeze"/></world>'),
    )
    with simkit.load(str(path), plugin_paths=[tmp_path]) as sim:
        found = source_hashes(sim)
    assert set(found) == {"tri.stl", "breeze.py"}
