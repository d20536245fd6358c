"""The inner loops of `NearPairs`, compiled: where shapes are, and how far apart the two of a pair are at least.

A plane between two convex things, with a gap on both sides, proves that they are at least so far apart. The plane that
was found last, carried along by the larger of the two, is nearly as good a moment later: what a small motion takes from
its gap, beyond what it takes from the distance, is of second order. Where it fails, steps of GJK (Gilbert, Johnson and
Keerthi 1988) turn it. Whatever they find is a bound; what cannot be bounded well enough is left to coal.

Poses are rows of 12 numbers: rotation matrix, row by row, then position [m]. The frame is that of the robot's base.
Motions are of nv joints, then the base's shift and turn. All that does not change is in two arrays, `packed`, since
handing over many costs more time than the loops take. All of it is in one file for the reason given in `ik_kernel`.
"""

import math
from collections.abc import Callable
from typing import NamedTuple, TypeVar, cast

import numba
import numpy as np
from numpy.typing import NDArray

from .ik_kernel import compiled
from .pose import FloatArray

IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

CLOUD, BOX, SPHERE, CYLINDER = 0, 1, 2, 3
"""Kinds of shapes: the hull of points, or what its name says."""
ROUNDS = 24
"""Steps of GJK; more are hardly ever needed."""
CONVERGED = 5e-5
"""Bounds that are nearer to the distance than this part of it are not improved: directions are right to 0.01 rad."""
INACCURACY = 2e-6
"""Of coal's distances, which it ends its search with [m]: bounds stay so far below."""
SPARE = 0.05
"""Pairs whose balls are so much farther apart than need be are not looked at closer [m]."""
LITTLE = 0.03
"""A bound that is so much lower than need be may be so because it is old [m]."""
SLANT = 0.02
"""Part of a motion that may be along a distance though it seems to be across it: directions are no more exact."""
SIZES = 6
"""How many sizes stand at the beginning of what is packed."""


Function = TypeVar("Function", bound=Callable[..., object])


def part(function: Function) -> Function:
    """Compile a function that only others here call: what is kept on disk of those contains it."""
    return cast(Function, numba.njit(function))


class Scene(NamedTuple):
    """Joints, convex shapes that they carry or that are around, and pairs of shapes.

    The base is the first joint of all: it is shifted, and turns about its vertical axis. Shapes that joints carry come
    first. Of each of these, what its joints from the d-th on may move it by is summed up, for d from 0 to s; a joint
    that carries both shapes of a pair does not move one against the other, so that only sums from behind it count for
    that pair. Rows of levers are those of what joints carry, and a last one of zeros for what is around.

    Attributes:
        parent: Number of the joint that carries each joint, (j,).
        slides: 1 for joints that slide rather than turn, (j,).
        motion: Which of all motions is a joint's, (j,).
        solid: Of each shape its kind, the joint that carries it, its first point, and the one behind its last, (g, 4).
        chain: Which joints carry a shape, the base first, 0 where there are no more, (c + 1, s).
        lever: Which of all motions is theirs, (c + 1, s).
        first: Shape of each pair, (k,).
        second: The other, (k,).
        one: Which sum of levers counts for the first, (k,).
        other: Which of them counts for the second, (k,).
        joint_frame: Pose of each joint in its parent's frame, (j, 12).
        joint_axis: Unit axis of each, (j, 3).
        form: Of each shape three sizes, then centre and radius of a ball around it, (g, 7) [m]. Sizes are half sides of
            a box; radius of a sphere; radius and half of the length of a cylinder.
        frame: Pose of each in its joint's frame, or in the world, (g, 12).
        points: Of all clouds, (p, 3) [m].
        reach: How far a shape's farthest point may be from each joint of its chain, 0 where there are no more,
            (c + 1, s) [m/rad, or 1].
        plane: Direction from the first of a pair to the second across the plane last found, in the frame of the larger
            one, since from afar a small turn moves it much, (k, 3).
    """

    parent: IntArray
    slides: IntArray
    motion: IntArray
    solid: IntArray
    chain: IntArray
    lever: IntArray
    first: IntArray
    second: IntArray
    one: IntArray
    other: IntArray
    joint_frame: FloatArray
    joint_axis: FloatArray
    form: FloatArray
    frame: FloatArray
    points: FloatArray
    reach: FloatArray
    plane: FloatArray


def packed(scene: Scene) -> tuple[IntArray, FloatArray]:
    """All of a scene in two arrays, whole numbers and others."""
    c, s = scene.reach.shape
    sizes = [len(scene.parent), len(scene.solid), len(scene.points), c, s, len(scene.first)]
    whole = np.concatenate((sizes, *(each.ravel() for each in scene[:10])))
    return whole.astype(np.int64), np.concatenate([each.ravel() for each in scene[10:]])


def unpacked(whole: IntArray, numbers: FloatArray) -> Scene:
    """Views of what `packed` made."""
    j, g, p, c, s, k = whole[0], whole[1], whole[2], whole[3], whole[4], whole[5]
    a = SIZES
    b = a + 3 * j
    d = b + 4 * g
    e = d + 2 * c * s
    m = 12 * j
    n = m + 3 * j
    o = n + 7 * g
    r = o + 12 * g
    t = r + 3 * p
    u = t + c * s
    return Scene(
        whole[a : a + j],
        whole[a + j : a + 2 * j],
        whole[a + 2 * j : b],
        whole[b:d].reshape(g, 4),
        whole[d : d + c * s].reshape(c, s),
        whole[d + c * s : e].reshape(c, s),
        whole[e : e + k],
        whole[e + k : e + 2 * k],
        whole[e + 2 * k : e + 3 * k],
        whole[e + 3 * k : e + 4 * k],
        numbers[:m].reshape(j, 12),
        numbers[m:n].reshape(j, 3),
        numbers[n:o].reshape(g, 7),
        numbers[o:r].reshape(g, 12),
        numbers[r:t].reshape(p, 3),
        numbers[t:u].reshape(c, s),
        numbers[u:].reshape(k, 3),
    )


_views = part(unpacked)


@part
def _compose(one: FloatArray, a: int, other: FloatArray, b: int, into: FloatArray, c: int) -> None:
    """Write the product of two poses, each a row of (n, 12)."""
    for row in range(3):
        x, y, z = one[a, 3 * row], one[a, 3 * row + 1], one[a, 3 * row + 2]
        for column in range(3):
            into[c, 3 * row + column] = x * other[b, column] + y * other[b, 3 + column] + z * other[b, 6 + column]
        into[c, 9 + row] = x * other[b, 9] + y * other[b, 10] + z * other[b, 11] + one[a, 9 + row]


@part
def _place(
    scene: Scene, positions: FloatArray, base: FloatArray, around: bool, joint_poses: FloatArray, poses: FloatArray
) -> None:
    """Write where everything is; see `place`."""
    work = np.zeros((2, 12))
    joint_poses[0] = scene.joint_frame[0]
    for k in range(1, scene.parent.size):
        x, y, z = scene.joint_axis[k, 0], scene.joint_axis[k, 1], scene.joint_axis[k, 2]
        value = positions[scene.motion[k]]
        if scene.slides[k] == 1:
            work[0, :] = 0.0
            work[0, 0] = work[0, 4] = work[0, 8] = 1.0
            work[0, 9], work[0, 10], work[0, 11] = value * x, value * y, value * z
        else:  # Rodrigues
            s, cosine = math.sin(value), math.cos(value)
            v = 1.0 - cosine
            work[0, 0], work[0, 1], work[0, 2] = cosine + v * x * x, v * x * y - s * z, v * x * z + s * y
            work[0, 3], work[0, 4], work[0, 5] = v * x * y + s * z, cosine + v * y * y, v * y * z - s * x
            work[0, 6], work[0, 7], work[0, 8] = v * x * z - s * y, v * y * z + s * x, cosine + v * z * z
            work[0, 9] = work[0, 10] = work[0, 11] = 0.0
        _compose(scene.joint_frame, k, work, 0, work, 1)
        _compose(joint_poses, scene.parent[k], work, 1, joint_poses, k)
    carried = scene.reach.shape[0] - 1
    for g in range(carried):
        _compose(joint_poses, scene.solid[g, 1], scene.frame, g, poses, g)
    if around:
        for row in range(3):
            for column in range(3):
                work[0, 3 * row + column] = base[3 * column + row]
            work[0, 9 + row] = -(base[row] * base[9] + base[3 + row] * base[10] + base[6 + row] * base[11])
        for g in range(carried, scene.solid.shape[0]):
            _compose(work, 0, scene.frame, g, poses, g)


@part
def _centre(form: FloatArray, g: int, poses: FloatArray) -> tuple[float, float, float]:
    """Centre of the ball around a shape."""
    x, y, z = form[g, 3], form[g, 4], form[g, 5]
    return (
        poses[g, 0] * x + poses[g, 1] * y + poses[g, 2] * z + poses[g, 9],
        poses[g, 3] * x + poses[g, 4] * y + poses[g, 5] * z + poses[g, 10],
        poses[g, 6] * x + poses[g, 7] * y + poses[g, 8] * z + poses[g, 11],
    )


@part
def _axis(scene: Scene, j: int, joint_poses: FloatArray) -> tuple[float, float, float]:
    """Axis of a joint."""
    x, y, z = scene.joint_axis[j, 0], scene.joint_axis[j, 1], scene.joint_axis[j, 2]
    return (
        joint_poses[j, 0] * x + joint_poses[j, 1] * y + joint_poses[j, 2] * z,
        joint_poses[j, 3] * x + joint_poses[j, 4] * y + joint_poses[j, 5] * z,
        joint_poses[j, 6] * x + joint_poses[j, 7] * y + joint_poses[j, 8] * z,
    )


@part
def _reach_here(scene: Scene, joint_poses: FloatArray, poses: FloatArray, reach: FloatArray) -> None:
    """Write how far points of shapes are from the axes of their joints at most, (c + 1, s)."""
    for g in range(reach.shape[0] - 1):
        x, y, z = _centre(scene.form, g, poses)
        for d in range(reach.shape[1]):
            j = scene.chain[g, d]
            reach[g, d] = scene.reach[g, d]
            # The base's shift stands for the base too, but is another motion than its turn.
            if reach[g, d] > 0.0 and scene.slides[j] == 0 and scene.lever[g, d] == scene.motion[j]:
                u, v, w = _axis(scene, j, joint_poses)
                a, b, c = x - joint_poses[j, 9], y - joint_poses[j, 10], z - joint_poses[j, 11]
                a, b, c = v * c - w * b, w * a - u * c, u * b - v * a
                reach[g, d] = min(reach[g, d], math.sqrt(a * a + b * b + c * c) + scene.form[g, 6])


@compiled
def place(
    whole: IntArray,
    numbers: FloatArray,
    positions: FloatArray,
    base: FloatArray,
    around: bool,
    joint_poses: FloatArray,
    poses: FloatArray,
    reach: FloatArray,
) -> None:
    """Write where everything is, in the frame of the base.

    Args:
        whole: See `packed`.
        numbers: See `packed`.
        positions: Of all joints, (nv,) [rad or m].
        base: Pose of the base in the world, (12,).
        around: Whether what stands in the world is to be placed too.
        joint_poses: Written, (j, 12).
        poses: Of all shapes, written, (g, 12).
        reach: How far points of shapes are from axes there, written, (c + 1, s).
    """
    scene = _views(whole, numbers)
    _place(scene, positions, base, around, joint_poses, poses)
    _reach_here(scene, joint_poses, poses, reach)


@part
def _sum_up(scene: Scene, reach: FloatArray, amounts: FloatArray, sums: FloatArray) -> None:
    """Write the sums of levers (c + 1, s + 1) for points as far from axes as (c + 1, s), and motions (nv + 2,)."""
    count = reach.shape[1]
    for g in range(reach.shape[0]):
        total = 0.0
        sums[g, count] = 0.0
        for d in range(count - 1, -1, -1):
            total += reach[g, d] * amounts[scene.lever[g, d]]
            sums[g, d] = total


@part
def _reach_along(scene: Scene, reach: FloatArray, amounts: FloatArray) -> FloatArray:
    """How far points may get from axes in motions (nv + 2,), if they are as far as `reach` when those begin.

    What joints behind an axis move a point by is all that brings it farther from that axis.
    """
    farthest = np.empty(reach.shape)
    for g in range(reach.shape[0]):
        total = 0.0
        for d in range(reach.shape[1] - 1, -1, -1):
            farthest[g, d] = min(scene.reach[g, d], reach[g, d] + total)
            total += farthest[g, d] * amounts[scene.lever[g, d]]
    return farthest


@part
def _lower(scene: Scene, reach: FloatArray, amounts: FloatArray, bounds: FloatArray, exact: BoolArray) -> None:
    """Take from bounds (k,) what motions (nv + 2,) may take from distances, which are not exact any more."""
    sums = np.empty((reach.shape[0], reach.shape[1] + 1))
    _sum_up(scene, _reach_along(scene, reach, amounts), amounts, sums)
    each = sums.ravel()
    for k in range(bounds.size):
        if exact[k]:
            bounds[k] -= INACCURACY
            exact[k] = False
        bounds[k] -= each[scene.one[k]] + each[scene.other[k]]


@compiled
def lower(
    whole: IntArray,
    numbers: FloatArray,
    placed: bool,
    reach: FloatArray,
    before: FloatArray,
    after: FloatArray,
    shift: float,
    turn: float,
    bounds: FloatArray,
    exact: BoolArray,
) -> bool:
    """Take from bounds what a motion may take from distances; returns whether there was any.

    Args:
        whole: See `packed`.
        numbers: See `packed`.
        placed: Whether `reach` is true of what was before.
        reach: How far points are from axes, (c + 1, s).
        before: Positions of all joints, (nv,) [rad or m].
        after: Where they go, (nv,).
        shift: How far the base goes [m].
        turn: How far it turns [rad].
        bounds: Written, (k,).
        exact: Which were distances: they are bounds from now on, (k,).
    """
    amounts = np.empty(before.size + 2)
    amounts[before.size], amounts[before.size + 1] = shift, turn
    moves = shift != 0.0 or turn != 0.0
    for column in range(before.size):
        amounts[column] = abs(after[column] - before[column])
        moves = moves or amounts[column] != 0.0
    if moves:
        scene = _views(whole, numbers)
        _lower(scene, reach if placed else scene.reach, amounts, bounds, exact)
    return moves


@part
def _farthest(
    solid: IntArray, form: FloatArray, points: FloatArray, g: int, poses: FloatArray, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """The point of a shape that is farthest in a direction."""
    u = poses[g, 0] * x + poses[g, 3] * y + poses[g, 6] * z
    v = poses[g, 1] * x + poses[g, 4] * y + poses[g, 7] * z
    w = poses[g, 2] * x + poses[g, 5] * y + poses[g, 8] * z
    kind = solid[g, 0]
    if kind == CLOUD:
        best, most = solid[g, 2], -np.inf
        for k in range(solid[g, 2], solid[g, 3]):
            value = points[k, 0] * u + points[k, 1] * v + points[k, 2] * w
            if value > most:
                best, most = k, value
        u, v, w = points[best, 0], points[best, 1], points[best, 2]
    elif kind == BOX:
        u = math.copysign(form[g, 0], u)
        v = math.copysign(form[g, 1], v)
        w = math.copysign(form[g, 2], w)
    elif kind == SPHERE:
        factor = form[g, 0] / math.sqrt(u * u + v * v + w * w)
        u, v, w = factor * u, factor * v, factor * w
    else:
        across = math.sqrt(u * u + v * v)
        factor = form[g, 0] / across if across > 1e-12 else 0.0
        u, v, w = factor * u, factor * v, math.copysign(form[g, 1], w)
    return (
        poses[g, 0] * u + poses[g, 1] * v + poses[g, 2] * w + poses[g, 9],
        poses[g, 3] * u + poses[g, 4] * v + poses[g, 5] * w + poses[g, 10],
        poses[g, 6] * u + poses[g, 7] * v + poses[g, 8] * w + poses[g, 11],
    )


@part
def _nearest(corners: FloatArray, count: int) -> int:
    """Bring corners (5, 3) down to those that span their point nearest to the origin, which is written as the last row.

    The last of the corners is new: the point is on it, or on what it spans with some of the up to three others. Where
    four are all around the origin, three of them are kept: the bound stays negative then.

    Returns:
        How many are kept, as the first rows.
    """
    new = count - 1
    a, b, c = corners[new, 0], corners[new, 1], corners[new, 2]
    best = a * a + b * b + c * c
    keep, i, j = 1, 0, 0
    x, y, z = a, b, c
    for k in range(new):
        e, f, g = corners[k, 0] - a, corners[k, 1] - b, corners[k, 2] - c
        size = e * e + f * f + g * g
        part = -(a * e + b * f + c * g)
        if 0.0 < part < size:
            part /= size
            u, v, w = a + part * e, b + part * f, c + part * g
            square = u * u + v * v + w * w
            if square < best:
                best, keep, i, x, y, z = square, 2, k, u, v, w
        for m in range(k + 1, new):
            h, o, p = corners[m, 0] - a, corners[m, 1] - b, corners[m, 2] - c
            cross, other = e * h + f * o + g * p, h * h + o * o + p * p
            first, second = -(a * e + b * f + c * g), -(a * h + b * o + c * p)
            area = size * other - cross * cross
            if area <= 1e-12 * size * other:  # nearly a line: its ends are looked at
                continue
            s, t = (first * other - second * cross) / area, (second * size - first * cross) / area
            if s > 0.0 and t > 0.0 and s + t < 1.0:
                u, v, w = a + s * e + t * h, b + s * f + t * o, c + s * g + t * p
                square = u * u + v * v + w * w
                if square < best:
                    best, keep, i, j, x, y, z = square, 3, k, m, u, v, w
    corners[4, 0], corners[4, 1], corners[4, 2] = x, y, z
    if keep > 1 and i != 0:
        corners[0, 0], corners[0, 1], corners[0, 2] = corners[i, 0], corners[i, 1], corners[i, 2]
    if keep > 2 and j != 1:
        corners[1, 0], corners[1, 1], corners[1, 2] = corners[j, 0], corners[j, 1], corners[j, 2]
    corners[keep - 1, 0], corners[keep - 1, 1], corners[keep - 1, 2] = a, b, c
    return keep


@part
def _gap(
    solid: IntArray,
    form: FloatArray,
    points: FloatArray,
    plane: FloatArray,
    k: int,
    a: int,
    b: int,
    poses: FloatArray,
    enough: float,
    fair: float,
    hopeless: float,
    spare: float,
    corners: FloatArray,
) -> float:
    """What the distance of a pair is at least [m]; negative where no plane was found between the two.

    Args:
        solid: See `Scene`.
        form: See `Scene`.
        points: See `Scene`.
        plane: See `Scene`; where a better one is found, it is kept.
        k: Which pair.
        a: Its first shape.
        b: Its second.
        poses: Of all shapes, (g, 12).
        enough: The search ends when at least so much is sure [m],
        fair: or when the first plane that is looked at shows this [m],
        hopeless: or when they are nearer than this [m].
        spare: So much more than enough is enough for not looking closer than at the balls around them [m].
        corners: Room, (5, 3).
    """
    ax, ay, az = _centre(form, a, poses)
    x, y, z = _centre(form, b, poses)
    x, y, z = x - ax, y - ay, z - az
    length = math.sqrt(x * x + y * y + z * z)
    best = length - form[a, 6] - form[b, 6] - INACCURACY
    if best >= enough + spare:
        return float(best)
    u, v, w = plane[k, 0], plane[k, 1], plane[k, 2]
    c = a if form[a, 6] > form[b, 6] else b
    if u != 0.0 or v != 0.0 or w != 0.0:
        x = poses[c, 0] * u + poses[c, 1] * v + poses[c, 2] * w
        y = poses[c, 3] * u + poses[c, 4] * v + poses[c, 5] * w
        z = poses[c, 6] * u + poses[c, 7] * v + poses[c, 8] * w
        length = math.sqrt(x * x + y * y + z * z)
    count = 0
    for _ in range(ROUNDS):
        if length < 1e-9:  # they overlap
            break
        x, y, z = x / length, y / length, z / length
        ax, ay, az = _farthest(solid, form, points, a, poses, x, y, z)
        u, v, w = _farthest(solid, form, points, b, poses, -x, -y, -z)
        u, v, w = u - ax, v - ay, w - az
        found = u * x + v * y + w * z - INACCURACY
        if found > best:
            best = found
            plane[k, 0] = poses[c, 0] * x + poses[c, 3] * y + poses[c, 6] * z
            plane[k, 1] = poses[c, 1] * x + poses[c, 4] * y + poses[c, 7] * z
            plane[k, 2] = poses[c, 2] * x + poses[c, 5] * y + poses[c, 8] * z
        if (
            best >= enough
            or (count == 0 and best >= fair)
            or (count > 0 and found > (1.0 - CONVERGED) * length - 1.1 * INACCURACY)
        ):
            break
        corners[count, 0], corners[count, 1], corners[count, 2] = u, v, w
        count = _nearest(corners, count + 1)
        x, y, z = corners[4, 0], corners[4, 1], corners[4, 2]
        length = math.sqrt(x * x + y * y + z * z)
        if length < hopeless:  # two of their points are nearer
            break
    return float(best)


@part
def _of_pairs(scene: Scene) -> tuple[IntArray, FloatArray, FloatArray, FloatArray, IntArray, IntArray]:
    """What loops over pairs need: handing over a whole scene each time takes longer than they do."""
    return scene.solid, scene.form, scene.points, scene.plane, scene.first, scene.second


@part
def _sift(
    scene: Scene,
    poses: FloatArray,
    bounds: FloatArray,
    exact: BoolArray,
    which: IntArray,
    thresholds: FloatArray,
) -> IntArray:
    """See `sift`."""
    solid, form, points, plane, first, second = _of_pairs(scene)
    count, corners = 0, np.empty((5, 3))
    left = np.empty(which.size, dtype=np.int64)
    for k in which:
        if not exact[k]:
            found = _gap(
                solid,
                form,
                points,
                plane,
                k,
                first[k],
                second[k],
                poses,
                thresholds[k],
                thresholds[k],
                thresholds[k],
                SPARE,
                corners,
            )
            bounds[k] = max(bounds[k], found)
        if bounds[k] < thresholds[k]:
            left[count] = k
            count += 1
    return left[:count]


@part
def _below(bounds: FloatArray, thresholds: FloatArray) -> IntArray:
    """Pairs whose bounds are below thresholds."""
    found = np.empty(bounds.size, dtype=np.int64)
    count = 0
    for k in range(bounds.size):
        if bounds[k] < thresholds[k]:
            found[count] = k
            count += 1
    return found[:count]


@compiled
def sift(
    whole: IntArray,
    numbers: FloatArray,
    poses: FloatArray,
    bounds: FloatArray,
    exact: BoolArray,
    which: IntArray,
    thresholds: FloatArray,
) -> IntArray:
    """Pairs that are not known to be as far apart as thresholds (k,), after raising what bounds say as need be.

    Args:
        whole: See `packed`.
        numbers: See `packed`.
        poses: Of all shapes, (g, 12).
        bounds: Raised, (k,).
        exact: Which are distances, and stay, (k,).
        which: Pairs to look at, (w,); none for all.
        thresholds: (k,) [m].
    """
    if which.size == 0:
        which = _below(bounds, thresholds)
    return _sift(_views(whole, numbers), poses, bounds, exact, which, thresholds)


@part
def _shrinking(
    scene: Scene, k: int, joint_poses: FloatArray, poses: FloatArray, amounts: FloatArray, x: float, y: float, z: float
) -> float:
    """What motions (nv + 2,) take from the distance of a pair at most, to first order, if it is along a direction.

    Nothing is assumed about where on the moved shape the nearest point is: anywhere in the ball around it.
    """
    width = scene.reach.shape[1] + 1
    found = 0.0
    for side in range(2):
        cell = scene.one[k] if side == 0 else scene.other[k]
        g, behind = cell // width, cell % width
        if g == scene.reach.shape[0] - 1:  # it is around
            continue
        px, py, pz = _centre(scene.form, g, poses)
        for d in range(behind, width - 1):
            if scene.reach[g, d] == 0.0:
                break
            amount, j = amounts[scene.lever[g, d]], scene.chain[g, d]
            if amount == 0.0:
                continue
            if scene.lever[g, d] != scene.motion[j]:  # the base's shift is along its first axis
                found += amount * abs(x)
                continue
            u, v, w = _axis(scene, j, joint_poses)
            if scene.slides[j] == 1:
                found += amount * abs(u * x + v * y + w * z)
                continue
            rx, ry, rz = px - joint_poses[j, 9], py - joint_poses[j, 10], pz - joint_poses[j, 11]
            u, v, w = v * z - w * y, w * x - u * z, u * y - v * x
            found += amount * (abs(u * rx + v * ry + w * rz) + scene.form[g, 6] * math.sqrt(u * u + v * v + w * w))
    return found


@compiled
def approached(
    whole: IntArray,
    numbers: FloatArray,
    joint_poses: FloatArray,
    poses: FloatArray,
    reach: FloatArray,
    bounds: FloatArray,
    exact: BoolArray,
    amounts: FloatArray,
    matrix: FloatArray,
    most: float,
    offsets: FloatArray,
) -> tuple[IntArray, FloatArray]:
    """Pairs that may be nearer than motions take from their distances at most, to first order, and offsets.

    Which these are depends on nothing but the posture, although bounds depend on what was before: the direction of a
    distance is sought anew each time.

    Args:
        whole: See `packed`.
        numbers: See `packed`.
        joint_poses: Of all joints, (j, 12).
        poses: Of all shapes, (g, 12).
        reach: How far points are from axes, (c + 1, s).
        bounds: Raised, (k,).
        exact: Which are distances, and stay, (k,).
        amounts: Sizes of motions of driven joints, (n,), or also of the base, (n + 2,).
        matrix: How driven joints move all, (nv, n).
        most: What motions take from a distance counts up to this [m].
        offsets: (k,) [m].

    Returns:
        These pairs, and for each of all the distance up to which it counts as near, (k,) [m].
    """
    scene = _views(whole, numbers)
    nv, n = matrix.shape
    all_amounts = np.zeros(nv + 2)
    for row in range(nv):
        for column in range(n):
            all_amounts[row] += abs(matrix[row, column]) * amounts[column]
    for column in range(n, amounts.size):
        all_amounts[nv + column - n] = amounts[column]
    sums = np.empty((reach.shape[0], reach.shape[1] + 1))
    _sum_up(scene, reach, all_amounts, sums)
    each, thresholds = sums.ravel(), np.empty(offsets.size)
    for k in range(offsets.size):
        thresholds[k] = offsets[k] + min(each[scene.one[k]] + each[scene.other[k]], most)
    solid, form, points, _, first, second = _of_pairs(scene)
    corners, plane = np.empty((5, 3)), np.empty((1, 3))
    which = _sift(scene, poses, bounds, exact, _below(bounds, thresholds), thresholds)
    count = 0
    for k in which:
        a, b = first[k], second[k]
        plane[0, :] = 0.0
        apart = _gap(solid, form, points, plane, 0, a, b, poses, np.inf, np.inf, -np.inf, 0.0, corners)
        if apart > 0.0:
            c = a if form[a, 6] > form[b, 6] else b
            u, v, w = plane[0, 0], plane[0, 1], plane[0, 2]
            x = poses[c, 0] * u + poses[c, 1] * v + poses[c, 2] * w
            y = poses[c, 3] * u + poses[c, 4] * v + poses[c, 5] * w
            z = poses[c, 6] * u + poses[c, 7] * v + poses[c, 8] * w
            rough = each[scene.one[k]] + each[scene.other[k]]
            fine = _shrinking(scene, k, joint_poses, poses, all_amounts, x, y, z) + SLANT * rough
            if apart >= offsets[k] + min(fine, most):
                continue
        which[count] = k
        count += 1
    return which[:count], thresholds


@part
def _travel(matrix: FloatArray, here: FloatArray, way: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Positions of all joints behind each stretch of a way, (m, nv), and sizes of all motions on each, (m, nv + 2)."""
    m, (nv, n) = way.shape[0], matrix.shape
    along, travel = np.empty((m, nv)), np.zeros((m, nv + 2))
    for stretch in range(m):
        for row in range(nv):
            along[stretch, row] = here[row]
            for column in range(n):
                if matrix[row, column] != 0.0:
                    along[stretch, row] += matrix[row, column] * way[stretch, column]
            travel[stretch, row] = abs(along[stretch, row] - (along[stretch - 1, row] if stretch > 0 else here[row]))
        for column in range(n, way.shape[1]):
            before = way[stretch - 1, column] if stretch > 0 else 0.0
            travel[stretch, nv + column - n] = abs(way[stretch, column] - before)
    return along, travel


@part
def _sift_way(
    scene: Scene,
    which: IntArray,
    now_poses: FloatArray,
    start: FloatArray,
    start_exact: BoolArray,
    end_poses: FloatArray,
    end: FloatArray,
    end_exact: BoolArray,
    along: FloatArray,
    bases: FloatArray,
    sums: FloatArray,
    least: FloatArray,
) -> tuple[IntArray, IntArray, IntArray]:
    """See `look_ahead` for all of it.

    The way is halved, and halved again, as often as it takes. What bounds say of its ends is mostly good enough for
    that, so that it is only improved where a little is missing, or where nothing else helps.
    """
    solid, form, points, plane, first_of, second_of = _of_pairs(scene)
    m, corners = along.shape[0], np.empty((5, 3))
    joint_poses, poses = np.empty((scene.parent.size, 12)), np.empty((m, solid.shape[0], 12))
    placed, bounds = np.zeros(m, dtype=np.bool_), np.empty(m + 1)
    firsts, lasts = np.empty(m + 1, dtype=np.int64), np.empty(m + 1, dtype=np.int64)
    near, left, where = np.empty_like(which), np.empty_like(which), np.empty_like(which)
    ends = unsure = 0
    for k in which:
        a, b, one, other, keep = first_of[k], second_of[k], scene.one[k], scene.other[k], least[k]
        whole = sums[m, one] + sums[m, other]
        missing = 2.0 * keep + whole - start[k] - end[k]
        for attempt in range(2):
            again = attempt == 1
            # What is known of the end must do for standing there, too.
            if not end_exact[k] and (end[k] < keep or missing < LITTLE or again):
                fair = np.inf if again else keep
                found = _gap(
                    *(solid, form, points, plane, k, a, b, end_poses), end[k] + missing, fair, keep, SPARE, corners
                )
                end[k] = max(end[k], found)
            missing = 2.0 * keep + whole - start[k] - end[k]
            if not start_exact[k] and missing > 0.0 and (missing < LITTLE or again):
                fair = np.inf if again else keep
                found = _gap(
                    *(solid, form, points, plane, k, a, b, now_poses), start[k] + missing, fair, keep, SPARE, corners
                )
                start[k] = max(start[k], found)
            if end[k] < keep:
                break
            bounds[0], bounds[m] = start[k], end[k]
            firsts[0], lasts[0], waiting = 0, m, 1
            failed = -1
            while waiting > 0 and failed < 0:
                waiting -= 1
                first, last = firsts[waiting], lasts[waiting]
                behind, ahead = sums[first, one] + sums[first, other], sums[last, one] + sums[last, other]
                if bounds[first] + bounds[last] - (ahead - behind) >= 2.0 * keep:
                    continue
                if last - first == 1:
                    failed = first
                    continue
                middle = (first + last) // 2
                if not placed[middle]:
                    placed[middle] = True
                    _place(scene, along[middle - 1], bases[middle - 1], True, joint_poses, poses[middle])
                between = sums[middle, one] + sums[middle, other]
                enough = 2.0 * keep + max(between - behind - bounds[first], ahead - between - bounds[last])
                bounds[middle] = _gap(
                    *(solid, form, points, plane, k, a, b, poses[middle]), enough, enough, keep, 0.0, corners
                )
                firsts[waiting], lasts[waiting] = first, middle
                firsts[waiting + 1], lasts[waiting + 1] = middle, last
                waiting += 2
            if failed < 0:
                break
            if again or (end_exact[k] and start_exact[k]):
                left[unsure], where[unsure] = k, failed
                unsure += 1
                break
            missing = 1.0  # more than there is: improve what is known of both ends as far as it goes
        if end[k] < keep:
            near[ends] = k
            ends += 1
    return near[:ends], left[:unsure], where[:unsure]


@compiled
def look_ahead(
    whole: IntArray,
    numbers: FloatArray,
    matrix: FloatArray,
    here: FloatArray,
    way: FloatArray,
    bases: FloatArray,
    now_poses: FloatArray,
    now_reach: FloatArray,
    now_bounds: FloatArray,
    now_exact: BoolArray,
    around: bool,
    joint_poses: FloatArray,
    poses: FloatArray,
    reach: FloatArray,
    bounds: FloatArray,
    exact: BoolArray,
    least: FloatArray,
) -> tuple[IntArray, IntArray, IntArray, FloatArray, FloatArray]:
    """Which pairs bounds do not show to keep distances at the end of a way, and along it.

    Half-way, a pair is at least so far apart: what both ends say, less what lies between.

    Args:
        whole: See `packed`.
        numbers: See `packed`.
        matrix: How driven joints move all, (nv, n).
        here: Positions of all joints where the way begins, (nv,).
        way: How far driven joints, or also the base, are behind each of m stretches, (m, d).
        bases: Poses of the base then, (m, 12).
        now_poses: Of all shapes where the way begins, (g, 12).
        now_reach: How far points are from axes there, (c + 1, s).
        now_bounds: Of distances there, raised, (k,) [m].
        now_exact: Which of these are distances, (k,).
        around: Whether what stands in the world is to be placed at the end, too.
        joint_poses: Of all joints at the end, written, (j, 12).
        poses: Of all shapes at the end, written, (g, 12).
        reach: How far points are from axes at the end, written, (c + 1, s).
        bounds: Of distances there, raised, (k,) [m].
        exact: Which of these are distances, (k,).
        least: Distances to keep, (k,) [m].

    Returns:
        Pairs that may be too near at the end; others that may pass too near, and a stretch for each, 0 to m - 1, on
        which they may; positions of all joints behind each stretch, (m, nv); sums of levers for the first 0 to m
        stretches, (m + 1, (c + 1) (s + 1)).
    """
    scene, m = _views(whole, numbers), way.shape[0]
    along, travel = _travel(matrix, here, way)
    total = np.zeros(travel.shape[1])
    for stretch in range(m):
        total += travel[stretch]
    farthest = _reach_along(scene, now_reach, total)
    sums = np.zeros((m + 1, reach.shape[0], reach.shape[1] + 1))
    _sum_up(scene, farthest, total, sums[m])
    each = sums.reshape(m + 1, reach.shape[0] * (reach.shape[1] + 1))
    end, needed = each[m], np.empty(least.size)
    for k in range(least.size):
        gone = end[scene.one[k]] + end[scene.other[k]]
        needed[k] = max(2.0 * least[k] + gone - now_bounds[k], least[k])
        bounds[k] = max(bounds[k], now_bounds[k] - gone - INACCURACY)
    _place(scene, along[m - 1], bases[m - 1], around, joint_poses, poses)
    _reach_here(scene, joint_poses, poses, reach)
    which, where = _below(bounds, needed), np.empty(0, dtype=np.int64)
    near = which[:0]
    if which.size > 0:
        for stretch in range(m):
            _sum_up(scene, farthest, travel[stretch], sums[stretch + 1])
            sums[stretch + 1] += sums[stretch]
        near, which, where = _sift_way(
            *(scene, which, now_poses, now_bounds, now_exact, poses, bounds, exact), along, bases, each, least
        )
    return near, which, where, along, each


@compiled
def keep_planes(whole: IntArray, numbers: FloatArray, which: IntArray, poses: FloatArray, normals: FloatArray) -> None:
    """Keep the planes across directions (k, 3) from the first of each pair to the second."""
    scene = _views(whole, numbers)
    for k in which:
        a, b = scene.first[k], scene.second[k]
        c = a if scene.form[a, 6] > scene.form[b, 6] else b
        for column in range(3):
            scene.plane[k, column] = (
                poses[c, column] * normals[k, 0]
                + poses[c, 3 + column] * normals[k, 1]
                + poses[c, 6 + column] * normals[k, 2]
            )


@compiled
def gradients(
    whole: IntArray,
    numbers: FloatArray,
    joint_poses: FloatArray,
    which: IntArray,
    normals: FloatArray,
    points: FloatArray,
    matrix: FloatArray,
) -> FloatArray:
    """How fast distances grow for each unit of speed, (w, n + 2): of driven joints, base's speed and turn.

    Args:
        whole: See `packed`.
        numbers: See `packed`.
        joint_poses: Of all joints, (j, 12).
        which: Pairs asked for, (w,).
        normals: Directions from first to second, (k, 3).
        points: Nearest points, (k, 3) [m].
        matrix: How driven joints move all, (nv, n).
    """
    scene, n = _views(whole, numbers), matrix.shape[1]
    rows, width = np.zeros((which.size, n + 2)), scene.reach.shape[1] + 1
    for row in range(which.size):
        k = which[row]
        x, y, z = normals[k, 0], normals[k, 1], normals[k, 2]
        px, py, pz = points[k, 0], points[k, 1], points[k, 2]
        # Joints that carry both do not count, nor does the base for what it carries; it is no row of the matrix.
        for side in range(2):
            cell = scene.one[k] if side == 0 else scene.other[k]
            g, behind = cell // width, cell % width
            for d in range(max(behind, 2), width - 1):
                if scene.reach[g, d] == 0.0:
                    break
                j = scene.chain[g, d]
                u, v, w = _axis(scene, j, joint_poses)
                if scene.slides[j] == 0:
                    rx, ry, rz = px - joint_poses[j, 9], py - joint_poses[j, 10], pz - joint_poses[j, 11]
                    u, v, w = v * rz - w * ry, w * rx - u * rz, u * ry - v * rx
                value = x * u + y * v + z * w
                for driven in range(n):
                    factor = matrix[scene.motion[j], driven]
                    rows[row, driven] += factor * value if side == 1 else -factor * value
        if scene.second[k] >= scene.reach.shape[0] - 1:
            rows[row, n] = -x
            rows[row, n + 1] = -(px * y - py * x)
    return rows
