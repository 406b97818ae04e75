"""The material scripts that come with Gazebo: their colours, by name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from simkit.scene.model import Colour


@dataclass(frozen=True, slots=True)
class ScriptColours:
    """Colours of one material script, RGBA from 0 to 1; `diffuse` carries the opacity."""

    ambient: Colour
    diffuse: Colour
    specular: Colour = (0.0, 0.0, 0.0, 1.0)
    emissive: Colour = (0.0, 0.0, 0.0, 1.0)


# Each row: names; ambient; diffuse; specular; emissive; opacity. One number stands for three equal ones.
# Of a textured material the diffuse colour is the mean of its picture, which is not part of this table.
_ROWS: Final = """
Grey Gray; .3; .7; .01
DarkGrey DarkGray; .175; .175; .175
LightGrey LightGray; .85; .85
White; 1; 1; .1
FlatBlack; .1; .1; .01
Black; 0; 0; .1
Red; 1 0 0; 1 0 0; .1
RedBright; .87 .26 .07; .87 .26 .07; .87 .26 .07
DarkRed; .6 .1 .1; .6 .1 .1; .1
Green; 0 1 0; 0 1 0; .1
DarkGreen; .1 .5 .1; .1 .5 .1; .1
Blue; 0 0 1; 0 0 1; .1
SkyBlue; .13 .44 .7; 0 0 1; .1
DarkBlue; .1 .1 .6; .1 .1 .6; .1
Yellow; 1 1 0; 1 1 0; 0
DarkYellow; .7 .7 0; .7 .7 0; 0
ZincYellow; .9725 .9529 .2078; .9725 .9529 .2078; .9725 .9529 .2078
Orange; 1 .5088 .0468; 1 .5088 .0468; .5
DarkOrange; .9 .4 0; .9 .4 0; .1
Purple; 1 0 1; 1 0 1; .1
DarkMagenta; .5 .1 .5; .5 .1 .5; .1
Turquoise; 0 1 1; 0 1 1; .1
Indigo; .33 0 .5; .33 0 .5; .1
Brown; .45 .3 .15; .45 .3 .15; .1
Gold; .4 .24869 .020759; .8 .648690 .120759; .4
Chrome; .25; .75; .75
WhiteGlow; 1; 1; .1; 1
RedGlow; 1 0 0; 1 0 0; 1 0 0; 1 0 0
GreenGlow; 0 1 0; 0 1 0; .1; 0 1 0
BlueGlow; 0 0 1; 0 0 1; .1; 0 0 1
YellowGlow; 1 1 0; 1 1 0; 0; 1 1 0
PurpleGlow; 1 0 1; 1 0 1; .1; 1 0 1
TurquoiseGlow TurquoiseGlowOutline; 0 1 1; 0 1 1; .1; 0 1 1
RedTransparent RedTransparentOverlay; 1 0 0; 1 0 0; 0; 0; .5
GreenTransparent GreenTransparentOverlay TransparentGreen; 0 1 0; 0 1 0; 0; 0; .5
BlueTransparent BlueTransparentOverlay; 0 0 1; 0 0 1; 0; 0; .5
BlackTransparent; 0; 0; 0; 0; .5
GreyTransparent GrayTransparent; .5; .5; 0; 0; .5
YellowTransparent; 1 1 0; 1 1 0; 0; 0; .5
OrangeTransparent; 1 .44 0; 1 .44 0; 0; 0; .4
BlueLaser; 0 0 1; 0 0 1; 0; 0; .4
LightOn; 0 1 0; 0 1 0; 0; 0 1 0
LightOff; 1 0 0; 1 0 0; 0; 1 0 0
JointAnchor; 1; 1; 1; 1
Wood; 1; .62 .45 .28; .2
WoodPallet; .5; .6 .47 .32; 0
WoodFloor; .5; .55 .38 .22
Bricks; 1; .6 .36 .29; .2
WindowFrame; 1; .8; .2
CeilingTiled; .5; .85 .85 .83
PaintedWall; 1; .85 .83 .78
PioneerBody; .5 0 0; .7 .06 .06; .5 0 0
Pioneer2Body; .481193 .000123 .000123; .681193 .000923 .000923; .5
Road; .1; .3; .01
Residential Tertiary; .1; .35; .01
Pedestrian Footway; .1; .55 .54 .52; .01
Motorway Lanes_6 Trunk Lanes_4 Primary Lanes_2 Secondary Lane_1; .1; .35; .01
Steps; .1; .55; .01
Runway; .1; .35; .01
Grass GrassFloor; .2; .3 .45 .2
Asphalt; .25; .25
Rockwall; .5; .5 .47 .43
Gravel; .5; .52 .5 .47
Mud; .3; .36 .27 .18
OmniWheel; .3; .3
Pr2/Body; 1; 1
GreyGradientSky; .6; .6; 0; .6
CloudySky; .6; .55 .68 .85; 0; .55 .68 .85
"""


def _table() -> dict[str, ScriptColours]:
    table = {}
    for row in _ROWS.strip().splitlines():
        names, *columns = (column.strip() for column in row.split(";"))
        opacity = float(columns.pop()) if len(columns) == 5 else 1.0
        colours: list[Colour] = []
        for column in columns:
            numbers = [float(v) for v in column.split()]
            r, g, b = numbers if len(numbers) == 3 else numbers * 3
            colours.append((r, g, b, 1.0))
        colours[1] = (*colours[1][:3], opacity)
        for name in names.split():
            table[name] = ScriptColours(*colours)
    return table


GAZEBO_MATERIALS: Final = _table()
"""By the name behind `Gazebo/`."""

GAZEBO_COLOURS: Final[dict[str, Colour]] = {name: colours.diffuse for name, colours in GAZEBO_MATERIALS.items()}
"""Diffuse colours (red, green, blue, alpha) by the name behind `Gazebo/`."""


def gazebo_material(name: str) -> ScriptColours | None:
    """The colours of a material that comes with Gazebo, by its full name; None where there is none."""
    return GAZEBO_MATERIALS.get(name.removeprefix("Gazebo/")) if name else None
