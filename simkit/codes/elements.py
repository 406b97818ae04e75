"""Elements of SDF that cannot be used as they are."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, joint, link, model, sdf, shape, surface, world

_AXIS = "<axis><xyz>0 0 1</xyz></axis>"

CODES: tuple[Code, ...] = (
    Code("SK-SDF-001", "error", "an element needs a name", "", world("<model><link name='base'/></model>")),
    Code("SK-SDF-002", "error", "two siblings have one name", "", model('<link name="base"/>\n<link name="base"/>')),
    Code(
        "SK-SDF-003",
        "error, warning",
        "a reserved name: `__x__`, `world`, or one with `::`",
        "",
        model('<link name="__base__"/>'),
    ),
    Code(
        "SK-SDF-004",
        "error",
        "a frame, link or joint that is named does not exist",
        "the closest name is given",
        model(
            '<link name="base"/>\n<link name="arm"/>\n'
            f'<joint name="elbow" type="revolute"><parent>bsae</parent><child>arm</child>{_AXIS}</joint>'
        ),
    ),
    Code(
        "SK-SDF-005",
        "error",
        "poses or attachments go round in a circle",
        "",
        model(
            '<link name="base"><pose relative_to="arm">1 0 0 0 0 0</pose></link>\n'
            '<link name="arm"><pose relative_to="base">1 0 0 0 0 0</pose></link>'
        ),
    ),
    Code("SK-SDF-006", "error", "a model without a link", "give it a `<link>`", model("")),
    Code(
        "SK-SDF-007",
        "error",
        "a joint that joins a link with itself",
        "",
        model(
            '<link name="base"/>\n'
            f'<joint name="elbow" type="revolute"><parent>base</parent><child>base</child>{_AXIS}</joint>'
        ),
    ),
    Code("SK-SDF-008", "error", "unknown joint type; those known are listed", "", joint(_AXIS, "revolut")),
    Code(
        "SK-SDF-009",
        "error, warning",
        "a size is not positive; or (a warning) a collision or visual has no `<geometry>`, and so no shape",
        "",
        shape("<sphere><radius>-0.1</radius></sphere>"),
    ),
    Code(
        "SK-SDF-010",
        "note",
        "settings of Gazebo's that have no effect here: solver, gui, …",
        "",
        world("<gui><camera name='user'/></gui>"),
    ),
    Code(
        "SK-SDF-011",
        "warning",
        "an element that is not known and not used",
        "the closest name is given",
        link('<colision name="hull"><geometry><sphere><radius>0.1</radius></sphere></geometry></colision>'),
    ),
    Code(
        "SK-SDF-012",
        "warning",
        "known, but not simulated: roads, image shapes, …",
        "",
        world('<road name="street"><width>4</width><point>0 0 0</point><point>10 0 0</point></road>'),
    ),
    Code(
        "SK-SDF-013",
        "error, warning",
        "a mass or a moment of inertia that is not positive",
        "check units and signs",
        model('<link name="base"><inertial><mass>-1</mass></inertial></link>'),
    ),
    Code(
        "SK-SDF-014",
        "warning",
        "an inertia that no solid has",
        "check units and signs",
        model(
            '<link name="base">\n  <inertial><mass>1</mass>'
            "<inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.5</izz></inertia></inertial>\n</link>"
        ),
    ),
    Code(
        "SK-SDF-015",
        "note",
        "links without `<inertial>`: SDF gives each 1 kg and 1 kg·m²",
        "give them an inertia, or make them a `<frame>`",
        model('<link name="base"/>'),
    ),
    Code(
        "SK-SDF-016",
        "error",
        "an include that cannot be taken: a circle, too deep, not one model, a wrong merge",
        "",
        world(
            "<include><uri>two.sdf</uri></include>",
            files={
                "two.sdf": sdf(
                    '<model name="a"><link name="l"/></model>\n<model name="b"><link name="l"/></model>'
                ).text
            },
        ),
    ),
    Code("SK-SDF-017", "error", "an axis of length zero", "", joint("<axis><xyz>0 0 0</xyz></axis>")),
    Code("SK-SDF-020", "error", "a sensor without a type", "", link('<sensor name="eye"/>')),
    Code(
        "SK-SDF-021",
        "note",
        "an unknown material script; drawn white",
        "",
        link(
            '<visual name="look">\n  <geometry><box><size>1 1 1</size></box></geometry>\n'
            "  <material><script><name>Gazebo/Yelow</name></script></material>\n</visual>"
        ),
    ),
    Code(
        "SK-SDF-022",
        "warning",
        "no inertia can be computed from the collisions",
        "",
        model('<link name="base"><inertial auto="true"/></link>'),
    ),
    Code(
        "SK-SDF-023",
        "note",
        "a second physics profile that is not used",
        'mark the one you want with `default="true"`',
        world('<physics name="fine" type="ode"/>\n<physics name="coarse" type="ode"/>'),
    ),
    Code(
        "SK-SDF-024",
        "warning",
        "a name stands for two things; the message says which is meant",
        "",
        model(
            f'<link name="base">{INERTIAL}</link>\n<link name="arm">{INERTIAL}</link>\n'
            f'<joint name="arm" type="revolute"><parent>base</parent><child>arm</child>{_AXIS}</joint>',
            "1.6",
        ),
    ),
    Code(
        "SK-SDF-025",
        "error",
        "a light of unknown type, or without a direction",
        "",
        world('<light name="lamp" type="spto"/>'),
    ),
    Code(
        "SK-SDF-026",
        "error, warning",
        "something required is missing",
        "",
        model('<link name="arm"/>\n<joint name="elbow" type="fixed"><child>arm</child></joint>'),
    ),
    Code(
        "SK-SDF-027",
        "warning",
        "a lower limit above the upper one; read as unlimited",
        "",
        joint("<axis><xyz>0 0 1</xyz><limit><lower>1</lower><upper>-1</upper></limit></axis>"),
    ),
    Code(
        "SK-SDF-028",
        "error",
        "more than one model in a file without a world",
        "put them into a `<world>`",
        sdf('<model name="a"><link name="l"/></model>\n<model name="b"><link name="l"/></model>'),
    ),
    Code(
        "SK-SDF-029",
        "warning",
        "a mass of zero",
        "",
        model('<link name="base"><inertial><mass>0</mass></inertial></link>'),
    ),
    Code(
        "SK-SDF-030",
        "warning",
        "a surface value that cannot be negative; the default is used",
        "",
        surface("<friction><ode><mu>-1</mu></ode></friction>"),
    ),
    Code(
        "SK-SDF-031",
        "note",
        "several worlds in a file; the first runs",
        "",
        sdf('<world name="day"/>\n<world name="night"/>'),
    ),
)
