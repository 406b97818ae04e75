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
_MOST_HINTS, _MOST_NAMES = 100, 1000  # beyond these the search for the closest name is left out
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
        pose_where: the place of its pose in the file, where it has one.
        carrier: the link (or the world) that it moves with, once that is known.
        adrift: there is none, which has been reported.
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
    pose_where: Where | None = None
    carrier: Frame | None = None
    adrift: bool = False

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
    hints: int = 0

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
            own = WORLD if scope.root.kind == WORLD else MODEL
            if last and part in ("", own):
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
            place = where if asker is None or where is not NOWHERE else asker.where
            self.report_unknown(path, owner + "the frame", place)
            return IDENTITY
        pose = IDENTITY
        for frame in frames:
            pose = pose @ self.resolve(frame)
        return pose

    def resolve(self, frame: Frame) -> Pose:
        """The pose of `frame` in the coordinates of the scope that names it.

        What it depends on comes first, without recursion: a file may have a chain of any length.
        """
        waiting = [(frame, False)]
        begun: set[int] = set()
        while waiting:
            one, ready = waiting.pop()
            if one.resolved is not None or one.scope is None:
                continue
            if ready:
                one.resolved = self._resolved_pose(one)
            elif id(one) in begun:
                text = f"the pose of {one.kind} {one.scoped!r} depends on itself"
                self.diagnostics.error("SK-SDF-005", text, one.pose_where or one.where)
                one.resolved = IDENTITY
            else:
                begun.add(id(one))
                waiting.append((one, True))
                waiting.extend((needed, False) for needed in _required_frames(one))
        return frame.resolved or IDENTITY

    def _resolved_pose(self, frame: Frame) -> Pose:
        """The pose of a frame whose every need is resolved."""
        assert frame.scope is not None
        base = frame.relative_to or frame.default_base
        pose = frame.pose
        if base or frame.scope.root.scope is not None:
            pose = frame.scope.pose_of(base, frame, frame.pose_where or NOWHERE) @ pose
        if frame.inside is not None and frame.placement:
            pose = pose @ frame.inside.pose_of(frame.placement, None, frame.where).inverse()
        return pose

    def body(self, path: str, where: Where, owner: str) -> Frame | None:
        """The link (or the world) that a named frame moves with; None, with an error recorded, where there is none."""
        seen: dict[int, Frame] = {}
        found = self._follow_attachment(path, where, owner, seen)
        for frame in seen.values():
            frame.carrier, frame.adrift = found, found is None
        return found

    def _follow_attachment(self, path: str, where: Where, owner: str, seen: dict[int, Frame]) -> Frame | None:
        """`body`, noting every frame on the way."""
        scope: Scope = self
        while True:
            frames = scope.chain(path)
            if frames is None:
                scope.report_unknown(path, f"{owner}: the frame", where)
                return None
            frame = frames[-1] if frames else None
            if frame is not None and frame.adrift:
                return None
            if frame is not None and id(frame) in seen:
                text = f"{frame.kind} {frame.scoped!r} is attached to itself"
                self.diagnostics.error("SK-SDF-005", text, frame.where)
                return None
            if frame is not None and (frame.kind == "link" or frame.carrier is not None):
                return frame.carrier or frame
            inside = scope if frame is None else frame.inside
            if inside is not None:
                if inside.root.kind == WORLD:
                    return inside.root
                if not inside.canonical:
                    text = f"{owner}: model {inside.root.name!r} has no link to attach to"
                    self.diagnostics.error("SK-SDF-004", text, where)
                    return None
                scope, path = inside, inside.canonical
            elif frame is not None:
                owner, where, path = f"{frame.kind} {frame.name!r}", frame.where, frame.attached_to
                scope = frame.scope or scope
            if frame is not None:
                seen[id(frame)] = frame

    def report_unknown(self, path: str, what: str, where: Where, code: str = "SK-SDF-004") -> None:
        """Records that a name is unknown, with the closest one."""
        hint = ""
        if self.hints < _MOST_HINTS and len(self.names) <= _MOST_NAMES:
            self.hints += 1
            hint = did_you_mean(path, self.all_names())
        known = ", ".join(list(self.names)[:8]) or "none"
        self.diagnostics.error(code, f"{what} {path!r} does not exist here (there are: {known})", where, hint)

    def all_names(self) -> list[str]:
        """Names that can be used here, nested ones one level down included."""
        nested = [f"{n}::{inner}" for n, f in self.names.items() if f.inside for inner in f.inside.names]
        return [*self.names, *nested]


def _required_frames(frame: Frame) -> list[Frame]:
    """The frames whose poses the pose of `frame` is made of."""
    needed: list[Frame] = []
    base = frame.relative_to or frame.default_base
    if frame.scope is not None and (base or frame.scope.root.scope is not None):
        needed += frame.scope.chain(base) or ()
    if frame.inside is not None and frame.placement:
        needed += frame.inside.chain(frame.placement) or ()
    return needed


def world_pose(frame: Frame) -> Pose:
    """The pose of a frame in the world at load time; its scope's place must be known."""
    if frame.scope is None:
        return IDENTITY
    return frame.scope.world @ frame.scope.resolve(frame)


def pose_base(pose: Params | None) -> str:
    """The frame that a `<pose>` speaks of: `relative_to`, or `frame` before 1.7."""
    if pose is None:
        return ""
    return pose.attribute("relative_to") or pose.attribute("frame")
