"""Elements of worlds: merges, frames and joints between models, populations, actors, saved states, surroundings."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest

CELL = """<sdf version="1.10"><model name="cell"><frame name="mark"><pose>0 0 1 0 0 0</pose></frame>
  <model name="table"><pose>1 0 0 0 0 0</pose><link name="l"/></model>
  <model name="arm"><pose relative_to="mark">0 0 0 0 0 0</pose><link name="l"/></model>
  <joint name="bolt" type="fixed"><parent>table</parent><child>arm</child></joint>
  <plugin name="p" filename="libp.so"/></model></sdf>"""


def world(content: str, version: str = "1.10") -> str:
    return f'<sdf version="{version}"><world name="w">\n{content}</world></sdf>'


def errors(found) -> list[str]:
    return [d.message for d in found if d.severity == "error"]


def at(pose) -> tuple[float, ...]:
    return tuple(round(float(v), 9) for v in pose.position)


def test_a_model_merged_into_a_world_adds_its_models_frames_and_joints(load, write):
    root = write("models/cell/model.sdf", CELL).parents[1]
    scene, found = load(
        world('<include merge="true"><uri>model://cell</uri><pose>0 5 0 0 0 1.5707963267948966</pose></include>'),
        (root,),
    )
    assert not errors(found)
    w = scene.world
    assert [(m.scoped, at(m.pose_world)) for m in w.models] == [("table", (0, 6, 0)), ("arm", (0, 5, 1))]
    assert [(j.scoped, j.parent_link, j.child_link) for j in w.joints] == [("bolt", "table::l", "arm::l")]
    assert [(f.name, f.attached_to) for f in w.frames] == [
        ("mark", "table::l"),
        ("_merged__cell____model__", "table::l"),
    ]
    assert [p.filename for p in w.plugins] == ["libp.so"]


def test_a_placement_frame_places_a_merged_model(load, write):
    root = write("models/cell/model.sdf", CELL).parents[1]
    scene, found = load(
        world(
            '<include merge="true"><uri>model://cell</uri><placement_frame>mark</placement_frame>'
            "<pose>0 0 3 0 0 0</pose></include>"
        ),
        (root,),
    )
    assert not errors(found)
    assert [at(m.pose_world) for m in scene.world.models] == [(1, 0, 2), (0, 0, 3)]


def test_links_cannot_be_merged_into_a_world(load, write):
    root = write("models/m/model.sdf", '<sdf version="1.9"><model name="m"><link name="l"/></model></sdf>').parents[1]
    scene, found = load(world('<include merge="true"><uri>model://m</uri></include>'), (root,))
    assert errors(found) == ["<link name='l'> of 'm' cannot be merged into a world"]
    assert scene.world.models == ()


def test_dropped_settings_of_a_merged_model_cause_a_note(load, write):
    text = '<sdf version="1.9"><model name="m"><static>1</static><link name="l"/></model></sdf>'
    root = write("models/m/model.sdf", text).parents[1]
    scene, found = load(
        '<sdf version="1.9"><model name="o"><link name="k"/><include merge="true"><uri>model://m</uri></include>'
        "</model></sdf>",
        (root,),
    )
    assert not scene.model.static
    assert [d.message for d in found if d.code == "SK-SDF-035"] == ["the merge drops <static> of the merged model 'm'"]


def test_frames_and_joints_of_a_world_can_refer_to_nested_models(load):
    scene, found = load(
        world("""<model name="a"><pose>1 0 0 0 0 0</pose><model name="in"><pose>0 1 0 0 0 0</pose><link name="l"/>
          <frame name="g"><pose>0 0 1 0 0 0</pose></frame></model></model>
          <model name="b"><link name="l"/></model>
          <frame name="f" attached_to="a::in::g"><pose>0 0 1 0 0 0</pose></frame>
          <joint name="j" type="revolute"><parent>f</parent><child>b</child>
            <axis><xyz expressed_in="f">0 1 0</xyz></axis></joint>
          <joint name="k" type="fixed"><parent>world</parent><child>a::in</child>
            <pose relative_to="f"/></joint>
          <light name="lamp" type="point"><pose relative_to="f">0 0 1 0 0 0</pose></light>""")
    )
    assert not errors(found)
    w = scene.world
    assert [(f.name, at(f.pose_world), f.attached_to) for f in w.frames] == [("f", (1, 1, 2), "a::in::l")]
    j, k = w.joints
    assert (j.parent_link, j.child_link, at(j.pose_world)) == ("a::in::l", "b::l", (0, 0, 0))
    assert (k.parent_link, k.child_link, at(k.pose_world)) == ("world", "a::in::l", (1, 1, 2))
    assert at(w.lights[0].pose_world) == (1, 1, 3)


def test_the_first_of_several_worlds_runs_and_all_are_read(load):
    two = '<sdf version="1.9"><world name="a"/><world name="b"><gravity>0 0 -1</gravity></world></sdf>'
    scene, found = load(two)
    assert [(w.name, w.gravity[2]) for w in scene.worlds] == [("a", -9.8), ("b", -1)]
    assert [d.code for d in found] == ["SK-SDF-031"] and scene.world.name == "a"


# ---------------------------------------------------------------------------------------------------- populations


def population(rest: str, pose: str = "10 0 1 0 0 0", name: str = "p") -> str:
    return world(
        f'<population name="{name}"><model name="can"><pose>7 7 7 0 0 0</pose><link name="l"/></model>'
        f"<pose>{pose}</pose>{rest}</population>"
    )


def points(scene) -> np.ndarray:
    return np.array([m.pose_world.position for m in scene.world.models])


def test_a_population_grid_has_rows_along_y_and_its_middle_at_the_pose(load):
    scene, found = load(
        population("<distribution><type>grid</type><rows>2</rows><cols>3</cols><step>2 1 0</step></distribution>")
    )
    assert not errors(found)
    assert [m.name for m in scene.world.models] == [f"can_clone_{i}" for i in range(6)]
    want = [(x, y, 1) for y in (-0.5, 0.5) for x in (8, 10, 12)]
    np.testing.assert_allclose(points(scene), want, atol=1e-12)


@pytest.mark.parametrize(("axis", "step"), [("x", (2, 0, 0)), ("y", (0, 1, 0)), ("z", (0, 0, 0.5))])
def test_a_population_line_begins_at_one_side_of_the_box(load, axis, step):
    scene, _ = load(
        population(
            f"<model_count>4</model_count><distribution><type>linear-{axis}</type></distribution>"
            "<box><size>8 4 2</size></box>"
        )
    )
    found = points(scene)
    np.testing.assert_allclose(np.diff(found, axis=0), [step] * 3, atol=1e-12)
    first = np.array((10, 0, 1)) - np.array((8, 4, 2)) / 2 * (np.array(step) > 0)
    np.testing.assert_allclose(found[0], first, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["random", "uniform"])
def test_random_points_are_inside_the_region(load, kind):
    rest = f"<model_count>40</model_count><distribution><type>{kind}</type></distribution>"
    found = points(load(population(rest + "<box><size>8 4 2</size></box>"))[0])
    assert (np.abs(found - (10, 0, 1)) <= (4, 2, 1)).all() and len(np.unique(found, axis=0)) == 40
    found = points(load(population(rest + "<cylinder><radius>3</radius><length>2</length></cylinder>"))[0])
    radius = np.hypot(found[:, 0] - 10, found[:, 1])
    assert radius.max() <= 3 and found[:, 2].min() >= 1 and found[:, 2].max() <= 3


def test_uniform_points_are_spread_evenly(load):
    rest = "<model_count>16</model_count><distribution><type>{}</type></distribution><box><size>8 8 0.1</size></box>"

    def nearest(kind: str) -> float:
        found = points(load(population(rest.format(kind)))[0])[:, :2]
        apart = np.linalg.norm(found[:, None] - found[None], axis=2) + 9 * np.eye(16)
        return float(apart.min())

    assert nearest("uniform") > 1.0 > nearest("random")


def test_the_same_population_name_gives_the_same_points_in_every_process(load):
    rest = "<model_count>5</model_count><distribution><type>random</type></distribution><box><size>8 4 2</size></box>"
    text = population(rest)
    code = (
        "import sys\nfrom simkit.diagnostics import Diagnostics\nfrom simkit.loaders import Resolver, load_scene\n"
        "scene = load_scene(sys.argv[1], resolver=Resolver(), diagnostics=Diagnostics())\n"
        "print([v.hex() for m in scene.world.models for v in m.pose_world.position.tolist()])"
    )
    output = subprocess.run([sys.executable, "-c", code, text], capture_output=True, text=True, check=True).stdout
    mine = [v.hex() for point in points(load(text)[0]).tolist() for v in point]
    assert output.strip() == str(mine)
    assert not np.array_equal(points(load(population(rest, name="q"))[0]), points(load(text)[0]))


@pytest.mark.parametrize(
    ("rest", "expected_text"),
    [
        ("<model_count>2</model_count>", "needs a <box> or a <cylinder>"),
        ("<distribution><type>linear_x</type></distribution>", "did you mean 'linear-x'?"),
        ("<model_count>2</model_count><box><size>0 1 1</size></box>", "without a volume"),
        ("<model_count>0</model_count><box/>", "a whole number of at least 1"),
        ("<model_count>1000000000</model_count><box/>", "the limit is 20000"),
        (
            "<model_count>2</model_count><distribution><type>linear-x</type></distribution><cylinder/>",
            "needs a <box>",
        ),
    ],
)
def test_a_population_without_a_valid_region_is_an_error(load, rest, expected_text):
    _, found = load(population(rest))
    wrong = [d for d in found if d.severity == "error"]
    assert wrong and expected_text in wrong[0].message + wrong[0].hint


# ---------------------------------------------------------------------- actors, saved states, surroundings


def test_an_actor_is_read_in_full(load):
    scene, found = load(
        world("""<actor name="ann"><pose>1 0 0 0 0 0</pose><skin><filename>walk.dae</filename><scale>2</scale></skin>
          <animation name="walk"><filename>walk.dae</filename><interpolate_x>true</interpolate_x></animation>
          <script><loop>false</loop><delay_start>3</delay_start><trajectory id="4" type="walk">
          <waypoint><time>0</time><pose>0 0 0 0 0 0</pose></waypoint>
          <waypoint><time>2</time><pose>1 0 0 0 0 0</pose></waypoint></trajectory></script></actor>""")
    )
    assert not list(found)
    (ann,) = scene.world.actors
    assert (ann.name, ann.skin, ann.skin_scale, ann.loop, ann.delay_start) == ("ann", "walk.dae", 2, False, 3)
    assert [(a.name, a.interpolate_x) for a in ann.animations] == [("walk", True)]
    (way,) = ann.trajectories
    assert (way.id, way.type) == (4, "walk")
    assert [(p.time, at(p.pose)) for p in way.waypoints] == [(0, (0, 0, 0)), (2, (1, 0, 0))]


SAVED = """<model name="m"><link name="l"/></model><model name="gone"><link name="l"/></model>
  <light name="lamp" type="point"/><state world_name="w"><sim_time>1 0</sim_time>
  <model name="m"><pose>1 2 3 0 0 0</pose><link name="l"><pose>1 2 4 0 0 0</pose></link></model>
  <light name="lamp"><pose>0 0 9 0 0 0</pose></light><deletions><name>gone</name></deletions>
  <insertions><model name="late"><link name="l"/></model></insertions></state>"""


def test_a_saved_state_moves_adds_and_removes_models(load):
    scene, found = load(world(SAVED, "1.6"))
    assert {d.severity for d in found} == {"note"}
    w = scene.world
    assert [m.name for m in w.models] == ["m", "late"]
    assert at(w.models[0].pose_world) == (1, 2, 3) and at(w.models[0].links[0].pose_world) == (1, 2, 4)
    assert at(w.lights[0].pose_world) == (0, 0, 9)


def test_unapplied_parts_of_a_saved_state_are_reported(load):
    _, found = load(
        world(
            """<model name="m"><link name="a"/><link name="b"/>
          <joint name="j" type="prismatic"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint>
          </model><state world_name="w"><model name="m"><pose>0 0 1 0 0 0</pose>
          <link name="a"><pose>0 0 1 0 0 0</pose></link>
          <link name="b"><pose>0 0 2 0 0 0</pose><velocity>0 0 1 0 0 0</velocity></link></model>
          <model name="mm"/></state><state world_name="other"/>""",
            "1.6",
        )
    )
    expected_text = [d.message for d in found if d.code == "SK-SDF-034"]
    assert len(expected_text) == 4
    assert (
        "'other'" in expected_text[0]
        and "'mm'" in expected_text[1]
        and "saved poses of b" in expected_text[2]
        and "velocities" in expected_text[3]
    )


def test_surroundings_are_read_with_their_defaults(load):
    empty = load(world(""))[0].world
    assert (empty.wind, empty.atmosphere.temperature, empty.atmosphere.pressure) == ((0, 0, 0), 288.15, 101325)
    assert empty.atmosphere.temperature_gradient == -0.0065
    scene, found = load(
        world("""<wind><linear_velocity>1 2 3</linear_velocity></wind><atmosphere type="adiabatic">
          <temperature>300</temperature><temperature_gradient>-0.01</temperature_gradient><pressure>1e5</pressure>
          </atmosphere><magnetic_field>1 2 3</magnetic_field><spherical_coordinates>
          <surface_model>CUSTOM_SURFACE</surface_model><surface_axis_equatorial>5</surface_axis_equatorial>
          <surface_axis_polar>4</surface_axis_polar><latitude_deg>45</latitude_deg><heading_deg>90</heading_deg>
          </spherical_coordinates>""")
    )
    assert not found
    w, coordinates = scene.world, scene.world.spherical_coordinates
    assert (w.wind, w.magnetic_field, w.atmosphere.temperature) == ((1, 2, 3), (1, 2, 3), 300)
    assert (coordinates.surface, coordinates.equatorial, coordinates.polar) == ("CUSTOM_SURFACE", 5, 4)
    assert (coordinates.latitude, coordinates.heading) == pytest.approx((math.pi / 4, math.pi / 2))


@pytest.mark.parametrize(
    ("text", "expected_text"),
    [
        ("<surface_model>EARTH_WSG84</surface_model>", "did you mean 'EARTH_WGS84'?"),
        ("<surface_model>CUSTOM_SURFACE</surface_model>", "needs <surface_axis_equatorial>"),
        ("<latitude_deg>91</latitude_deg>", "from -90 to 90"),
    ],
)
def test_invalid_spherical_coordinates_are_errors(load, text, expected_text):
    _, found = load(world(f"<spherical_coordinates>{text}</spherical_coordinates>"))
    assert any(expected_text in d.message + d.hint for d in found if d.severity == "error")


def test_the_update_rate_replaces_a_missing_real_time_factor(load):
    def factor(text: str) -> float:
        return load(world(f"<physics><max_step_size>0.002</max_step_size>{text}</physics>"))[0].world.physics

    assert factor("").real_time_factor == 1
    assert factor("<real_time_update_rate>250</real_time_update_rate>").real_time_factor == 0.5
    assert factor("<real_time_update_rate>0</real_time_update_rate>").real_time_factor == 0
    both = "<real_time_update_rate>250</real_time_update_rate><real_time_factor>2</real_time_factor>"
    assert factor(both).real_time_factor == 2
    assert factor("<max_contacts>7</max_contacts>").max_contacts == 7


def test_a_light_without_a_type_is_a_point_light_with_a_warning(load):
    scene, found = load('<sdf version="1.9"><world name="w">\n<light name="lamp"/></world></sdf>')
    assert scene.worlds[0].lights[0].type == "point"
    assert [(d.code, d.severity, d.line) for d in found] == [("SK-SDF-039", "warning", 2)]


def test_a_world_has_no_model_frame(load):
    _, found = load(
        '<sdf version="1.9"><world name="w"><model name="m">\n<pose relative_to="__model__">1 0 0 0 0 0</pose>'
        '<link name="l"/></model></world></sdf>'
    )
    assert [(d.code, d.severity, d.line) for d in found if d.severity == "error"] == [("SK-SDF-004", "error", 2)]
