"""How pictures look: fog, lights, and processes that cannot draw."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import python, world

_CAMERA = "<camera><image><width>32</width><height>24</height></image></camera>"
_FORKING = """
import multiprocessing

import simkit

def drive(out):
    with simkit.load("camera.sdf") as sim:
        sim.run(0.1)
        try:
            sim.sensor("m::l::eye").latest
        except simkit.RenderError as error:
            out.put(str(error))

with simkit.load("camera.sdf") as sim:
    sim.run(0.1)
    sim.sensor("m::l::eye").latest
    context = multiprocessing.get_context("fork")
    out = context.Queue()
    context.Process(target=drive, args=(out,)).start()
    print(out.get())
"""
_EYE = (
    '<sdf version="1.9"><world name="w"><model name="m"><static>true</static><link name="l">'
    f'<sensor name="eye" type="camera"><always_on>true</always_on><update_rate>20</update_rate>{_CAMERA}</sensor>'
    "</link></model></world></sdf>\n"
)
_LAMP = (
    '<light name="lamp{0}" type="{1}">\n  <pose>{0} 0 3 0 0 0</pose>\n'
    "  <attenuation><range>{2}</range><constant>{3}</constant><linear>0.1</linear></attenuation>\n  {4}\n</light>"
)


def _lamp(number: int, kind: str = "point", reach: str = "100", constant: str = "1", more: str = "") -> str:
    return _LAMP.format(number, kind, reach, constant, more)


CODES: tuple[Code, ...] = (
    Code(
        "SK-RENDER-010",
        "warning",
        "a type of fog that is not drawn",
        "`linear`, `exp` or `exp2`, as Gazebo Classic draws them",
        world("<scene><fog><type>constant</type><density>0.1</density></fog></scene>"),
    ),
    Code(
        "SK-RENDER-011",
        "warning",
        "a forked process cannot draw, because its parent had drawn; its cameras are switched off",
        "multiprocessing's `spawn` or `forkserver`, or a fork before the first picture",
        python(_FORKING, {"camera.sdf": _EYE}),
    ),
    Code(
        "SK-RENDER-012",
        "note",
        "more lights shine than a picture has",
        "each camera gets the ones that give it most; fewer lights, or a brighter `<ambient>`",
        world("\n".join(_lamp(number) for number in range(8))),
    ),
    Code(
        "SK-RENDER-013",
        "note",
        "a lamp still shines at its range; Gazebo ends it there, in pictures it fades on",
        "an attenuation that has faded it by then",
        world(_lamp(1, reach="5", constant="0.5")),
    ),
    Code(
        "SK-RENDER-014",
        "note",
        "a point light throws no shadows",
        "a spot, or a directional light",
        world("<scene><quality>gazebo</quality></scene>\n" + _lamp(1, more="<cast_shadows>true</cast_shadows>")),
    ),
)
