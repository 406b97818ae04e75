"""Air and water: wind, wings, buoyancy."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import INERTIAL, world

_BALL = (
    f'<model name="ball">\n  <link name="body">\n    {INERTIAL}\n'
    '    <collision name="hull"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>\n'
    "  </link>\n</model>\n"
)
_OPEN = "o x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n"


def _wing(parameters: str) -> Example:
    """A model of one link with lift and drag."""
    return world(
        f'<model name="plane">\n  <link name="wing">{INERTIAL}</link>\n'
        '  <plugin filename="gz-sim-lift-drag-system" name="gz::sim::systems::LiftDrag">\n'
        f"    <link_name>wing</link_name>\n    {parameters}\n  </plugin>\n</model>"
    )


def _water(parameters: str, model: str = _BALL, files: dict[str, str | bytes] | None = None) -> Example:
    """A world under water with one model."""
    plugin = '<plugin filename="gz-sim-buoyancy-system" name="gz::sim::systems::Buoyancy">'
    return world(f"{model}{plugin}\n  {parameters}\n</plugin>", files=files)


CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-110",
        "error",
        "`<forward>` and `<upward>` of a wing point along one line; lift has no direction",
        "two directions at right angles",
        _wing("<forward>0 0 1</forward>"),
    ),
    Code(
        "SK-PLUGIN-111",
        "warning",
        "a setting of wind, a wing or a fluid that has no effect, in Gazebo neither",
        "",
        _water(
            "<uniform_fluid_density>1000</uniform_fluid_density>\n"
            "  <graded_buoyancy><default_density>1025</default_density></graded_buoyancy>"
        ),
    ),
    Code(
        "SK-PLUGIN-112",
        "warning",
        "a collision whose mesh is open encloses nothing that could float; its convex hull floats instead",
        "close the mesh, or give the collision a plain shape",
        _water(
            "<uniform_fluid_density>1000</uniform_fluid_density>",
            _BALL.replace("<sphere><radius>0.1</radius></sphere>", "<mesh><uri>open.obj</uri></mesh>"),
            {"open.obj": _OPEN},
        ),
    ),
    Code(
        "SK-PLUGIN-113",
        "warning",
        "`<enable>` of a buoyancy plugin names no model or link that is there; it is waited for",
        "scoped names without the world's: `ship`, `ship::hull`",
        _water("<uniform_fluid_density>1000</uniform_fluid_density>\n  <enable>boll</enable>"),
    ),
    Code(
        "SK-PLUGIN-114",
        "warning",
        "a buoyancy plugin that says nothing of the fluid; water of 1000 kg/m³ is everywhere",
        "`<uniform_fluid_density>` or `<graded_buoyancy>`",
        _water(""),
    ),
)
