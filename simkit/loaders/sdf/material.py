"""`<material>`: colours, the names of Gazebo's material scripts, and albedo textures."""

from __future__ import annotations

import math
from pathlib import Path

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.workspace import SdfFile, Workspace
from simkit.params import Params
from simkit.scene import Material
from simkit.scene.model import Colour

_WHITE: Colour = (1.0, 1.0, 1.0, 1.0)

# Diffuse colours (red, green, blue, alpha) of the materials that come with Gazebo; for a textured one its mean colour.
GAZEBO_COLOURS: dict[str, Colour] = {
    "Grey": (0.7, 0.7, 0.7, 1.0),
    "Gray": (0.7, 0.7, 0.7, 1.0),
    "DarkGrey": (0.175, 0.175, 0.175, 1.0),
    "DarkGray": (0.175, 0.175, 0.175, 1.0),
    "LightGrey": (0.85, 0.85, 0.85, 1.0),
    "White": _WHITE,
    "FlatBlack": (0.1, 0.1, 0.1, 1.0),
    "Black": (0.0, 0.0, 0.0, 1.0),
    "Red": (1.0, 0.0, 0.0, 1.0),
    "RedBright": (0.87, 0.26, 0.07, 1.0),
    "DarkRed": (0.6, 0.1, 0.1, 1.0),
    "Green": (0.0, 1.0, 0.0, 1.0),
    "DarkGreen": (0.1, 0.5, 0.1, 1.0),
    "Blue": (0.0, 0.0, 1.0, 1.0),
    "SkyBlue": (0.13, 0.44, 0.7, 1.0),
    "DarkBlue": (0.1, 0.1, 0.6, 1.0),
    "Yellow": (1.0, 1.0, 0.0, 1.0),
    "DarkYellow": (0.7, 0.7, 0.0, 1.0),
    "ZincYellow": (0.97, 0.95, 0.21, 1.0),
    "Orange": (1.0, 0.5088, 0.0468, 1.0),
    "DarkOrange": (0.9, 0.4, 0.0, 1.0),
    "Purple": (1.0, 0.0, 1.0, 1.0),
    "DarkMagenta": (0.5, 0.1, 0.5, 1.0),
    "Turquoise": (0.0, 1.0, 1.0, 1.0),
    "Indigo": (0.33, 0.0, 0.5, 1.0),
    "Gold": (0.8, 0.6, 0.1, 1.0),
    "Brown": (0.45, 0.3, 0.15, 1.0),
    "WhiteGlow": _WHITE,
    "GreenGlow": (0.0, 1.0, 0.0, 1.0),
    "RedGlow": (1.0, 0.0, 0.0, 1.0),
    "BlueGlow": (0.0, 0.0, 1.0, 1.0),
    "YellowGlow": (1.0, 1.0, 0.0, 1.0),
    "PurpleGlow": (1.0, 0.0, 1.0, 1.0),
    "TurquoiseGlowOutline": (0.0, 1.0, 1.0, 1.0),
    "RedTransparent": (1.0, 0.0, 0.0, 0.5),
    "GreenTransparent": (0.0, 1.0, 0.0, 0.5),
    "BlueTransparent": (0.0, 0.0, 1.0, 0.5),
    "YellowTransparent": (1.0, 1.0, 0.0, 0.5),
    "OrangeTransparent": (1.0, 0.44, 0.0, 0.5),
    "BlackTransparent": (0.0, 0.0, 0.0, 0.5),
    "Wood": (0.62, 0.45, 0.28, 1.0),
    "WoodPallet": (0.6, 0.47, 0.32, 1.0),
    "WoodFloor": (0.55, 0.38, 0.22, 1.0),
    "Bricks": (0.6, 0.36, 0.29, 1.0),
    "CeilingTiled": (0.85, 0.85, 0.83, 1.0),
    "PaintedWall": (0.85, 0.83, 0.78, 1.0),
    "Road": (0.3, 0.3, 0.3, 1.0),
    "Residential": (0.35, 0.35, 0.35, 1.0),
    "Pedestrian": (0.55, 0.54, 0.52, 1.0),
    "Grass": (0.3, 0.45, 0.2, 1.0),
    "Asphalt": (0.25, 0.25, 0.25, 1.0),
    "Rockwall": (0.5, 0.47, 0.43, 1.0),
    "Gravel": (0.52, 0.5, 0.47, 1.0),
    "Mud": (0.36, 0.27, 0.18, 1.0),
    "Chrome": (0.75, 0.75, 0.75, 1.0),
    "PioneerBody": (0.7, 0.06, 0.06, 1.0),
    "Pioneer2Body": (0.7, 0.06, 0.06, 1.0),
    "GrassFloor": (0.3, 0.45, 0.2, 1.0),
    "Pr2/Body": _WHITE,
    "OmniWheel": (0.3, 0.3, 0.3, 1.0),
    "Runway": (0.35, 0.35, 0.35, 1.0),
}


def read_material(visual: Params, file: SdfFile, workspace: Workspace) -> Material | None:
    """How a visual looks; None where it says nothing."""
    block = visual.child("material")
    if block is None:
        return None
    script = block.block("script")
    name = script.text("name", "") or (script.value.split("/", 1)[1] if "/" in script.value else "")
    script.all("uri")
    from_script = _script_colour(name)
    diffuse = read_colour(block, "diffuse", from_script or _WHITE)
    default_ambient = diffuse if from_script is None else from_script
    texture = _texture(block, file, workspace)
    if name and from_script is None and not block.has("diffuse") and texture is None:
        _unknown(name, script, workspace)
    return Material(
        ambient=read_colour(block, "ambient", default_ambient),
        diffuse=diffuse,
        specular=read_colour(block, "specular", (0.0, 0.0, 0.0, 1.0)),
        emissive=read_colour(block, "emissive", (*diffuse[:3], 1.0) if "Glow" in name else (0.0, 0.0, 0.0, 1.0)),
        texture=texture,
        script=name,
    )


def _unknown(name: str, script: Params, workspace: Workspace) -> None:
    """One note for each name, however often it is used."""
    if name not in workspace.unknown_materials:
        workspace.unknown_materials.add(name)
        hint = did_you_mean(name.removeprefix("Gazebo/"), GAZEBO_COLOURS)
        workspace.diagnostics.note("SK-SDF-021", f"material {name!r} is not known and drawn white", script.where, hint)


def _script_colour(name: str) -> Colour | None:
    return GAZEBO_COLOURS.get(name.removeprefix("Gazebo/")) if name else None


def read_colour(block: Params, name: str, default: Colour) -> Colour:
    """The colour of a child element, each channel clamped to 0..1; a bad text is an error."""
    found = block.child(name)
    if found is None or not found.value:
        return default
    try:
        numbers = [float(v) for v in found.value.split()]
    except ValueError:
        numbers = []
    if len(numbers) not in (3, 4) or any(math.isnan(v) for v in numbers):
        found.error("SK-PARAM-002", f"found <{name}>{found.value}</{name}>, allowed is red green blue [alpha]")
        return default
    r, g, b, a = (min(1.0, max(0.0, v)) for v in (*numbers, 1.0)[:4])
    return (r, g, b, a)


def _texture(block: Params, file: SdfFile, workspace: Workspace) -> Path | None:
    workflows = [w for name in ("metal", "specular") for w in block.block("pbr").all(name)]
    for workflow in workflows:
        found = workflow.child("albedo_map")
        if found is None or not found.value:
            continue
        path, _ = workspace.resolver.search(found.value, file.folder)
        if path is None or not path.is_file():
            workspace.diagnostics.warning(
                "SK-URI-006", f"texture {found.value} is not found; drawn without it", found.where
            )
            continue
        return path.absolute()
    return None
