"""Includes that change or merge models, populations, saved states, surroundings, and names nobody knows."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, model, sdf, world

_ARM = sdf(
    f'<model name="arm">\n  <link name="base">{INERTIAL}</link>\n</model>',
).text
_HOLDER = sdf(
    f'<model name="holder">\n  <static>true</static>\n  <link name="base">{INERTIAL}</link>\n</model>',
).text

CODES: tuple[Code, ...] = (
    Code(
        "SK-SDF-032",
        "error",
        "a change that `<experimental:params>` of an include cannot make",
        "`element_id` is the path of names from the included model to the element, `action` says what is done with it",
        world(
            '<include>\n  <uri>arm</uri>\n  <experimental:params>\n    <link element_id="bas" action="remove"/>\n'
            "  </experimental:params>\n</include>",
            files={"arm/model.sdf": _ARM},
        ),
    ),
    Code(
        "SK-SDF-033",
        "error",
        "a population that says no place for its models",
        "give it one `<model>`, a `<box>` or `<cylinder>`, and a known `<distribution>`",
        world(
            '<population name="cans">\n  <model name="can"><static>true</static><link name="body"/></model>\n'
            "  <model_count>3</model_count>\n  <distribution><type>random</type></distribution>\n</population>"
        ),
    ),
    Code(
        "SK-SDF-034",
        "warning",
        "a part of a saved `<state>` that is not applied: joint positions, velocities, scales, unknown names",
        "poses of models, lights and free links are applied",
        world('<state world_name="default">\n  <model name="gone"><pose>0 0 1 0 0 0</pose></model>\n</state>'),
    ),
    Code(
        "SK-SDF-035",
        "note",
        "settings of a merged model that are lost with it, as in Gazebo",
        "say them in the model that it becomes part of",
        model(
            f'<link name="own">{INERTIAL}</link>\n<include merge="true"><uri>holder</uri></include>',
            files={"holder/model.sdf": _HOLDER},
        ),
    ),
    Code(
        "SK-SDF-036",
        "error",
        "a kind of atmosphere or of planet that does not exist",
        "the closest name is given",
        world('<atmosphere type="isothermal"/>'),
    ),
    Code(
        "SK-SDF-037",
        "warning",
        "an attribute that is not known and not used",
        "the closest name is given",
        model(f'<link name="base" colour="red">{INERTIAL}</link>'),
    ),
    Code(
        "SK-SDF-038",
        "warning",
        "text where elements belong",
        "put it into the element that it is meant for",
        model(f'<link name="base">2.5 {INERTIAL}</link>'),
    ),
    Code(
        "SK-SDF-039",
        "warning",
        "a light without a type is taken as a point",
        "",
        world('<light name="lamp"/>'),
    ),
    Code(
        "SK-PARAM-006",
        "warning",
        "more numbers than are needed; the first are used, as Gazebo uses them",
        "",
        world("<gravity>0 0 -9.8 1</gravity>"),
    ),
)
