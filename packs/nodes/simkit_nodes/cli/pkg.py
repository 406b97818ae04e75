"""List, find and create ROS packages of a workspace, without ROS."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.run_options import NONE_GIVEN
from simkit.cli.terminal import options
from simkit.cli.terminal.output import print_json, print_line, print_status
from simkit.extend import GivenOptions, add_to_report, argument, option, report_errors, with_run_options

if TYPE_CHECKING:
    from simkit_nodes.packages import Executable
    from simkit_nodes.workspace import Workspace

LISTED_AFTER = "node"

pkg = typer.Typer(help="List, find and create ROS packages of a workspace, without ROS.", no_args_is_help=True)
Package = Annotated[str, argument("Name of the package.", "PACKAGE")]


def _workspace(given: GivenOptions) -> Workspace:
    from simkit_nodes.workspace import Workspace

    return Workspace(Path.cwd(), given.values.get("package_paths", ()))


@pkg.command("list")
@report_errors
@with_run_options("package_paths")
def list_packages(given: GivenOptions = NONE_GIVEN, json_: options.Json = False) -> None:
    """Print the names of the packages around the present folder, in `--package-path`, and of simkit's models."""
    packages = _workspace(given).packages()
    if json_:
        print_json({name: str(folder) for name, folder in packages.items()})
        return
    for name in packages:
        print_line(name)


@pkg.command()
@report_errors
@with_run_options("package_paths")
def executables(
    package: Annotated[str | None, argument("Name of the package; all packages by default.", "[PACKAGE]")] = None,
    full_path: Annotated[bool, Option("--full-path", help="Print the files.")] = False,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,
) -> None:
    """Print `PACKAGE EXECUTABLE` for each executable in Python; `simkit run --node PACKAGE/EXECUTABLE` starts it.

    With the name of a package of ROS, such as turtlesim, these are the programs that simkit has for its executables.
    """
    from simkit_nodes.packages import executables_of

    workspace = _workspace(given)
    of_simkit = [] if package is None else _known_executables(package)
    if package is None:
        folders = workspace.packages()
    elif of_simkit and workspace.package(package) is None:
        folders = {}
    else:
        folders = {package: workspace.required_package(package)}
    listed = [executable for folder in folders.values() for executable in executables_of(folder).values()]
    names = {executable.name for executable in listed}
    listed = sorted([*listed, *(e for e in of_simkit if e.name not in names)], key=lambda e: (e.package, e.name))
    if json_:
        print_json([{"package": e.package, "name": e.name, "file": str(e.file)} for e in listed])
        return
    for executable in listed:
        print_line(str(executable.file) if full_path else f"{executable.package} {executable.name}")
    if not listed:
        print_status("no executables in Python")


def _known_executables(package: str) -> list[Executable]:
    """Return the programs that simkit has for the executables of a package of ROS."""
    from simkit_nodes.known_nodes import known_node, known_node_names
    from simkit_nodes.packages import Executable

    names = [name for name in known_node_names() if name.startswith(f"{package}/") and "*" not in name]
    nodes = [node for name in names if "::" not in name and (node := known_node(name)) is not None]
    return [Executable(package, node.name.rpartition("/")[2], node.file) for node in nodes if node.file is not None]


@pkg.command()
@report_errors
@with_run_options("package_paths")
def depends(package: Package, given: GivenOptions = NONE_GIVEN, json_: options.Json = False) -> None:
    """Print the packages that a package names in its `package.xml`, as `rospack depends1`."""
    from simkit_nodes.packages import dependencies_of

    names = dependencies_of(_workspace(given).required_package(package))
    if json_:
        print_json(names)
        return
    for name in names:
        print_line(name)


@pkg.command()
@report_errors
@with_run_options("package_paths")
def find(package: Package, given: GivenOptions = NONE_GIVEN, json_: options.Json = False) -> None:
    """Print the folder of a package, as `rospack find`; `cd $(simkit pkg find PACKAGE)` is `roscd PACKAGE`."""
    _print_folder(_workspace(given).required_package(package), json_=json_)


@pkg.command()
@report_errors
def known(
    text: Annotated[str, argument("Part of the names to print.", "[TEXT]")] = "", json_: options.Json = False
) -> None:
    """Print the known nodes: executables of ROS for which simkit has a program, or that have no effect here."""
    from simkit_nodes.known_nodes import known_node, known_node_names

    found = [node for name in known_node_names() if text in name and (node := known_node(name)) is not None]
    if json_:
        print_json([{"name": node.name, "pack": node.pack, "nothing": node.nothing} for node in found])
        return
    for node in found:
        print_line(f"{node.name}: no effect; {node.nothing}" if node.nothing else node.name)
    if not found:
        print_status("no known node has this text in its name")


@pkg.command()
@report_errors
@with_run_options("package_paths")
def prefix(
    package: Package,
    share: Annotated[bool, Option("--share", help="Print the folder of the package's files.")] = False,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,
) -> None:
    """Print the folder in which a package is installed; the package itself if it is in a source tree."""
    folder = _workspace(given).required_package(package)
    is_installed = folder.parent.name == "share"
    _print_folder(folder.parents[1] if is_installed and not share else folder, json_=json_)


def _print_folder(folder: Path, *, json_: bool) -> None:
    if json_:
        print_json(str(folder))
    else:
        print_line(str(folder))


@pkg.command()
@report_errors
def create(
    name: Annotated[str, argument("Name of the new package.", "NAME")],
    node_name: Annotated[str | None, option("Name of an executable with a small node.", "NAME")] = None,
    destination_directory: Annotated[Path, option("Folder in which the package is made.", "DIR")] = Path(),
    dependencies: Annotated[list[str], option("Package that the new one needs; repeatable.", "PACKAGE")] = [],
    description: Annotated[str, option("Description.", "TEXT")] = "TODO: Package description",
    license_: Annotated[str, option("Name of the licence.", "TEXT", "--license")] = "TODO: License declaration",
    maintainer_name: Annotated[str, option("Name of the maintainer.", "TEXT")] = "user",
    maintainer_email: Annotated[str, option("Address of the maintainer.", "TEXT")] = "user@todo.todo",
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """Create a ROS 2 package in Python, as `ros2 pkg create --build-type ament_python` does."""
    from simkit_nodes.package_skeleton import write_package

    files = write_package(
        name,
        destination_directory,
        node=node_name,
        dependencies=tuple(dependencies),
        description=description,
        license_=license_,
        maintainer=maintainer_name,
        email=maintainer_email,
    )
    add_to_report(files=[str(file) for file in files])
    for file in files:
        print_line(str(file))
    if node_name is not None:
        print_status(f"run it with `simkit run WORLD --node {name}/{node_name}`")
