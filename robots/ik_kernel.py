"""The inner loop of inverse kinematics, compiled by Numba when it is first used and kept on disk from then on.

One step costs about a microsecond, where calls from Python into a library cost seven. All of it is in one file, since
Numba compiles anew what is in a file that changed, but not what calls it from another. Arrays are laid out for it:

- joints, (m, 19): rotation and translation to the joint's frame (9 + 3), axis (3), 1 for a sliding joint, the index of
  the driven joint that it follows, ratio and offset of that. Chains only: each joint carries the next.
- pose, (12,): rotation matrix, row by row, then position [m].
- mask, (7,): which of the six axes count, and 1 if they are the target's own, 0 if the base's.
- bounds, (2, n): lower and upper limits.
- tolerances, (3,): position [m], orientation [rad], and the square of the length [m²] that weighs as much as a radian.

See `TaskMask` for what a mask means, and `descend` for the method.
"""

import math
from collections.abc import Callable
from typing import TypeVar, cast

import numba
import numpy as np
from numpy.typing import NDArray

from .pose import FloatArray

IntArray = NDArray[np.int64]

STEP_LIMIT = 1.0
"""Longest step over all joints [rad or m]: the linearization is poor beyond it."""
DAMPING = 0.03
"""Damping per squared error [1/rad²]: strong far away, gone at the solution (Sugihara 2011)."""
LEAST_DAMPING = 1e-9
"""Damping that keeps singular postures solvable [m²/rad²]."""
PROGRESS = 0.7
"""A step is worth while if it brings the squared error below this part of the best."""

Function = TypeVar("Function", bound=Callable[..., object])


def compiled(function: Function) -> Function:
    """Compile a function; mypy goes on seeing its types."""
    try:
        return cast(Function, numba.njit(cache=True)(function))
    except RuntimeError:  # there is no folder that could keep it
        return cast(Function, numba.njit(function))


@compiled
def _forward(joints: FloatArray, tool: FloatArray, q: FloatArray, work: FloatArray, pose: FloatArray) -> None:
    """Write the tool's pose (12,), and world axis and origin of each joint into work (m, 6)."""
    a, b, c, d, e, f, g, h, i = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    x, y, z = 0.0, 0.0, 0.0
    for k in range(joints.shape[0] + 1):
        t = joints[k] if k < joints.shape[0] else tool
        px, py, pz = t[9], t[10], t[11]
        x, y, z = x + a * px + b * py + c * pz, y + d * px + e * py + f * pz, z + g * px + h * py + i * pz
        a, b, c = a * t[0] + b * t[3] + c * t[6], a * t[1] + b * t[4] + c * t[7], a * t[2] + b * t[5] + c * t[8]
        d, e, f = d * t[0] + e * t[3] + f * t[6], d * t[1] + e * t[4] + f * t[7], d * t[2] + e * t[5] + f * t[8]
        g, h, i = g * t[0] + h * t[3] + i * t[6], g * t[1] + h * t[4] + i * t[7], g * t[2] + h * t[5] + i * t[8]
        if k == joints.shape[0]:
            break
        ux, uy, uz = t[12], t[13], t[14]
        value = t[17] * q[int(t[16])] + t[18]
        wx, wy, wz = a * ux + b * uy + c * uz, d * ux + e * uy + f * uz, g * ux + h * uy + i * uz
        work[k, 0], work[k, 1], work[k, 2] = wx, wy, wz
        work[k, 3], work[k, 4], work[k, 5] = x, y, z
        if t[15] > 0.0:
            x, y, z = x + wx * value, y + wy * value, z + wz * value
        else:  # Rodrigues
            s, cosine = math.sin(value), math.cos(value)
            v = 1.0 - cosine
            r0, r1, r2 = cosine + v * ux * ux, v * ux * uy - s * uz, v * ux * uz + s * uy
            r3, r4, r5 = v * ux * uy + s * uz, cosine + v * uy * uy, v * uy * uz - s * ux
            r6, r7, r8 = v * ux * uz - s * uy, v * uy * uz + s * ux, cosine + v * uz * uz
            a, b, c = a * r0 + b * r3 + c * r6, a * r1 + b * r4 + c * r7, a * r2 + b * r5 + c * r8
            d, e, f = d * r0 + e * r3 + f * r6, d * r1 + e * r4 + f * r7, d * r2 + e * r5 + f * r8
            g, h, i = g * r0 + h * r3 + i * r6, g * r1 + h * r4 + i * r7, g * r2 + h * r5 + i * r8
    pose[0], pose[1], pose[2], pose[3], pose[4], pose[5] = a, b, c, d, e, f
    pose[6], pose[7], pose[8], pose[9], pose[10], pose[11] = g, h, i, x, y, z


@compiled
def _fill_jacobian(joints: FloatArray, work: FloatArray, pose: FloatArray, jacobian: FloatArray) -> None:
    """Write the Jacobian (6, n) along the axes of the base: linear, then angular rows."""
    jacobian[:] = 0.0
    for k in range(joints.shape[0]):
        column, ratio = int(joints[k, 16]), joints[k, 17]
        wx, wy, wz = ratio * work[k, 0], ratio * work[k, 1], ratio * work[k, 2]
        if joints[k, 15] > 0.0:
            jacobian[0, column] += wx
            jacobian[1, column] += wy
            jacobian[2, column] += wz
        else:
            x, y, z = pose[9] - work[k, 3], pose[10] - work[k, 4], pose[11] - work[k, 5]
            jacobian[0, column] += wy * z - wz * y
            jacobian[1, column] += wz * x - wx * z
            jacobian[2, column] += wx * y - wy * x
            jacobian[3, column] += wx
            jacobian[4, column] += wy
            jacobian[5, column] += wz


@compiled
def _rotation_vector(r: FloatArray, vector: FloatArray) -> None:
    """Write axis times angle (3,) of a rotation matrix (3, 3); through a quaternion, exact at half a turn too."""
    trace = r[0, 0] + r[1, 1] + r[2, 2]
    if trace > 0.0:
        w = 0.5 * math.sqrt(1.0 + trace)
        x, y, z = (r[2, 1] - r[1, 2]) / (4 * w), (r[0, 2] - r[2, 0]) / (4 * w), (r[1, 0] - r[0, 1]) / (4 * w)
    elif r[0, 0] >= r[1, 1] and r[0, 0] >= r[2, 2]:
        x = 0.5 * math.sqrt(max(0.0, 1.0 + r[0, 0] - r[1, 1] - r[2, 2]))
        w, y, z = (r[2, 1] - r[1, 2]) / (4 * x), (r[0, 1] + r[1, 0]) / (4 * x), (r[0, 2] + r[2, 0]) / (4 * x)
    elif r[1, 1] >= r[2, 2]:
        y = 0.5 * math.sqrt(max(0.0, 1.0 - r[0, 0] + r[1, 1] - r[2, 2]))
        w, x, z = (r[0, 2] - r[2, 0]) / (4 * y), (r[0, 1] + r[1, 0]) / (4 * y), (r[1, 2] + r[2, 1]) / (4 * y)
    else:
        z = 0.5 * math.sqrt(max(0.0, 1.0 - r[0, 0] - r[1, 1] + r[2, 2]))
        w, x, y = (r[1, 0] - r[0, 1]) / (4 * z), (r[0, 2] + r[2, 0]) / (4 * z), (r[1, 2] + r[2, 1]) / (4 * z)
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    sine = math.sqrt(x * x + y * y + z * z)
    scale = 2.0 * math.atan2(sine, w) / sine if sine > 1e-12 else 2.0
    vector[0], vector[1], vector[2] = scale * x, scale * y, scale * z


@compiled
def _shortest_rotation(start: FloatArray, end: FloatArray, vector: FloatArray) -> None:
    """Write the rotation vector (3,) that turns one unit vector (3,) into another."""
    x = start[1] * end[2] - start[2] * end[1]
    y = start[2] * end[0] - start[0] * end[2]
    z = start[0] * end[1] - start[1] * end[0]
    sine = math.sqrt(x * x + y * y + z * z)
    angle = math.atan2(sine, start[0] * end[0] + start[1] * end[1] + start[2] * end[2])
    if sine < 1e-12 and angle > 1.0:  # opposite: any axis across will do
        least = np.argmin(np.abs(start))
        other, third = (least + 1) % 3, (least + 2) % 3
        vector[least], vector[other], vector[third] = 0.0, -start[third], start[other]
        length = math.sqrt(start[third] ** 2 + start[other] ** 2)
        vector *= angle / length
        return
    scale = angle / sine if sine > 1e-12 else 1.0
    vector[0], vector[1], vector[2] = scale * x, scale * y, scale * z


@compiled
def _turn_rows(rotation: FloatArray, rows: FloatArray) -> None:
    """Replace rows (3, k) by rotationᵀ (3, 3) times them."""
    for column in range(rows.shape[1]):
        x, y, z = rows[0, column], rows[1, column], rows[2, column]
        for row in range(3):
            rows[row, column] = rotation[0, row] * x + rotation[1, row] * y + rotation[2, row] * z


@compiled
def _rotation_part(
    mask: IntArray, target: FloatArray, rotation: FloatArray, vector: FloatArray, rows: FloatArray
) -> None:
    """Write the rotation (3,) from tool to target, and bring angular rows (3, n) to its axes.

    Args:
        mask: See above.
        target: Wanted rotation, (3, 3).
        rotation: The tool's, (3, 3).
        vector: Written.
        rows: Angular rows of the Jacobian along the axes of the base; those of the mask afterwards.
    """
    count = mask[3] + mask[4] + mask[5]
    in_tool = mask[6] == 1 and count < 3
    if in_tool:
        _turn_rows(rotation, rows)
    if count == 2:
        # An axis points the right way when it is turned there the shortest way, which is not about itself.
        free = 0 if mask[3] == 0 else (1 if mask[4] == 0 else 2)
        start, end = np.zeros(3), np.zeros(3)
        for row in range(3):
            for k in range(3):
                if in_tool:
                    end[row] += rotation[k, row] * target[k, free]
                else:
                    start[row] += rotation[row, k] * target[free, k]
        if in_tool:
            start[free] = 1.0
        else:
            end[free] = 1.0
        _shortest_rotation(start, end, vector)
        return
    between = np.zeros((3, 3))
    for row in range(3):
        for column in range(3):
            for k in range(3):
                if in_tool:
                    between[row, column] += rotation[k, row] * target[k, column]
                else:
                    between[row, column] += target[row, k] * rotation[column, k]
    _rotation_vector(between, vector)
    if count == 1:
        # d log(E exp(-w)) = -Jlog(E) w, and d log(exp(-w) E) = -Jlog(Eᵀ) w (Solà, Deray and Atchuthan 2018). All three
        # rows at once need it not, since Jlog maps the vector to itself.
        x, y, z = vector[0], vector[1], vector[2]
        angle = math.sqrt(x * x + y * y + z * z)
        half = -0.5 if in_tool else 0.5
        square = 1.0 / 12.0
        if angle > 1e-3:
            square = 1.0 / angle**2 - (1.0 + math.cos(angle)) / (2.0 * angle * math.sin(angle))
        for column in range(rows.shape[1]):
            u, v, w = rows[0, column], rows[1, column], rows[2, column]
            cu, cv, cw = y * w - z * v, z * u - x * w, x * v - y * u
            rows[0, column] += half * cu + square * (y * cw - z * cv)
            rows[1, column] += half * cv + square * (z * cu - x * cw)
            rows[2, column] += half * cw + square * (x * cv - y * cu)


@compiled
def linearize(
    joints: FloatArray,
    tool: FloatArray,
    mask: IntArray,
    target: FloatArray,
    q: FloatArray,
    work: FloatArray,
    pose: FloatArray,
    residual: FloatArray,
    jacobian: FloatArray,
) -> int:
    """Write what a mask leaves of the way to a target, and its Jacobian, into their first m rows.

    Args:
        joints: See above, as for tool, mask and target.
        tool: Pose of the tool in the last joint's frame.
        mask: What counts.
        target: Wanted pose in the base.
        q: Posture, (n,).
        work: Room, (m, 6).
        pose: The tool's pose is written here, (12,).
        residual: Written, (6,).
        jacobian: Written, (6, n): to first order, J dq = residual leads to the target.

    Returns:
        How many rows are linear; the others up to the mask's number are angular.
    """
    _forward(joints, tool, q, work, pose)
    _fill_jacobian(joints, work, pose, jacobian)
    for row in range(3):
        residual[row] = target[9 + row] - pose[9 + row]
    wanted, rotation = target[:9].reshape(3, 3), pose[:9].reshape(3, 3)
    count = mask[3] + mask[4] + mask[5]
    if mask[6] == 1 and mask[0] + mask[1] + mask[2] < 3:
        _turn_rows(wanted, residual[:3].reshape(3, 1))
        _turn_rows(wanted, jacobian[:3])
    if count > 0:
        _rotation_part(mask, wanted, rotation, residual[3:], jacobian[3:])
    kept = linear = 0
    for row in range(6):
        if mask[row] == 1:
            if kept != row:
                residual[kept] = residual[row]
                jacobian[kept] = jacobian[row]
            kept += 1
            if row < 3:
                linear += 1
    return linear


@compiled
def _damped(
    jacobian: FloatArray, free: NDArray[np.bool_], right: FloatArray, linear: int, damping: float, angular: float
) -> FloatArray:
    """Factors x (m,) with (J Jᵀ + Λ) x = right, over the free joints, by Cholesky.

    Args:
        jacobian: Rows, (m, n).
        free: Joints that take part, (n,).
        right: Right side, (m,).
        linear: How many rows are linear.
        damping: Λ of linear rows.
        angular: By what Λ of angular rows is divided.
    """
    m, n = jacobian.shape
    lower, x = np.empty((m, m)), np.empty(m)
    while True:
        sound = True
        for row in range(m):
            for column in range(row + 1):
                total = 0.0
                for k in range(n):
                    if free[k]:
                        total += jacobian[row, k] * jacobian[column, k]
                if row == column:
                    total += damping if row < linear else damping / angular
                for k in range(column):
                    total -= lower[row, k] * lower[column, k]
                if row != column:
                    lower[row, column] = total / lower[column, column]
                elif total > 0.0:
                    lower[row, row] = math.sqrt(total)
                else:
                    sound = False
                    lower[row, row] = 1.0
        if sound:
            break
        damping *= 1e3  # rounding made a singular matrix indefinite
    for row in range(m):
        total = right[row]
        for k in range(row):
            total -= lower[row, k] * x[k]
        x[row] = total / lower[row, row]
    for row in range(m - 1, -1, -1):
        total = x[row]
        for k in range(row + 1, m):
            total -= lower[k, row] * x[k]
        x[row] = total / lower[row, row]
    return x


@compiled
def _step(
    q: FloatArray,
    residual: FloatArray,
    jacobian: FloatArray,
    linear: int,
    damping: float,
    angular: float,
    bounds: FloatArray,
    free: NDArray[np.bool_],
) -> bool:
    """Move q (n,) by Jᵀ (J Jᵀ + Λ)⁻¹ r inside the limits; returns whether it moved.

    A joint that would leave its limits stops there, and the others do the rest.
    """
    m, n = jacobian.shape
    free[:] = True
    moved, step, rest = q.copy(), np.empty(n), residual.copy()
    for _ in range(n):
        x = _damped(jacobian, free, rest, linear, damping, angular)
        squared = 0.0
        for k in range(n):
            step[k] = 0.0
            if free[k]:
                for row in range(m):
                    step[k] += jacobian[row, k] * x[row]
            squared += step[k] ** 2
        scale = STEP_LIMIT / math.sqrt(squared) if squared > STEP_LIMIT * STEP_LIMIT else 1.0
        stopped = False
        for k in range(n):
            if free[k]:
                moved[k] = q[k] + scale * step[k]
                limit = min(max(moved[k], bounds[0, k]), bounds[1, k])
                if limit != moved[k]:
                    moved[k] = limit
                    free[k] = False
                    stopped = True
                    for row in range(m):
                        rest[row] -= jacobian[row, k] * (limit - q[k])
        if not stopped:
            break
    changed = False
    for k in range(n):
        changed = changed or moved[k] != q[k]
        q[k] = moved[k]
    return changed


@compiled
def descend(
    joints: FloatArray,
    tool: FloatArray,
    mask: IntArray,
    target: FloatArray,
    bounds: FloatArray,
    tolerances: FloatArray,
    max_steps: int,
    patience: int,
    q: FloatArray,
) -> tuple[bool, float, float, float, int]:
    """Step from a posture inside the limits towards a task: damped least squares (Levenberg-Marquardt).

    The step is q + Jᵀ (J Jᵀ + Λ)⁻¹ r, with Λ in proportion to the squared error (Sugihara 2011).

    Args:
        joints: See above, as for tool, mask, target, bounds and tolerances.
        tool: Pose of the tool in the last joint's frame.
        mask: What counts.
        target: Wanted pose in the base.
        bounds: Limits.
        tolerances: When the task is met.
        max_steps: Steps after which to stop.
        patience: Steps without progress after which to stop.
        q: Posture, (n,); where it led is written here: the best posture on the way.

    Returns:
        Whether the task is met, errors of position [m] and orientation [rad], weighted squared error [m²], and steps.
    """
    n = q.size
    work, pose, residual, jacobian = np.empty((joints.shape[0], 6)), np.empty(12), np.empty(6), np.empty((6, n))
    free, best = np.ones(n, dtype=np.bool_), q.copy()
    rows = int(mask[:6].sum())
    least = mark = previous = least_position = least_orientation = np.inf
    strength, idle, steps = DAMPING, 0, 0
    while True:
        linear = linearize(joints, tool, mask, target, q, work, pose, residual, jacobian)
        position, orientation = 0.0, 0.0
        for row in range(rows):
            if row < linear:
                position += residual[row] ** 2
            else:
                orientation += residual[row] ** 2
        cost = position + tolerances[2] * orientation
        position, orientation = math.sqrt(position), math.sqrt(orientation)
        met = position <= tolerances[0] and orientation <= tolerances[1]
        if cost < least or met:
            least, least_position, least_orientation = cost, position, orientation
            best[:] = q
        if met or steps == max_steps:
            break
        if cost < PROGRESS * mark:
            mark, idle = cost, 0
        else:
            idle += 1
            if idle >= patience:
                break
        # A step that made it worse went too far: the next ones are shorter.
        strength = 4.0 * strength if cost > previous else max(DAMPING, 0.25 * strength)
        previous = cost
        damping = strength * cost + LEAST_DAMPING
        steps += 1
        if not _step(q, residual[:rows], jacobian[:rows], linear, damping, tolerances[2], bounds, free):
            break
    q[:] = best
    return met, least_position, least_orientation, least, steps


@compiled
def search(
    joints: FloatArray,
    tool: FloatArray,
    mask: IntArray,
    target: FloatArray,
    bounds: FloatArray,
    tolerances: FloatArray,
    max_steps: int,
    patience: int,
    starts: FloatArray,
    q: FloatArray,
) -> tuple[bool, float, float, float, int, int]:
    """Descend from start after start (k, n) until one meets the task, and write the best posture into q (n,).

    Returns:
        As `descend`, steps of all starts, and how many were tried.
    """
    best = (False, np.inf, np.inf, np.inf, 0)
    steps = tried = 0
    trial = np.empty(q.size)
    for index in range(starts.shape[0]):
        for k in range(q.size):
            trial[k] = min(max(starts[index, k], bounds[0, k]), bounds[1, k])
        found = descend(joints, tool, mask, target, bounds, tolerances, max_steps, patience, trial)
        tried += 1
        steps += found[4]
        if found[0] or found[3] < best[3]:
            best = found
            q[:] = trial
        if found[0]:
            break
    return best[0], best[1], best[2], best[3], steps, tried


@compiled
def poses(joints: FloatArray, tool: FloatArray, postures: FloatArray) -> FloatArray:
    """Tool poses (k, 12) of postures (k, n)."""
    found, work = np.empty((postures.shape[0], 12)), np.empty((joints.shape[0], 6))
    for index in range(postures.shape[0]):
        _forward(joints, tool, postures[index], work, found[index])
    return found


@compiled
def pose_numbers(pose: FloatArray, numbers: FloatArray) -> bool:
    """Write a pose, position and unit quaternion xyzw (7,), as rotation matrix and position (12,).

    Returns:
        Whether all is finite and the quaternion a unit one to a thousandth.
    """
    x, y, z, w = pose[3], pose[4], pose[5], pose[6]
    square = x * x + y * y + z * z + w * w
    # Comparisons with NaN are false.
    if not (abs(math.sqrt(square) - 1.0) < 1e-3 and math.isfinite(pose[0] + pose[1] + pose[2])):
        return False
    s = 2.0 / square
    numbers[0], numbers[1], numbers[2] = 1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)
    numbers[3], numbers[4], numbers[5] = s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)
    numbers[6], numbers[7], numbers[8] = s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)
    numbers[9], numbers[10], numbers[11] = pose[0], pose[1], pose[2]
    return True
