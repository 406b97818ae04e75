"""`simkit.launch`: the run that a launch file describes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import cast

from simkit.argument_checks import check_kind, check_table
from simkit.loaders.resources.ros_packages import enclosing_package
from simkit.project_folder import is_top_folder
from simkit.run_files import FileName, PackagePaths, split_package_paths
from simkit.run_spec import LoadOptions, RunSpec, named_values
from simkit_launch.launch_file import find_launch_file, read_launch_file
from simkit_launch.run_plan import run_spec_of

_REPOSITORY_LEVELS = 8


def launch(
    file: str | os.PathLike[str] | tuple[str, str],
    arguments: Mapping[str, str] | None = None,
    *,
    package_paths: PackagePaths = (),
    strict: bool = False,
) -> RunSpec:
    """Execute a launch file of ROS 2 or ROS 1 and return the run that it describes.

    The file is executed with the rights of the user, except an XML or YAML file. Nothing else starts: the programs run
    when the specification is run, in simulated time.

    Args:
        file: launch file (`.launch.py`, `.xml`, `.yaml`, `.launch`), or the names of a package and of its launch file.
        arguments: values of the arguments of the launch file by name, as `name:=value`.
        package_paths: folders of ROS packages by name, or workspaces, besides the one around the file.
        strict: treat what cannot run here as an error.

    Returns:
        Run of 10 s; `dataclasses.replace` gives it another length. Its `diagnostics` say what is left out.

    Raises:
        LoadError: the launch file has errors, with their places; or `strict` is set and something is left out.
        InputError: SK-LAUNCH-001 there is no such file.
    """
    check_table(arguments or {}, str, "arguments", "texts")
    path = launch_file_path(file, package_paths)
    return replace(_run_of_file(path, arguments or {}, package_paths, strict=strict), code_requests=())


def launched_run(spec: RunSpec) -> RunSpec:
    """Return a specification in which what a launch file starts replaces the key `launch` of a scenario file.

    The values of the scenario come first: its seed, its nodes, its name. The requests of the result are those for the
    programs of the workspace that the launch file starts.

    Args:
        spec: specification with a launch file.

    Raises:
        LoadError, InputError: as `launch`.
    """
    package_paths = spec.options.get("package_paths", ())
    package, space, name = spec.launch.strip().partition(" ")
    path = FileName(spec.launch, "program", ("launch",)).used_path(spec.folder)
    if path is None:
        path = launch_file_path((package, name.strip()) if space else spec.launch, package_paths)
    arguments = named_values(spec.launch_arguments, "arguments")
    launched = _run_of_file(path, arguments, package_paths, strict=bool(spec.options.get("strict")))
    folders = (*spec.options.get("resource_paths", ()), *launched.options.get("resource_paths", ()))
    options = {**spec.options, **launched.options, **({"resource_paths": folders} if folders else {})}
    return replace(
        spec,
        world=launched.world,
        launch="",
        launch_arguments=(),
        seed=spec.seed or launched.seed,
        name=spec.name or launched.name,
        spawn=(*launched.spawn, *spec.spawn),
        nodes=(*launched.nodes, *spec.nodes),
        options=cast(LoadOptions, options),
        diagnostics=(*spec.diagnostics, *launched.diagnostics),
        code_requests=launched.code_requests,
    )


def _run_of_file(path: Path, arguments: Mapping[str, str], package_paths: PackagePaths, *, strict: bool) -> RunSpec:
    """Return the run of a launch file, with its diagnostics and the requests for the programs that it starts."""
    paths = with_workspace(path, package_paths)
    plan = read_launch_file(path, arguments, paths, strict=strict)
    spec = run_spec_of(plan, paths)
    plan.diagnostics.raise_if_errors(strict=strict)
    return replace(spec, diagnostics=tuple(plan.diagnostics))


def launch_file_path(file: str | os.PathLike[str] | tuple[str, str], package_paths: PackagePaths = ()) -> Path:
    """Return the path of a launch file.

    Raises:
        InputError: SK-LAUNCH-001 there is no such file.
    """
    if isinstance(file, tuple):
        return find_launch_file(*file, package_paths)
    check_kind(file, (str, os.PathLike), "file", "a path, or the names of a package and of its launch file")
    return find_launch_file("", os.fspath(file), package_paths)


def with_workspace(file: Path, package_paths: PackagePaths) -> PackagePaths:
    """Return folders of packages with the workspace of a launch file: its repository, else the folder of its package.

    Args:
        file: launch file.
        package_paths: folders of packages of the user, which come first.
    """
    package = enclosing_package(file.resolve().parent)
    if package is None:
        return package_paths
    above = [folder for folder in package.parents[:_REPOSITORY_LEVELS] if not is_top_folder(folder)]
    repository = next((folder for folder in above if (folder / ".git").exists()), None)
    workspace = repository or (package.parent if above else package)
    named, workspaces = split_package_paths(package_paths)
    return (*(f"{name}={folder}" for name, folder in named.items()), *map(str, workspaces), str(workspace))
