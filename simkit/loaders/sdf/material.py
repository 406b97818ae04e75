"""Reader of `<material>`: colours, Gazebo's material scripts and those of other models, and albedo textures."""

from __future__ import annotations

import math
from pathlib import Path

from simkit.diagnostics import closest, did_you_mean
from simkit.loaders.resources.uri_resolver import download_hint
from simkit.loaders.sdf.gazebo_materials import gazebo_colours, gazebo_materials
from simkit.loaders.sdf.load_context import SdfFile, Workspace
from simkit.loaders.sdf.material_script import OgreMaterial, find_material, find_texture
from simkit.params import Params
from simkit.scene import Material
from simkit.scene.model import Colour

_WHITE: Colour = (1.0, 1.0, 1.0, 1.0)
_BLACK: Colour = (0.0, 0.0, 0.0, 1.0)


def read_material(visual: Params, file: SdfFile, workspace: Workspace) -> Material | None:
    """Return the appearance of a visual; None if the visual has no `<material>`.

    Values in the element itself take precedence over those of its script.
    """
    block = visual.child("material")
    if block is None:
        return None
    script = block.block("script")
    name = script.text("name", "") or (script.value.split("/", 1)[1] if "/" in script.value else "")
    if name == "__default__":  # SDF's text for an element without a value, which tools write into saved worlds
        name = ""
    ogre, places = _script_material(name, script, file, workspace)
    script_colours = _script_colours(name, ogre)
    diffuse = read_colour(block, "diffuse", script_colours.get("diffuse", _WHITE))
    ambient = read_colour(block, "ambient", script_colours.get("ambient", diffuse))
    workflow = _workflow(block)
    texture, scale = _texture(workflow, file, workspace), (1.0, 1.0)
    if texture is None and ogre is not None and ogre.texture:
        texture, scale = find_texture(ogre, places, workspace.resolver.allows), ogre.scale or scale
        if texture is None:
            _report_missing_texture(f"texture {ogre.texture} of material {name!r}", script, workspace)
    if name and not script_colours and ogre is None and not block.has("diffuse") and texture is None:
        _report_unknown_script(name, script, workspace)
    has_roughness = _has_content(workflow, "roughness")
    roughness = workflow.number("roughness", minimum=0.0, maximum=1.0) if has_roughness else None
    return Material(
        ambient=ambient,
        diffuse=diffuse,
        specular=read_colour(block, "specular", script_colours.get("specular", _BLACK)),
        emissive=read_colour(block, "emissive", script_colours.get("emissive", _BLACK)),
        texture=texture,
        script=name,
        roughness=roughness,
        double_sided=block.boolean("double_sided", ogre.is_double_sided if ogre is not None else False),
        texture_scale=scale,
        shininess=block.number("shininess", minimum=0.0) if _has_content(block, "shininess") else None,
    )


def read_transparency(block: Params, default: float = 0.0) -> float:
    """Return the transparency of a visual; a number outside 0 to 1 is limited with a warning, as in Gazebo."""
    value = block.number("transparency", default)
    limited = min(1.0, max(0.0, value))
    if value != limited:
        text = f"found <transparency>{value:g}</transparency>; expected a number from 0 to 1; {limited:g} is used"
        block.child_or_self("transparency").warning("SK-PARAM-008", text)
    return limited


def _has_content(block: Params, name: str) -> bool:
    element = block.child(name)
    return element is not None and bool(element.value)


def _script_material(
    name: str, script: Params, file: SdfFile, workspace: Workspace
) -> tuple[OgreMaterial | None, list[Path]]:
    """Return the material of that name in the script files that the visual refers to, and their paths."""
    # Gazebo's own scripts are identified by name, in the table of gazebo_materials.py; other projects have such folders
    is_of_gazebo = bool(gazebo_colours(name))
    uris = [e.value for e in script.all("uri") if e.value and not (is_of_gazebo and "media/materials" in e.value)]
    places = [place for uri in uris if (place := workspace.resolver.search(uri, file.folder)[0]) is not None]
    material = find_material(name, places, workspace.resolver.allows) if name and places else None
    return material, places


def _script_colours(name: str, ogre: OgreMaterial | None) -> dict[str, Colour]:
    if ogre is not None:
        colours = {"diffuse": _WHITE, **ogre.colours}
        if not ogre.is_transparent:
            colours["diffuse"] = (*colours["diffuse"][:3], 1.0)
        return colours
    return gazebo_colours(name)


def _report_unknown_script(name: str, script: Params, workspace: Workspace) -> None:
    """Record one note for each unknown name, even if several visuals use it."""
    if name not in workspace.unknown_materials:
        workspace.unknown_materials.add(name)
        near = closest(name.removeprefix("Gazebo/"), gazebo_materials())
        hint = did_you_mean(name, [f"Gazebo/{near}"]) if near else ""
        workspace.diagnostics.note("SK-SDF-021", f"unknown material {name!r}; it is drawn white", script.where, hint)


def read_colour(block: Params, name: str, default: Colour) -> Colour:
    """Return the colour of a child element, with each channel limited to 0..1; an invalid text is an error."""
    colour = block.child(name)
    if colour is None or not colour.value:
        return default
    try:
        numbers = [float(v) for v in colour.value.split()]
    except ValueError:
        numbers = []
    if len(numbers) not in (3, 4) or any(map(math.isnan, numbers)):
        colour.error("SK-PARAM-002", f"found <{name}>{colour.value}</{name}>; expected red green blue [alpha]")
        return default
    r, g, b, a = [min(1.0, max(0.0, v)) for v in (*numbers, 1.0)[:4]]
    return (r, g, b, a)


def _workflow(block: Params) -> Params:
    """Return the first block of `<pbr>` with a texture, else the first block; `<metal>` precedes `<specular>`."""
    pbr = block.block("pbr")
    workflows = [*pbr.all("metal"), *pbr.all("specular")]
    with_texture = [w for w in workflows if _has_content(w, "albedo_map")]
    return (with_texture or workflows or [Params("metal", where=block.where, diagnostics=block.diagnostics)])[0]


def _texture(workflow: Params, file: SdfFile, workspace: Workspace) -> Path | None:
    texture = workflow.child("albedo_map")
    if texture is None or not texture.value:
        return None
    path, _ = workspace.resolver.search(texture.value, file.folder)
    if path is not None and path.is_file():
        return path.absolute()
    if workspace.resolver.refused is not None:
        _report_refused_texture(texture.value, texture, workspace.resolver.refused, workspace)
    else:
        _report_missing_texture(f"texture {texture.value}", texture, workspace)
    return None


def _report_refused_texture(uri: str, element: Params, path: Path, workspace: Workspace) -> None:
    if uri not in workspace.reported:
        workspace.reported.add(uri)
        trusted = workspace.resolver.trusted
        message = f"texture {uri}: {trusted.refusal(path)}; the visual is drawn without the texture"
        workspace.diagnostics.warning("SK-URI-003", message, element.where, trusted.help(path))


def _report_missing_texture(what: str, element: Params, workspace: Workspace) -> None:
    """Record one warning for each missing texture, even if several visuals use it."""
    if what not in workspace.reported:
        workspace.reported.add(what)
        message = f"{what} is not found; the visual is drawn without the texture"
        hint = download_hint(element.value, element.where)
        workspace.diagnostics.warning("SK-URI-006", message, element.where, hint)
