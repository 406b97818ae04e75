"""`<experimental:params>` of an include: elements that the include adds to, changes in or removes from its model.

Source: the SDFormat proposal "Parameter passing". A change finds its element by the tag and by the path of names from
the included model (`link::visual`). An invalid change is an error, and the remaining changes are still made.
"""

from __future__ import annotations

from collections.abc import Callable

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.entity_names import scoped
from simkit.params import Params

ACTIONS = ("add", "modify", "remove", "replace")
BLOCK = "experimental:params"
_CODE = "SK-SDF-032"
_ACTION_ATTRIBUTES = ("element_id", "action")
IncludedName = Callable[[Params], str]


def apply_changes(block: Params, entity: Params, name_of: IncludedName) -> None:
    """Make the changes of one block.

    Args:
        block: the `<experimental:params>` element.
        entity: the included model; this function changes it, so it must be a copy that belongs to the caller.
        name_of: returns the name of the model that an `<include>` inside the model loads.
    """
    for change in block.children:
        _apply_action(change, entity, name_of)


def _apply_action(change: Params, entity: Params, name_of: IncludedName) -> None:
    path = change.attributes.get("element_id")
    if path is None:
        change.error(_CODE, f"<{change.name}> needs element_id=, the path of names to the element that it changes")
        return
    if path.endswith("::"):
        change.error(_CODE, f"element_id={path!r} has no name after its last '::'")
        return
    action = change.attributes.get("action", "")
    if action and not _known_action(change, action):
        return
    adding = action == "add"
    if adding and not change.attribute("name").strip():
        change.error(_CODE, f"<{change.name}> is added to {path or entity.attribute('name')!r} and needs a name")
        return
    target_place = _find_element(entity, path, "" if adding else change.name, name_of)
    if target_place is None:
        near = did_you_mean(path, _known_paths(entity, name_of))
        kind = "element" if adding else f"<{change.name}>"
        change.error(_CODE, f"the included model has no {kind} with element_id={path!r}", near)
        return
    owner, target, rest = target_place
    if rest is not None:
        _forward_to_include(change, target, rest)
    elif adding:
        _add(change, target)
    else:
        _change_element(action, change, owner, target)


def _known_action(element: Params, action: str) -> bool:
    if action in ACTIONS:
        return True
    element.error(_CODE, f"action={action!r} is not one of {', '.join(ACTIONS)}", did_you_mean(action, ACTIONS))
    return False


def _find_element(
    entity: Params, path: str, tag: str, name_of: IncludedName
) -> tuple[Params | None, Params, str | None] | None:
    """Return the parent element, the element of a path, and the rest of the path if the element is a nested include.

    A name can contain `::` itself (files before 1.8), so every name that the path begins with is tried, longest first.
    """
    if not path:
        return (None, entity, None) if tag in ("", entity.name) else None
    named = [(child, _name(child, name_of)) for child in entity.children]
    for child, name in sorted(named, key=lambda item: -len(item[1])):
        if not name or (path != name and not path.startswith(f"{name}::")):
            continue
        rest = path[len(name) + 2 :]
        if child.name == "include":
            if not rest and tag == "model":
                return entity, child, None
            return entity, child, rest
        if not rest:
            if tag in ("", child.name):
                return entity, child, None
            continue
        deeper = _find_element(child, rest, tag, name_of)
        if deeper is not None:
            return deeper if deeper[0] is not None else (entity, child, None)
    return None


def _name(element: Params, name_of: IncludedName) -> str:
    return name_of(element) if element.name == "include" else element.attribute("name").strip()


def _known_paths(entity: Params, name_of: IncludedName, prefix: str = "", depth: int = 3) -> list[str]:
    """Return the valid values of `element_id` of the first three levels, for a hint."""
    if depth == 0:
        return []
    paths = []
    for child in entity.children:
        if name := _name(child, name_of):
            here = scoped(prefix, name)
            paths += [here, *_known_paths(child, name_of, here, depth - 1)]
    return paths


def _forward_to_include(change: Params, include: Params, rest: str) -> None:
    """Move a change to the nested include whose model it changes."""
    passed = change.copied()
    passed.attributes["element_id"] = rest
    block = Params(BLOCK, "", None, [passed], change.where, change.diagnostics)
    include.children.append(block)


def _add(change: Params, target: Params) -> None:
    name = change.attributes.get("name")
    if any(c.name == change.name and c.attributes.get("name") == name for c in target.children):
        change.error(_CODE, f"cannot add <{change.name} name={name!r}>: <{target.name}> already has one")
        return
    target.children.append(_without_action_attributes(change))


def _change_element(action: str, change: Params, owner: Params | None, target: Params) -> None:
    if not action:
        _child_actions(change, target)
    elif action == "modify":
        _modify(change, target)
    elif action == "remove" and change.children:
        for child in change.children:
            same = _matching_child(child, target)
            if same is not None:
                target.children.remove(same)
    elif owner is None:
        change.error(_CODE, f"action={action!r} is not allowed for the included model itself")
    elif action == "remove":
        owner.children.remove(target)
    else:
        _replace(change, owner, target)


def _child_actions(change: Params, target: Params) -> None:
    """Apply a change without an action; each child of the change has its own action."""
    for child in change.children:
        action = child.attributes.get("action")
        if action is None:
            child.error(_CODE, f"<{child.name}> needs action=, because the enclosing <{change.name}> has none")
        elif not _known_action(child, action):
            continue
        elif action == "add":
            target.children.append(_without_action_attributes(child))
        elif (same := _matching_child(child, target)) is None:
            continue
        else:
            _change_element(action, child, target, same)


def _matching_child(change: Params, target: Params) -> Params | None:
    """Return the child of the same tag (and name, if given); None, with an error recorded, if there is none."""
    same = [c for c in target.children if c.name == change.name]
    name = change.attributes.get("name")
    if name is not None:
        same = [c for c in same if c.attributes.get("name") == name]
    if not same:
        tag = f"<{change.name}>" if name is None else f"<{change.name} name={name!r}>"
        near = did_you_mean(change.name, [c.name for c in target.children])
        near = near or f'only what the file has can change; action="replace" takes a whole new <{target.name}>'
        change.error(_CODE, f"<{target.name} name={target.attribute('name')!r}> has no {tag} to change", near)
        return None
    return same[0]


def _modify(change: Params, target: Params) -> None:
    """Set the values and attributes that the change gives; all others stay the same."""
    target.attributes.update({k: v for k, v in change.attributes.items() if k not in _ACTION_ATTRIBUTES})
    if change.value or not change.children:
        target.value, target.where = change.value, change.where
    for child in change.children:
        if (same := _matching_child(child, target)) is not None:
            _modify(child, same)


def _replace(change: Params, owner: Params, target: Params) -> None:
    new = _without_action_attributes(change)
    if "name" in target.attributes:
        new.attributes.setdefault("name", target.attributes["name"])
    owner.children[owner.children.index(target)] = new


def _without_action_attributes(change: Params) -> Params:
    new = change.copied()
    for name in _ACTION_ATTRIBUTES:
        new.attributes.pop(name, None)
    return new
