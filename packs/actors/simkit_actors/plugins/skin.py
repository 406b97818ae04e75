"""Skins of actors from mesh files; each piece of the mesh is rigid and follows one bone."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from simkit import Pose
from simkit.extend import Diagnostics, SceneLink, SceneModel, SceneVisual
from simkit.linear_algebra import det, matmul, norm
from simkit.loaders.meshes.collada_skin import Skin, read_skin
from simkit.loaders.meshes.mesh_part import MeshFileError
from simkit.matrix_decompositions import svd
from simkit.plugins.adapters import FileFinder
from simkit.pose import IDENTITY
from simkit.scene import Animation, Mesh, SceneActor
from simkit_actors.plugins.animated_actor import (
    AT_THE_HIPS,
    ROOT_LINK,
    AnimatedActor,
    is_led_by_plugin,
    scripted_model,
)
from simkit_actors.plugins.script import Floats, Script, Stride, Track


@dataclass(frozen=True)
class Clip:
    """Animation of a skin: f frames with the poses of n bones in the actor's frame.

    Attributes:
        times: time of each frame [s], shape (f,); the first time is 0.
        places, turns: positions [m], shape (f, n, 3), and quaternions, shape (f, n, 4).
        root: position of the root bone [m], shape (f, 3).
        follows_x: true if the frame depends on the distance travelled, false if it depends on the time.
    """

    times: Floats
    places: Floats
    turns: Floats
    root: Floats
    follows_x: bool

    @property
    def length(self) -> float:
        """Duration [s]."""
        return float(self.times[-1])


@dataclass(frozen=True)
class SkinRig:
    """Skeleton of a skin. Its bones follow the animation that the trajectory names, or the first animation.

    Attributes:
        clips: animations by name.
        at_the_hips: true if the waypoints are at the height of the hips.
    """

    clips: dict[str, Clip]
    at_the_hips: bool

    def link_poses(self, track: Track, rests: bool) -> tuple[Floats, Floats]:
        clip = self.clips.get(track.type) or next(iter(self.clips.values()))
        rows = len(track.times)
        times = np.zeros(rows) if rests else _times(clip, track)
        after = np.clip(np.searchsorted(clip.times, times, side="right"), 1, max(1, len(clip.times) - 1))
        before = after - 1
        after = np.minimum(after, len(clip.times) - 1)
        span = clip.times[after] - clip.times[before]
        part = np.clip(
            np.where(span > 0.0, (times - clip.times[before]) / np.where(span > 0.0, span, 1.0), 0.0), 0.0, 1.0
        )
        part = part[:, None, None]
        places = clip.places[before] * (1.0 - part) + clip.places[after] * part
        turns = clip.turns[before] * (1.0 - part) + clip.turns[after] * part
        root = clip.root[before] * (1.0 - part[:, 0]) + clip.root[after] * part[:, 0]
        if track.moves or self.at_the_hips:
            # waypoints at the hips are gz's convention: it removes all motion of the root bone; Classic removes only x
            places = places - (root if self.at_the_hips else root * (1.0, 0.0, 0.0))[:, None, :]
        return places, turns / np.linalg.norm(turns, axis=-1, keepdims=True)


def _times(clip: Clip, track: Track) -> Floats:
    """Return the time in the animation [s] for each row of a track."""
    length = clip.length
    x = clip.root[:, 0]
    by_way = clip.follows_x and track.moves and not isinstance(track, Stride)
    if by_way and x[-1] - x[0] > 1e-3:
        return np.asarray(np.interp(np.mod(track.distance, x[-1] - x[0]) + x[0], np.maximum.accumulate(x), clip.times))
    return np.mod(track.times, length) if length > 0.0 else np.zeros_like(track.times)


def skinned_actor_model(actor: SceneActor, find_file: FileFinder, diagnostics: Diagnostics) -> SceneModel | None:
    """Return the actor's model with the skin from its file; None without a skin, or after a warning about the file."""
    if not actor.skin:
        return None
    skin = _read_file(actor, actor.skin, "skin", find_file, diagnostics)
    if skin is None or not skin.pieces:
        if skin is not None:
            _report(actor, f"its skin {actor.skin} has no mesh", diagnostics)
        return None
    file = _find_file(actor, actor.skin, find_file)
    assert file is not None
    carrying = sorted(skin.pieces)
    clips = _clips(actor, skin, carrying, find_file, diagnostics)
    first = next(iter(clips.values()))
    script = Script(actor, 0.0 if actor.trajectories and actor.trajectories[0].waypoints else first.length)
    base = script.pose(0.0)
    goes = is_led_by_plugin(actor) or any(t.moves for t in script.tracks)
    at_the_hips = goes and AT_THE_HIPS[0] <= base.position[2] <= AT_THE_HIPS[1]
    return _model(actor, skin, file, carrying, script, SkinRig(clips, at_the_hips))


def _model(actor: SceneActor, skin: Skin, file: Path, carrying: list[int], script: Script, rig: SkinRig) -> SceneModel:
    cast = AnimatedActor(actor.name, script, rig, is_led_by_plugin(actor))
    poses = cast.poses(0.0)
    sizes = [_size(m) for m in _worlds(skin, {i: bone.rest[None] for i, bone in enumerate(skin.bones)}, 1)]
    links = [SceneLink(ROOT_LINK, f"{actor.name}::{ROOT_LINK}", Pose(poses[0, :3], poses[0, 3:]))]
    for row, place in enumerate(carrying, 1):
        name = skin.bones[place].name or f"bone_{place}"
        scoped, scale = f"{actor.name}::{name}", sizes[place] * skin.unit * actor.skin_scale
        shape = Mesh(file, actor.skin, (scale, scale, scale), bone=skin.bones[place].name)
        visual = SceneVisual("skin", f"{scoped}::skin", IDENTITY, shape)
        pose = Pose(poses[row, :3], poses[row, 3:])
        links.append(SceneLink(name, scoped, pose, visuals=(visual,)))
    return scripted_model(actor, links[0].pose_world, links, cast)


def _clips(
    actor: SceneActor, skin: Skin, carrying: list[int], find_file: FileFinder, diagnostics: Diagnostics
) -> dict[str, Clip]:
    """Return the actor's animations by name; the animation in the skin's file if none of them can be read."""
    clips = {}
    for animation in actor.animations:
        moved = _read_file(actor, animation.uri, f"animation {animation.name!r}", find_file, diagnostics)
        clip = None if moved is None else _clip(skin, moved, carrying, animation, actor.skin_scale)
        if clip is not None:
            clips[animation.name] = clip
        elif moved is not None:
            _report(actor, f"the skeleton of animation {animation.name!r} differs from that of its skin", diagnostics)
    if not clips:
        skin_clip = _clip(skin, skin, carrying, Animation("", actor.skin, actor.skin_scale), actor.skin_scale)
        assert skin_clip is not None
        clips[""] = skin_clip
    return clips


def _clip(skin: Skin, moved: Skin, carrying: list[int], animation: Animation, scale: float) -> Clip | None:
    """Return the animation in the file `moved` for the skeleton of `skin`; None if the skeletons do not match."""
    place_of = _same_bones(skin, moved)
    if place_of is None:
        return None
    count = max(1, len(moved.times))
    frames = {}
    for i, bone in enumerate(skin.bones):
        j = place_of.get(i, -1)
        frames[i] = moved.frames[j] if j in moved.frames else bone.rest[None]
        if j in moved.frames and moved is not skin:
            stretch = animation.scale * moved.unit / (scale * skin.unit)
            frames[i] = frames[i].copy()
            frames[i][:, :3, 3] *= stretch
    worlds = _worlds(skin, frames, count)
    places = np.stack([worlds[i][:, :3, 3] for i in carrying], axis=1) * skin.unit * scale
    turns = np.stack([_quaternions(worlds[i][:, :3, :3]) for i in carrying], axis=1)
    root = worlds[0][:, :3, 3] * skin.unit * scale
    times = moved.times - moved.times[0] if len(moved.times) else np.zeros(1)
    return Clip(times, places, turns, root, animation.interpolate_x)


def _same_bones(skin: Skin, moved: Skin) -> dict[int, int] | None:
    """Map each bone of `skin` to a bone of `moved`.

    Bones are matched by name if at least half of them have a match, or else by order if both files have the same number
    of bones. Otherwise the result is None.
    """
    by_word = {word: i for i, bone in enumerate(moved.bones) for word in bone.words}
    named = {i: by_word[w] for i, bone in enumerate(skin.bones) for w in bone.words if w in by_word}
    if 2 * len(named) >= len(skin.bones):
        return named
    if len(skin.bones) == len(moved.bones):
        return {i: i for i in range(len(skin.bones))}
    return None


def _worlds(skin: Skin, frames: dict[int, Floats], count: int) -> list[Floats]:
    """Return the transforms of all bones in the skeleton's frame, an array of shape (count, 4, 4) for each bone."""
    transforms: list[Floats] = []
    for i, bone in enumerate(skin.bones):
        local = np.broadcast_to(frames[i], (count, 4, 4))
        transforms.append(local if bone.parent < 0 else matmul(transforms[bone.parent], local))
    return transforms


def _size(matrices: Floats) -> float:
    """Return the scale factor of a transform."""
    return float(abs(det(matrices[0, :3, :3])) ** (1.0 / 3.0)) or 1.0


def _quaternions(matrices: Floats) -> Floats:
    """Return the quaternions w, x, y, z of the rotations nearest to the matrices, shape (f, 3, 3).

    Successive quaternions have the same sign, so that they can be interpolated.
    """
    left, _, right = svd(matrices)
    turn = matmul(left, right)
    turn *= np.sign(det(turn))[:, None, None]
    quaternions = np.empty((len(turn), 4))
    for k, m in enumerate(turn):
        # Shepperd's method: start with the largest of the four components
        trace = m[0, 0] + m[1, 1] + m[2, 2]
        size = np.array([trace, m[0, 0], m[1, 1], m[2, 2]])
        i = int(size.argmax())
        if i == 0:
            q = np.array([1.0 + trace, m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
        else:
            a, b, c = i - 1, i % 3, (i + 1) % 3
            q = np.empty(4)
            q[0] = m[c, b] - m[b, c]
            q[1 + a] = 1.0 + m[a, a] - m[b, b] - m[c, c]
            q[1 + b] = m[a, b] + m[b, a]
            q[1 + c] = m[a, c] + m[c, a]
        quaternions[k] = q / norm(q)
        if k and matmul(quaternions[k], quaternions[k - 1]) < 0.0:
            quaternions[k] = -quaternions[k]
    return quaternions


def _find_file(actor: SceneActor, uri: str, find_file: FileFinder) -> Path | None:
    folder = Path(actor.where.file).parent if actor.where.file else None
    return find_file(uri, folder)


def _read_file(actor: SceneActor, uri: str, what: str, find_file: FileFinder, diagnostics: Diagnostics) -> Skin | None:
    file = _find_file(actor, uri, find_file)
    if file is None:
        _report(actor, f"cannot find its {what} {uri}", diagnostics)
        return None
    try:
        skin = read_skin(file)
    except MeshFileError as problem:
        _report(actor, f"its {what} {uri} {problem}", diagnostics)
        return None
    reported = {d.message for d in diagnostics}  # skin and animation are often the same file
    for note in skin.notes:
        message = f"actor {actor.name!r}: {uri} {note}"
        if message not in reported:
            diagnostics.warning("SK-ACTOR-001", message, actor.where)
    return skin


def _report(actor: SceneActor, what: str, diagnostics: Diagnostics) -> None:
    consequence = "a built-in person is drawn instead" if "skin" in what else "another animation plays instead"
    hint = "add its folder with --resource-path or SIMKIT_RESOURCE_PATH" if "cannot find" in what else ""
    diagnostics.warning("SK-ACTOR-001", f"actor {actor.name!r}: {what}; {consequence}", actor.where, hint)
