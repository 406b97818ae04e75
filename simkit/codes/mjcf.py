"""Worlds and models in MuJoCo's own format."""

from __future__ import annotations

from simkit.codes import Code, Example

_BALL = '<geom size="0.1"/>'


def _mjcf(content: str, files: dict[str, str | bytes] | None = None) -> Example:
    return Example(f'<mujoco model="robot">\n{content}\n</mujoco>\n', suffix=".xml", files=files or {})


def _body(content: str, rest: str = "") -> Example:
    return _mjcf(f'  <worldbody>\n    <body name="base">{content}</body>\n  </worldbody>\n{rest}')


def _included(model: str, around: str = "") -> Example:
    """A world in SDF that includes `robot.xml`."""
    start = "<include merge='true'>" if around == "merge" else "<include>"
    return Example(
        f'<sdf version="1.9"><world name="w">\n  {start}<uri>robot.xml</uri>'
        f"{around if around != 'merge' else ''}</include>\n</world></sdf>\n",
        files={"robot.xml": f"<mujoco model='robot'>\n{model}\n</mujoco>\n"},
    )


CODES: tuple[Code, ...] = (
    Code(
        "SK-MJCF-001",
        "error",
        "MuJoCo refuses the file; its own words follow, the line is that of the user's file",
        "for a name that does not exist the closest one is shown",
        _body(_BALL + '<joint name="hinge"/>', '  <actuator><motor joint="hnige"/></actuator>'),
    ),
    Code(
        "SK-MJCF-002",
        "error",
        "MJCF has no such element in this place",
        "the closest name is shown, or where the element belongs",
        _body('<goem size="0.1"/>'),
    ),
    Code(
        "SK-MJCF-003",
        "error",
        "an element of MJCF has no such attribute",
        "the closest name is shown",
        _body('<geom sise="0.1"/>'),
    ),
    Code(
        "SK-MJCF-004",
        "error",
        "a number of an MJCF file is NaN or infinite",
        "leave the attribute out where there is no limit",
        _body('<geom size="nan"/>'),
    ),
    Code(
        "SK-MJCF-005",
        "error",
        "an MJCF file asks for more than memory or time allow",
        "",
        _mjcf('  <asset><hfield name="hills" nrow="100000" ncol="100000" size="1 1 1 1"/></asset>'),
    ),
    Code(
        "SK-MJCF-006",
        "error",
        "a file that an MJCF file includes or attaches cannot be used: it is included twice, or in a circle, or empty",
        "",
        _mjcf(
            '  <include file="part.xml"/>\n  <include file="part.xml"/>', {"part.xml": "<mujoco><worldbody/></mujoco>"}
        ),
    ),
    Code(
        "SK-MJCF-007",
        "error",
        "a mesh, texture or height field of an MJCF file cannot be used",
        "MuJoCo reads STL (binary), OBJ and MSH meshes and PNG textures",
        _mjcf('  <asset><mesh file="hull.stl"/></asset>', {"hull.stl": b"too short"}),
    ),
    Code(
        "SK-MJCF-008",
        "warning",
        "MuJoCo warns of something in the file",
        "",
        _mjcf('  <statistic meaninertia="1"/>\n  <worldbody><geom type="plane" size="1 1 1"/></worldbody>'),
    ),
    Code(
        "SK-MJCF-009",
        "note, warning",
        "a model in MJCF asks for settings of the engine that are not those of the world; the world's stand "
        "(a warning where they are part of what the model means: gravity, wind, density, viscosity, flags)",
        "set them in the world, or load the file as a world of its own",
        _included(f'<option timestep="0.005"/><worldbody><body>{_BALL}</body></worldbody>'),
    ),
    Code(
        "SK-MJCF-010",
        "note",
        "elements of an MJCF file that work in MuJoCo alone: they are in `mj_model` and `mj_data`",
        "",
        _body(_BALL + '<site name="s"/>', '  <sensor><gyro site="s"/></sensor>'),
    ),
    Code(
        "SK-MJCF-011",
        "note",
        "the lights of an MJCF file's own world are left out when it is a model in another",
        "",
        _included(f'<worldbody><light pos="0 0 3"/><body>{_BALL}</body></worldbody>'),
    ),
    Code(
        "SK-MJCF-012",
        "note, warning",
        "the base of a model in MJCF is not as the file has it: static, fixed or floating by the caller's wish",
        "",
        _included(
            f"<worldbody><body><freejoint/>{_BALL}</body></worldbody>", "<name>statue</name><static>true</static>"
        ),
    ),
    Code(
        "SK-MJCF-013",
        "note",
        "geoms of a model in MJCF have a priority: their friction counts, not the smaller one of the two",
        "leave `priority` out, and the smaller one counts",
        _included('<worldbody><body><geom size="0.1" priority="1"/></body></worldbody>'),
    ),
    Code(
        "SK-MJCF-014",
        "error",
        "the length ranges of muscles cannot be found by pulling the model, or not in time",
        "give each muscle its `lengthrange`, or limit its joint or tendon and set `<lengthrange uselimit='true'/>`",
        _body(_BALL + '<joint name="hinge"/>', '  <actuator><muscle joint="hinge"/></actuator>'),
    ),
    Code(
        "SK-MJCF-015",
        "error",
        "an include merges a model in MJCF, or changes it with `experimental:params`: it stays a model of its own",
        "include it without `merge` and without changes",
        _included(f"<worldbody><body>{_BALL}</body></worldbody>", "merge"),
    ),
)
