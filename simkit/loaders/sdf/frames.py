"""The frames of a file: names, poses relative to one another, and which body each is attached to.

Every model (and the world) is a scope with its own names; a pose is resolved inside its scope, so that a nested model
moves as one. Source: the SDFormat documentation, "Pose frame semantics" (1.7 and later; older files use the defaults).
"""

from __future__ import annotations

from dataclasses import dataclass, field

from simkit.diagnostics import NOWHERE, Diagnostics, Where, did_you_mean
from simkit.params import Params
from simkit.pose import IDENTITY, Pose

WORLD = "world"
MODEL = "__model__"


@dataclass(eq=False)
class Frame:
    """One named frame.

    Attributes:
        kind: world, model, link, joint or frame.
        scope: where the names it uses are looked up; None for the root of a scope.
        pose: as written, in `relative_to`.
        relative_to: as written; empty for the default of its kind.
        attached_to: what it moves with: a frame's `attached_to`, a joint's child; empty for the default.
        inside: a model's own scope.
        placement: a model's frame that its pose speaks of; empty for the model frame.
    """

    name: str
    kind: str
    scoped: str
    scope: Scope | None = None
    pose: Pose = IDENTITY
    relative_to: str = ""
    attached_to: str = ""
    inside: Scope | None = None
    placement: str = ""
    where: Where = NOWHERE
    resolved: Pose | None = None
    busy: bool = False

    @property
    def default_base(self) -> str:
        """The frame its pose speaks of when the file does not say."""
        return self.attached_to if self.kind in ("joint", "frame") else ""


@dataclass(eq=False)
class Scope:
    """The names of one model or of the world.

    Attributes:
        root: its own frame: the world, `__model__`, or what stands for that of a merged model.
        names: frames by name; a merged model shares those of the model it is merged into.
        canonical: name of the link that the root moves with.
        world: pose of the scope's coordinates in the world at load time.
    """

    root: Frame
    diagnostics: Diagnostics
    names: dict[str, Frame] = field(default_factory=dict)
    canonical: str = ""
    world: Pose = IDENTITY

    def chain(self, path: str) -> list[Frame] | None:
        """The frames from this scope down to `a::b::c`; None when a name is unknown; empty for the root.

        Files before 1.8 may have `::` inside one name, so the whole path is tried first.
        """
        scope: Scope = self
        found: list[Frame] = []
        if path in self.names:
            return [self.names[path]]
        parts = path.split("::")
        for position, part in enumerate(parts):
            last = position == len(parts) - 1
            if (last and part in ("", MODEL)) or (last and part == WORLD and scope.root.kind == WORLD):
                if scope is self and scope.root.scope is not None:
                    found.append(scope.root)  # the frame that stands for a merged model's own
                return found
            frame = scope.names.get(part)
            if frame is None:
                return None
            found.append(frame)
            if not last:
                if frame.inside is None:
                    return None
                scope = frame.inside
        return found

    def pose_of(self, path: str, asker: Frame | None = None, where: Where = NOWHERE) -> Pose:
        """The pose of a named frame in this scope's coordinates; an unknown name is an error."""
        frames = self.chain(path)
        if frames is None:
            owner = f"{asker.kind} {asker.name!r}: " if asker else ""
            self.unknown(path, owner + "the frame", asker.where if asker else where)
            return IDENTITY
        pose = IDENTITY
        for frame in frames:
            pose = pose @ self.resolve(frame)
        return pose

    def resolve(self, frame: Frame) -> Pose:
        """The pose of `frame` in the coordinates of the scope that names it."""
        if frame.resolved is not None:
            return frame.resolved
        if frame.scope is None:
            return IDENTITY
        if frame.busy:
            self.diagnostics.error(
                "SK-SDF-005", f"the pose of {frame.kind} {frame.scoped!r} depends on itself", frame.where
            )
            return IDENTITY
        frame.busy = True
        base = frame.relative_to or frame.default_base
        pose = (
            frame.pose if not base and frame.scope.root.scope is None else frame.scope.pose_of(base, frame) @ frame.pose
        )
        if frame.inside is not None and frame.placement:
            pose = pose @ frame.inside.pose_of(frame.placement, None, frame.where).inverse()
        frame.busy = False
        frame.resolved = pose
        return pose

    def body(self, path: str, where: Where, owner: str, seen: frozenset[int] = frozenset()) -> Frame | None:
        """The link (or the world) that a named frame moves with; None, with an error recorded, where there is none."""
        frames = self.chain(path)
        if frames is None:
            self.unknown(path, f"{owner}: the frame", where)
            return None
        if not frames:
            return self._body_of_root(where, owner, seen)
        frame, scope = frames[-1], self
        if id(frame) in seen:
            self.diagnostics.error("SK-SDF-005", f"{frame.kind} {frame.scoped!r} is attached to itself", frame.where)
            return None
        if frame.kind == "link":
            return frame
        seen = seen | {id(frame)}
        if frame.inside is not None:
            return frame.inside._body_of_root(where, owner, seen)
        scope = frame.scope or self
        return scope.body(frame.attached_to, frame.where, f"{frame.kind} {frame.name!r}", seen)

    def _body_of_root(self, where: Where, owner: str, seen: frozenset[int]) -> Frame | None:
        if self.root.kind == WORLD:
            return self.root
        canonical = self.canonical
        if not canonical:
            self.diagnostics.error("SK-SDF-004", f"{owner}: model {self.root.name!r} has no link to attach to", where)
            return None
        return self.body(canonical, where, owner, seen)

    def unknown(self, path: str, what: str, where: Where, code: str = "SK-SDF-004") -> None:
        """Records that a name is unknown, with the closest one."""
        hint = did_you_mean(path, self.all_names())
        known = ", ".join(list(self.names)[:8]) or "none"
        self.diagnostics.error(code, f"{what} {path!r} does not exist here (there are: {known})", where, hint)

    def all_names(self) -> list[str]:
        """Names that can be used here, nested ones one level down included."""
        nested = [f"{n}::{inner}" for n, f in self.names.items() if f.inside for inner in f.inside.names]
        return [*self.names, *nested]


def world_pose(frame: Frame) -> Pose:
    """The pose of a frame in the world at load time; its scope's place must be known."""
    if frame.scope is None:
        return IDENTITY
    return frame.scope.world @ frame.scope.resolve(frame)


def base_of(pose: Params | None) -> str:
    """The frame that a `<pose>` speaks of: `relative_to`, or `frame` before 1.7."""
    if pose is None:
        return ""
    return pose.attribute("relative_to") or pose.attribute("frame")
