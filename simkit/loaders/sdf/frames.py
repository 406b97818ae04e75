"""Frames of a file: names, poses relative to other frames, and the link that each frame moves with.

Every model (and the world) is a scope with its own names. Poses are resolved inside their scope, so a nested model
moves as a whole. Source: the SDFormat documentation, "Pose frame semantics" (1.7 and later; older files use the
defaults).
"""

from __future__ import annotations

from dataclasses import dataclass, field

from simkit.diagnostics import NOWHERE, Diagnostics, Where, did_you_mean
from simkit.params import Params
from simkit.pose import IDENTITY, Pose

WORLD = "world"
_MOST_HINTS, _MOST_NAMES = 100, 1000  # above these limits, no closest name is searched
MODEL = "__model__"


@dataclass(eq=False)
class Frame:
    """Named frame.

    Attributes:
        kind: world, model, link, joint or frame.
        scope: scope in which the frame's references are looked up; None for the root of a scope.
        pose: pose relative to `relative_to`, as written.
        relative_to: name of the base frame, as written; empty for the default of its kind.
        attached_to: name of the frame that it moves with: `attached_to` of a frame, `<child>` of a joint; or empty.
        inside: scope with the names inside a model; None for all other frames.
        placement: frame inside a model that the model's pose applies to; empty for the model frame.
        pose_where: place of its pose in the file, if it has one.
        carrier: link (or world) that it moves with, once this is known.
        is_unattached: true if it moves with no link; this error has been reported.
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
    is_unattached: bool = False

    @property
    def default_base(self) -> str:
        """Frame that the pose is relative to if the file does not name one."""
        return self.attached_to if self.kind in ("joint", "frame") else ""


@dataclass(eq=False)
class Scope:
    """Names of one model or of the world.

    Attributes:
        root: its own frame: the world, `__model__`, or the frame that replaces `__model__` of a merged model.
        names: frames by name; a merged model shares these with the model that it is merged into.
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
        """Return the frames from this scope down to `a::b::c`; None if a name is unknown; empty for the root.

        Names in files before 1.8 can contain `::`, so the whole path is tried first.
        """
        scope: Scope = self
        frames: list[Frame] = []
        if path in self.names:
            return [self.names[path]]
        parts = path.split("::")
        for position, part in enumerate(parts):
            last = position == len(parts) - 1
            root_name = WORLD if scope.root.kind == WORLD else MODEL
            if last and part in ("", root_name):
                if scope is self and scope.root.scope is not None:
                    frames.append(scope.root)  # the frame that replaces `__model__` of a merged model
                return frames
            frame = scope.names.get(part)
            if frame is None:
                return None
            frames.append(frame)
            if not last:
                if frame.inside is None:
                    return None
                scope = frame.inside
        return frames

    def pose_of(self, path: str, user: Frame | None = None, where: Where = NOWHERE) -> Pose:
        """Return the pose of a named frame in this scope's coordinates; an unknown name is an error."""
        frames = self.chain(path)
        if frames is None:
            owner = f"{user.kind} {user.name!r}: " if user else ""
            place = where if user is None or where is not NOWHERE else user.where
            self.report_unknown(path, owner + "the frame", place)
            return IDENTITY
        pose = IDENTITY
        for frame in frames:
            pose = pose @ self.resolve(frame)
        return pose

    def resolve(self, frame: Frame) -> Pose:
        """Return the pose of `frame` in the coordinates of the scope that contains its name.

        The frames that it depends on are resolved first, without recursion, because a chain can have any length.
        """
        waiting = [(frame, False)]
        begun: set[int] = set()
        while waiting:
            current, ready = waiting.pop()
            if current.resolved is not None or current.scope is None:
                continue
            if ready:
                current.resolved = self._resolved_pose(current)
            elif id(current) in begun:
                text = f"the pose of {current.kind} {current.scoped!r} depends on itself"
                self.diagnostics.error("SK-SDF-005", text, current.pose_where or current.where)
                current.resolved = IDENTITY
            else:
                begun.add(id(current))
                waiting.append((current, True))
                waiting.extend((required, False) for required in _required_frames(current))
        return frame.resolved or IDENTITY

    def _resolved_pose(self, frame: Frame) -> Pose:
        """Return the pose of a frame after all frames that it depends on are resolved."""
        assert frame.scope is not None
        base = frame.relative_to or frame.default_base
        pose = frame.pose
        if base or frame.scope.root.scope is not None:
            pose = frame.scope.pose_of(base, frame, frame.pose_where or NOWHERE) @ pose
        if frame.inside is not None and frame.placement:
            pose = pose @ frame.inside.pose_of(frame.placement, None, frame.where).inverse()
        return pose

    def body(self, path: str, where: Where, owner: str) -> Frame | None:
        """Return the link (or the world) that a named frame moves with; None, with an error recorded, if missing."""
        seen: dict[int, Frame] = {}
        body = self._follow_attachment(path, where, owner, seen)
        for frame in seen.values():
            frame.carrier, frame.is_unattached = body, body is None
        return body

    def _follow_attachment(self, path: str, where: Where, owner: str, seen: dict[int, Frame]) -> Frame | None:
        """Follow the attachments from a named frame to its link, and store the visited frames in `seen`."""
        scope: Scope = self
        while True:
            frames = scope.chain(path)
            if frames is None:
                scope.report_unknown(path, f"{owner}: the frame", where)
                return None
            frame = frames[-1] if frames else None
            if frame is not None and frame.is_unattached:
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
        """Record an error about an unknown name, with the closest name."""
        hint = ""
        if self.hints < _MOST_HINTS and len(self.names) <= _MOST_NAMES:
            self.hints += 1
            hint = did_you_mean(path, self.all_names())
        known = ", ".join(list(self.names)[:8]) or "none"
        self.diagnostics.error(code, f"{what} {path!r} does not exist here (known: {known})", where, hint)

    def all_names(self) -> list[str]:
        """Return the names in this scope, and the names directly inside its models (`model::name`)."""
        nested = [f"{n}::{inner}" for n, f in self.names.items() if f.inside for inner in f.inside.names]
        return [*self.names, *nested]


def _required_frames(frame: Frame) -> list[Frame]:
    """Return the frames whose poses are needed to resolve the pose of `frame`."""
    required: list[Frame] = []
    base = frame.relative_to or frame.default_base
    if frame.scope is not None and (base or frame.scope.root.scope is not None):
        required += frame.scope.chain(base) or ()
    if frame.inside is not None and frame.placement:
        required += frame.inside.chain(frame.placement) or ()
    return required


def world_pose(frame: Frame) -> Pose:
    """Return the pose of a frame in the world at load time; the world pose of its scope must be known."""
    if frame.scope is None:
        return IDENTITY
    return frame.scope.world @ frame.scope.resolve(frame)


def pose_base(pose: Params | None) -> str:
    """Return the frame that a `<pose>` is relative to: `relative_to`, or `frame` before 1.7."""
    if pose is None:
        return ""
    return pose.attribute("relative_to") or pose.attribute("frame")
