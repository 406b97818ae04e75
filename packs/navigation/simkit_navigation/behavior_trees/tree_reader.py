"""Reader of behaviour trees in the XML of BehaviorTree.CPP 3 and 4.

The format: https://www.behaviortree.dev/docs/learn-the-basics/xml_format and `src/xml_parsing.cpp`. All problems of a
file are reported in one pass.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from simkit import Params
from simkit.extend import Diagnostics, Document, did_you_mean
from simkit.loaders.resources.xml_reader import parse_file
from simkit_navigation.behavior_trees.blackboard import Blackboard
from simkit_navigation.behavior_trees.known_nodes import LEFT_OUT, NODES, SUBTREES
from simkit_navigation.behavior_trees.navigator import Navigator
from simkit_navigation.behavior_trees.scripts import Script, ScriptError
from simkit_navigation.behavior_trees.tree_node import Tree, TreeError, TreeNode

_KINDS: Final = ("Action", "Condition", "Decorator", "Control")
"""Elements of the long form, `<Action ID="Spin"/>`."""
_SCRIPTS: Final = ("_skipIf", "_failureIf", "_successIf", "_while", "_onSuccess", "_onFailure", "_onHalted", "_post")
_OF_EDITORS: Final = ("name", "ID", "_uid", "_fullpath", "_description", "_collapsed")
_SHARED: Final = ("__shared_blackboard",)
_REMAPS_ALL: Final = ("_autoremap", "__autoremap")
_IGNORED: Final = ("TreeNodesModel",)
MOST_NODES: Final = 5000
"""Largest number of nodes of a tree; subtrees count at each place."""
MOST_LEVELS: Final = 100
"""Largest depth of a tree: the nodes call each other, and Python limits the depth of calls."""
MOST_FILES: Final = 100
"""Largest number of files that a file includes."""


@dataclass
class TreeFile:
    """Trees of a file and of the files that it includes.

    Attributes:
        path: file.
        main: name of the tree that is executed.
        trees: elements of the trees by name.
        is_version_4: True if the format is that of BehaviorTree.CPP 4.
    """

    path: Path
    main: str = ""
    trees: dict[str, Params] = field(default_factory=dict)
    is_version_4: bool = False


def read_tree_file(path: Path, diagnostics: Diagnostics) -> TreeFile | None:
    """Read the trees of a file; return None if it is not a tree. All problems are reported."""
    tree_file = TreeFile(path)
    document = _read_document(path, tree_file, diagnostics, {path.resolve()})
    if document is None:
        return None
    tree_file.main = document.root.attribute("main_tree_to_execute")
    where = document.root.where
    if not tree_file.main and len(tree_file.trees) == 1:
        tree_file.main = next(iter(tree_file.trees))
    if not tree_file.trees:
        diagnostics.error("SK-BT-001", "the file has no <BehaviorTree>", where)
    elif not tree_file.main:
        names = ", ".join(tree_file.trees)
        text = f"the file has several trees ({names}), and <root> has no main_tree_to_execute"
        diagnostics.error(
            "SK-BT-001", text, where, f'write <root main_tree_to_execute="{next(iter(tree_file.trees))}">'
        )
    elif tree_file.main not in tree_file.trees:
        text = f"main_tree_to_execute: there is no tree {tree_file.main!r}"
        diagnostics.error("SK-BT-001", text, where, did_you_mean(tree_file.main, tree_file.trees))
    for tree in tree_file.trees.values():
        _check_count(tree, 1, 1, diagnostics)
        for child in tree.children:
            _check(child, tree_file, diagnostics)
    return tree_file


def _read_document(path: Path, found: TreeFile, diagnostics: Diagnostics, files: set[Path]) -> Document | None:
    """Read the trees of a file into `found`."""
    document = parse_file(path, diagnostics)
    if document is None:
        return None
    root = document.root
    if root.name != "root":
        text = f"<{root.name}> begins the file; a behaviour tree begins with <root>"
        diagnostics.error("SK-BT-001", text, root.where)
        return None
    version = root.attribute("BTCPP_format") or "3"
    if version not in ("3", "4"):
        diagnostics.error("SK-BT-001", f"BTCPP_format: found {version!r}; expected 3 or 4", root.where)
    found.is_version_4 = found.is_version_4 or version == "4"
    for element in root.children:
        if element.name == "include":
            _include(element, path, found, diagnostics, files)
        elif element.name == "BehaviorTree":
            name = element.attribute("ID") or ("" if found.trees else "BehaviorTree")
            if not name:
                diagnostics.error("SK-BT-001", "<BehaviorTree> has no ID", element.where)
            elif name in found.trees:
                diagnostics.error("SK-BT-001", f"a second tree has the ID {name!r}", element.where)
            else:
                found.trees[name] = element
        elif element.name not in _IGNORED:
            text = f"<{element.name}> is not used in <root>"
            diagnostics.warning("SK-BT-003", text, element.where, "a tree is in <BehaviorTree>")
    return document


def _include(element: Params, path: Path, found: TreeFile, diagnostics: Diagnostics, files: set[Path]) -> None:
    """Read an included file, which must be in the folder of the file."""
    name, folder = element.attribute("path"), path.parent
    target = folder / name
    problem = ""
    if element.attribute("ros_pkg"):
        problem = "files of other packages are not included"
    elif not name or Path(name).is_absolute() or ".." in Path(name).parts:
        problem = "only files in the folder of the tree, or below it, are included"
    elif not target.resolve().is_relative_to(folder.resolve()):
        problem = "the link leads out of the folder of the tree"
    elif not target.is_file():
        problem = f"there is no file {target}"
    elif len(files) > MOST_FILES:
        problem = f"more than {MOST_FILES} files"
    if problem:
        diagnostics.error("SK-BT-007", f"<include path={name!r}>: {problem}", element.where)
    elif target.resolve() not in files:
        files.add(target.resolve())
        _read_document(target, found, diagnostics, files)


def tag_of(element: Params) -> str:
    """Return the name of a node: `Spin` of `<Spin/>` and of `<Action ID="Spin"/>`."""
    return element.attribute("ID") if element.name in _KINDS else element.name


def _check(element: Params, found: TreeFile, diagnostics: Diagnostics) -> None:
    """Report the problems of a node and of the nodes below it."""
    tag = tag_of(element)
    if tag in SUBTREES:
        name = element.attribute("ID")
        if name not in found.trees:
            text = f"<{tag}>: there is no tree {name!r}"
            diagnostics.error("SK-BT-005", text, element.where, did_you_mean(name, found.trees))
        _check_count(element, 0, 0, diagnostics)
    elif tag in NODES:
        smallest, largest = NODES[tag].child_counts
        _check_count(element, smallest, largest, diagnostics)
        _check_ports(element, tag, diagnostics)
    elif tag in LEFT_OUT:
        text = f"the node <{tag}> of Nav2 is not available: {LEFT_OUT[tag]}"
        diagnostics.error("SK-BT-002", text, element.where, "remove the node, or run the tree with ROS")
    else:
        text = f"there is no node <{tag}>"
        names = sorted((*NODES, *SUBTREES))
        diagnostics.error("SK-BT-002", text, element.where, did_you_mean(tag, names) or f"there is {', '.join(names)}")
    for child in element.children:
        _check(child, found, diagnostics)


def _check_count(element: Params, smallest: int, largest: int | None, diagnostics: Diagnostics) -> None:
    count = len(element.children)
    if count < smallest or (largest is not None and count > largest):
        wanted = f"{smallest} or more" if largest is None else str(smallest)
        wanted = f"{smallest} to {largest}" if largest is not None and largest > smallest else wanted
        nodes = "child" if wanted == "1" else "children"
        name = tag_of(element)
        diagnostics.error("SK-BT-004", f"<{name}> has {count} children; it needs {wanted} {nodes}", element.where)


def _check_ports(element: Params, tag: str, diagnostics: Diagnostics) -> None:
    ports = NODES[tag].ports
    for name, text in element.attributes.items():
        if name in _SCRIPTS:
            try:
                Script(text)
            except ScriptError as error:
                diagnostics.error("SK-BT-006", f"<{tag}> {name}: {error}", element.where)
        elif name not in ports and name not in _OF_EDITORS:
            text = f"<{tag}> has no port {name!r}; it has no effect"
            diagnostics.warning("SK-BT-003", text, element.where, did_you_mean(name, ports) if ports else "")


# ---------------------------------------------------------------------- nodes


class _Builder:
    """Builder of the nodes of a tree."""

    def __init__(
        self, found: TreeFile, tree: Tree, overrides: Mapping[tuple[str, str], str], diagnostics: Diagnostics
    ) -> None:
        self.found, self.tree, self.overrides, self.diagnostics = found, tree, overrides, diagnostics

    def build(self, element: Params, board: Blackboard, outer: tuple[str, ...], depth: int = 0) -> TreeNode | None:
        tag = tag_of(element)
        if depth > MOST_LEVELS:
            self.diagnostics.error("SK-BT-005", f"nodes nested deeper than {MOST_LEVELS}", element.where)
            return None
        if tag in SUBTREES:
            return self._subtree(element, board, outer, depth)
        if len(self.tree.nodes) >= MOST_NODES:
            if len(self.tree.nodes) == MOST_NODES:
                self.diagnostics.error("SK-BT-005", f"the tree has more than {MOST_NODES} nodes", element.where)
            return None
        inputs = {name: text for name, text in element.attributes.items() if name in NODES[tag].ports}
        name = element.attribute("name") or tag
        inputs.update({port: text for (key, port), text in self.overrides.items() if key in (tag, name)})
        uid = len(self.tree.nodes) + 1
        try:
            node = NODES[tag](self.tree, tag, name, uid, inputs, board)
            node.scripts = {key: Script(text) for key, text in element.attributes.items() if key in _SCRIPTS}
        except (TreeError, ScriptError) as error:
            self.diagnostics.error("SK-BT-006", str(error), element.where)
            return None
        self.tree.nodes.append(node)
        for child in element.children:
            built = self.build(child, board, outer, depth + 1)
            if built is not None:
                node.children.append(built)
        return node

    def _subtree(self, element: Params, board: Blackboard, outer: tuple[str, ...], depth: int) -> TreeNode | None:
        name = element.attribute("ID")
        if name in outer:
            text = f"the tree {name!r} contains itself ({' → '.join((*outer, name))})"
            self.diagnostics.error("SK-BT-005", text, element.where)
            return None
        attributes = {key: text for key, text in element.attributes.items() if key not in (*_OF_EDITORS, *_SCRIPTS)}
        is_shared = any(_is_true(attributes.pop(key, "")) for key in _SHARED)
        remaps_all = any(_is_true(attributes.get(key, "")) for key in _REMAPS_ALL)
        attributes = {key: text for key, text in attributes.items() if key not in _REMAPS_ALL}
        own = board
        if not is_shared:
            own = Blackboard(parent=board, remaps_all=remaps_all)
            # in version 3, the text of <SubTree> is a name; in <SubTreePlus> and version 4, `{name}` is one
            are_names = element.name == "SubTree" and not self.found.is_version_4
            for key, text in attributes.items():
                stripped = text.strip()
                if stripped.startswith("{") and stripped.endswith("}"):
                    inner = stripped[1:-1].strip()
                    own.remapped[key] = key if inner == "=" else inner
                elif are_names:
                    own.remapped[key] = stripped
                else:
                    own.values[key] = text
        return self.build(self.found.trees[name].children[0], own, (*outer, name), depth + 1)


def _is_true(text: str) -> bool:
    return text.strip().lower() in ("true", "1")


def build_tree(
    found: TreeFile,
    navigator: Navigator,
    diagnostics: Diagnostics,
    overrides: Mapping[tuple[str, str], str] | None = None,
) -> Tree | None:
    """Make the nodes of the main tree of a file that has no errors; return None after an error.

    Args:
        found: trees.
        navigator: plugin that executes the tree.
        diagnostics: collection that receives the problems.
        overrides: texts of ports, by the name of a node or of its class, and the port.
    """
    tree = Tree(navigator, str(found.path))
    errors = diagnostics.error_count
    builder = _Builder(found, tree, overrides or {}, diagnostics)
    root = builder.build(found.trees[found.main].children[0], tree.board, (found.main,))
    if root is None or diagnostics.error_count > errors:
        return None
    tree.root = root
    return tree
