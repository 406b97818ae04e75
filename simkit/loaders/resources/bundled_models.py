"""Models and worlds that are part of simkit: bundled files, the selected TurtleBot3, the ground plane and the sun."""

from __future__ import annotations

import os
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.loaders.resources.model_folder import model_file
from simkit.packs import pack_folders

if TYPE_CHECKING:
    from collections.abc import Iterator

MODELS = ("burger", "waffle", "waffle_pi")
_URI = "model://turtlebot3"
_DEFAULT = "waffle"


@lru_cache(maxsize=1)
def _package_folder() -> Path:
    return Path(__file__).resolve().parents[2]


def bundled_folders(kind: str) -> list[Path]:
    """Return the folders `assets`, `worlds` or `labs` of simkit, inside the package and beside it, and of the packs."""
    package = _package_folder()
    of_core = [folder for folder in (package / kind, package.parent / kind) if folder.is_dir()]
    return of_core + [Path(folder) for folder in pack_folders(kind)]


def bundle_around(folder: Path) -> Path | None:
    """Return the folder `assets`, `worlds` or `labs` of simkit that contains a folder, or None."""
    bundles = (bundle for kind in ("assets", "worlds", "labs") for bundle in bundled_folders(kind))
    return next((bundle for bundle in bundles if folder.is_relative_to(bundle)), None)


def is_bare_name(name: str) -> bool:
    """Check whether a text can be the name of a bundled model or package: neither a path nor a pattern."""
    return 0 < len(name) < 200 and not set(name) & set("/\\*?[]<>:") and not name.startswith(".")


def find_bundled_model(name: str) -> Path | None:
    """Return the SDF or URDF file of a bundled model by its bare name, or None if there is no such model."""
    if not is_bare_name(name):
        return None
    for bundle in bundled_folders("assets"):
        for folder in (bundle / name, *sorted(bundle.glob(f"*/{name}")), *sorted(bundle.glob(f"*/models/{name}"))):
            where = Where(str(folder))
            model = model_file(folder, where, Diagnostics(), lambda _: True) if folder.is_dir() else None
            if model is not None:
                return model
        for suffix in ("sdf", "urdf", "xacro"):
            file_name = name if name.endswith(f".{suffix}") else f"{name}.{suffix}"
            below = [file for pattern in ("*", "*/urdf") for file in sorted(bundle.glob(f"{pattern}/{file_name}"))]
            for file in (bundle / file_name, *below):
                if file.is_file():
                    return file
    return None


def find_bundled_world(name: str) -> Path | None:
    """Return the file of a bundled world by its bare name, or None if there is no such world."""
    if not is_bare_name(name):
        return None
    for bundle in bundled_folders("worlds"):
        for file_name in (name, f"{name}.sdf", f"{name}.world"):
            if (bundle / file_name).is_file():
                return bundle / file_name
    return None


def bundled_worlds() -> list[str]:
    """Return the bare names of the bundled worlds."""
    return sorted({p.stem for bundle in bundled_folders("worlds") for p in bundle.glob("*.sdf")})


def bundled_names() -> list[str]:
    """Return the bare names of the bundled worlds and models."""
    models = [p.parent.name for bundle in bundled_folders("assets") for p in bundle.glob("**/model.config")]
    return sorted({*bundled_worlds(), *models})


def turtlebot3_uri(uri: str, where: Where, diagnostics: Diagnostics) -> str | None:
    """Replace the URI `model://turtlebot3` by the URI of the robot in the environment variable `TURTLEBOT3_MODEL`.

    An unset variable selects the waffle, with a note. For an unknown robot, the function returns None and records an
    error that lists the known robots. Every other URI is returned unchanged.
    """
    if uri != _URI:
        return uri
    name = os.environ.get("TURTLEBOT3_MODEL", "").strip()
    if not name:
        message = f"TURTLEBOT3_MODEL is not set; the robot is a {_DEFAULT}"
        diagnostics.note("SK-URI-008", message, where, f"set TURTLEBOT3_MODEL to {', '.join(MODELS)}")
        name = _DEFAULT
    if name not in MODELS:
        message = f"TURTLEBOT3_MODEL={name}: unknown robot; known are {', '.join(MODELS)}"
        diagnostics.error("SK-URI-007", message, where, did_you_mean(name, MODELS) or "unset it")
        return None
    return f"{_URI}_{name}"


def turtlebot3_name(name: str, diagnostics: Diagnostics) -> str | None:
    """Replace the bare name `turtlebot3` by the name of the robot in `TURTLEBOT3_MODEL`; other names stay the same."""
    if name != "turtlebot3":
        return name
    uri = turtlebot3_uri(_URI, Where(name), diagnostics)
    return None if uri is None else uri.removeprefix("model://")


_GROUND_PLANE = """<sdf version="1.7"><model name="ground_plane"><static>true</static><link name="link">
<collision name="collision"><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
<surface><friction><ode><mu>100</mu><mu2>50</mu2></ode></friction></surface></collision>
<visual name="visual"><cast_shadows>false</cast_shadows>
<geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
<material><ambient>0.8 0.8 0.8 1</ambient><diffuse>0.8 0.8 0.8 1</diffuse><specular>0.8 0.8 0.8 1</specular></material>
</visual></link></model></sdf>"""

_SUN = """<sdf version="1.7"><light type="directional" name="sun"><cast_shadows>true</cast_shadows>
<pose>0 0 10 0 0 0</pose><diffuse>0.8 0.8 0.8 1</diffuse><specular>0.2 0.2 0.2 1</specular>
<attenuation><range>1000</range><constant>0.9</constant><linear>0.01</linear><quadratic>0.001</quadratic></attenuation>
<direction>-0.5 0.1 -0.9</direction></light></sdf>"""

_MODELS = {"ground_plane": _GROUND_PLANE, "ground plane": _GROUND_PLANE, "sun": _SUN}


def bundled_models() -> Iterator[str]:
    """Return the names of the models that a world can include without a search path."""
    yield from ("ground_plane", "sun")
    for bundle in bundled_folders("assets"):
        for pattern in ("*/model.config", "*/*/model.config"):
            yield from (file.parent.name for file in sorted(bundle.glob(pattern)))


def builtin_model_uri(text: str) -> str | None:
    """Return the URI of the built-in model that has a text, or None."""
    return next((f"model://{name}" for name, model in _MODELS.items() if model == text), None)


def builtin_model(uri: str) -> str | None:
    """Return the text of the built-in model that a `model://` or Fuel URI names, or None."""
    scheme, separator, rest = unquote(uri).partition("://")
    if not separator or scheme not in ("model", "http", "https"):
        return None
    parts = [p for p in rest.lower().split("/") if p]
    if scheme == "model":
        return _MODELS.get(parts[0]) if len(parts) == 1 else None
    if "models" not in parts or "fuel" not in parts[0]:
        return None
    inside = parts[parts.index("models") + 1 :]
    return _MODELS.get(inside[0]) if inside and len(inside) <= 2 else None
