"""How fast a tool may go along a path so that what lies ahead can be met on it: path-velocity decomposition, compiled.

The wanted twist is a direction times a speed. Joint velocities are q' s, where q' is what the joints do at the wanted
speed and s is the share of it that is executed, 0..1; accelerations are q' ds/dt + q'' s². At some points of the path
ahead, s is limited by velocities, by accelerations that the bending of the path takes, by the room to position limits
and by singular postures. Now, s may be so high that it can be brought down to each of those limits on the way to it
(Bobrow, Dubowsky and Gibson 1985). So a motion is slowed early and as a whole, and never leaves its line.

Numba compiles this file anew when it changes, not when `robots.ik_kernel` does, which it calls.
"""

import math

import numpy as np

from robots.ik_kernel import IntArray, compiled, linearize
from robots.pose import FloatArray

POINTS = 10
"""Points that are looked at."""
LONGEST = 0.15
"""No joint moves farther than this from one point to the next [rad]."""
FASTEST = 0.95
"""Part of the joints' speed limits that wishes may use; the rest is for coming back to the reference."""
BRAKING = 0.4
"""Part of the joints' acceleration limits that braking ahead counts on."""
BENDING = 0.35
"""Part of the joints' acceleration limits that the bending of the path may take."""
JERKING = 0.25
"""Part of the joints' jerk limits that changes of speed use; the bending of the path takes others."""
SOFTLY = 0.5
"""Part of a bound on a joint's speed before which other joints begin to take over."""
ROOM = 0.85
"""Part of the speed that `ServoBrakes.room` allows near position limits; so its projection never has to act."""
SLOW_ABOVE, STOP_AT = 17.0, 30.0
"""Condition numbers between which motion towards singular postures slows down, as in MoveIt Servo."""
WORSENS = 0.5
"""Condition numbers a second from which motion counts as leading in; below, the slow-down sets in smoothly [1/s]."""
SOON = 0.15
"""Time in which speed may grow before the next look counts [s]; a look is far shorter."""
FREE, VELOCITY, POSITION, SINGULARITY, BENDS = range(5)
"""What limits the speed."""
_LEAST_DAMPING = 1e-7
_TINY = 1e-12


@compiled
def _factor(rows: FloatArray, lower: FloatArray) -> None:
    """Write the Cholesky factor (m, m) of J Jᵀ for rows J (m, n), kept from being singular."""
    m, n = rows.shape
    trace = 0.0
    for i in range(m):
        for k in range(n):
            trace += rows[i, k] * rows[i, k]
    for i in range(m):
        for j in range(i + 1):
            total = 0.0
            for k in range(n):
                total += rows[i, k] * rows[j, k]
            if i == j:
                total += _LEAST_DAMPING * trace
            for k in range(j):
                total -= lower[i, k] * lower[j, k]
            lower[i, j] = math.sqrt(max(total, _TINY * trace)) if i == j else total / lower[j, j]


@compiled
def _solve(lower: FloatArray, x: FloatArray) -> None:
    """Replace x (m,) by (L Lᵀ)⁻¹ x."""
    m = x.size
    for i in range(m):
        for k in range(i):
            x[i] -= lower[i, k] * x[k]
        x[i] /= lower[i, i]
    for i in range(m - 1, -1, -1):
        for k in range(i + 1, m):
            x[i] -= lower[k, i] * x[k]
        x[i] /= lower[i, i]


@compiled
def _rates(rows: FloatArray, lower: FloatArray, twist: FloatArray, x: FloatArray, found: FloatArray) -> None:
    """Write the shortest joint velocities (n,) that give a twist (m,): Jᵀ (J Jᵀ)⁻¹ v."""
    x[:] = twist
    _solve(lower, x)
    for k in range(found.size):
        found[k] = 0.0
        for i in range(x.size):
            found[k] += rows[i, k] * x[i]


@compiled
def _give_way(rows: FloatArray, lower: FloatArray, bounds: FloatArray, rates: FloatArray) -> None:
    """Move joint velocities (n,) into their bounds (2, n) by what does not move the tool, as far as that can."""
    m, n = rows.shape
    if n <= m:
        return
    x, way = np.empty(m), np.empty(n)
    for turn in range(4):
        inside = True
        for i in range(n):
            side = 1 if rates[i] > 0.0 else 0
            size, bound = abs(rates[i]), abs(bounds[side, i])
            # It sets in softly at first, so that accelerations change evenly.
            soft = SOFTLY * bound if turn == 0 else 0.0
            if size <= bound - soft:
                continue
            over = (size - bound + soft) ** 2 / (4.0 * soft) if size < bound + soft else size - bound
            if rates[i] < 0.0:
                over = -over
            inside = False
            _rates(rows, lower, rows[:, i], x, way)
            own = 1.0 - way[i]
            if own < 1e-2:  # the tool needs this joint
                continue
            for k in range(n):
                rates[k] += over * way[k] / own
            rates[i] -= over / own
        if inside:
            break


@compiled
def _extremes(rows: FloatArray, lower: FloatArray, vectors: FloatArray, rounds: int) -> float:
    """Condition number of rows (m, n), by iterations from near eigenvectors (2, m), which are improved."""
    m, n = rows.shape
    largest, smallest = 0.0, 0.0
    for _ in range(rounds):
        turned = np.zeros(m)
        for k in range(n):
            value = 0.0
            for i in range(m):
                value += rows[i, k] * vectors[0, i]
            for i in range(m):
                turned[i] += rows[i, k] * value
        largest = math.sqrt(np.sum(turned * turned))
        vectors[0] = turned / max(largest, _TINY)
        _solve(lower, vectors[1])
        smallest = 1.0 / math.sqrt(np.sum(vectors[1] * vectors[1]))
        vectors[1] *= smallest
    return min(math.sqrt(largest / max(smallest, _TINY)), 1e6)


@compiled
def _weighted(
    joints: FloatArray, tool: FloatArray, mask: IntArray, weights: FloatArray, q: FloatArray, rows: FloatArray
) -> None:
    """Write the weighted rows of the Jacobian (m, n) at q (n,)."""
    work, pose, residual, jacobian = np.empty((joints.shape[0], 6)), np.empty(12), np.empty(6), np.empty((6, q.size))
    target = np.zeros(12)
    target[0] = target[4] = target[8] = 1.0
    linearize(joints, tool, mask, target, q, work, pose, residual, jacobian)
    for i in range(weights.size):
        for k in range(q.size):
            rows[i, k] = weights[i] * jacobian[i, k]


@compiled
def _fill_bounds(q: FloatArray, limits: FloatArray, scale: float, bounds: FloatArray) -> None:
    """Write how fast each joint may go down (negative) and up at q (n,), times a scale, (2, n)."""
    for i in range(q.size):
        gain = 0.4 * limits[2, i] / limits[1, i]
        for side in range(2):
            distance = max(q[i] - limits[3, i] if side == 0 else limits[4, i] - q[i], 0.0)
            speed = ROOM * min(gain * distance, math.sqrt(limits[1, i] * distance))
            speed = scale * min(speed, FASTEST * limits[0, i])
            bounds[side, i] = -speed if side == 0 else speed


@compiled
def joint_velocities(
    joints: FloatArray,
    tool: FloatArray,
    mask: IntArray,
    weights: FloatArray,
    limits: FloatArray,
    q: FloatArray,
    twist: FloatArray,
) -> FloatArray:
    """Joint velocities (n,) that give a twist; joints near position limits are spared where others can do it.

    Args:
        joints: The chain, (k, 19), as in `robots.ik_kernel`; so is `tool`.
        tool: Pose of the tool in the last joint's frame, (12,).
        mask: Which rows count: the first three or all six.
        weights: Of the m rows.
        limits: Of the n joints: velocity, acceleration, jerk, lower, upper, (5, n).
        q: Posture, (n,) [rad].
        twist: Of the tool along the axes of the base, (m,).
    """
    m, n = weights.size, q.size
    rows, lower, found, bounds = np.empty((m, n)), np.zeros((m, m)), np.empty(n), np.empty((2, n))
    _weighted(joints, tool, mask, weights, q, rows)
    _factor(rows, lower)
    _rates(rows, lower, weights * twist, np.empty(m), found)
    if n > m:
        _fill_bounds(q, limits, 1.0, bounds)
        _give_way(rows, lower, bounds, found)
    return found


@compiled
def _share(condition: float) -> float:
    """Part of the speed at which a motion that leads into a singular posture may go on."""
    return min(max((STOP_AT - condition) / (STOP_AT - SLOW_ABOVE), 0.0), 1.0)


@compiled
def look_ahead(
    joints: FloatArray,
    tool: FloatArray,
    mask: IntArray,
    weights: FloatArray,
    limits: FloatArray,
    q: FloatArray,
    twist: FloatArray,
    now: float,
    growing: float,
    most_change: float,
    most_jerk: float,
    vectors: FloatArray,
    inverse: FloatArray,
) -> tuple[float, int, int, float]:
    """How much of a twist may be executed.

    Args:
        joints: As for `joint_velocities`; so are tool, mask, weights, limits and q.
        tool: See there.
        mask: See there.
        weights: See there.
        limits: See there.
        q: See there.
        twist: The wanted one, not zero, (m,).
        now: Which part of it is executed now.
        growing: How fast that grows [1/s].
        most_change: How fast it may change whatever the joints can do [1/s].
        most_jerk: How fast that may change [1/s²].
        vectors: What `_extremes` keeps from call to call, (2, m).
        inverse: The inverse of the weighted Jacobian at q is written here, (n, m).

    Returns:
        The part, 0..1; what limits it; the joint where that is one; and the condition number at q.
    """
    m, n = weights.size, q.size
    rows, lower, x, bounds = np.empty((m, n)), np.zeros((m, m)), np.empty(m), np.empty((2, n))
    here, rates, before, bent = q.copy(), np.empty(n), np.empty(n), np.zeros(n)
    wanted, column = weights * twist, np.zeros(n)
    ceiling, why, which = 1.0, FREE, -1
    change, jerk = most_change, most_jerk
    growing = max(growing, 0.0)
    gone = step = first = condition = 0.0
    for point in range(POINTS + 1):
        _weighted(joints, tool, mask, weights, here, rows)
        _factor(rows, lower)
        if point == 0:
            for j in range(m):
                unit = np.zeros(m)
                unit[j] = 1.0
                _rates(rows, lower, unit, x, column)
                inverse[:, j] = column
            # Whatever they were, they are not quite at right angles to what they should become.
            vectors += 1e-3
        last, condition = condition, _extremes(rows, lower, vectors, 6 if point == 0 else 3)
        _rates(rows, lower, wanted, x, rates)
        over = 1.0
        for i in range(n):
            over = max(over, abs(rates[i]) / (FASTEST * limits[0, i]))
        _fill_bounds(here, limits, over, bounds)
        _give_way(rows, lower, bounds, rates)
        allowed, limit, joint = 1.0, FREE, -1
        steepest = roughest = 0.0
        for i in range(n):
            size = max(abs(rates[i]), _TINY)
            speed = bounds[1, i] / over if rates[i] > 0.0 else -bounds[0, i] / over
            if speed < allowed * size:
                allowed, joint = speed / size, i
                limit = VELOCITY if speed > 0.999 * FASTEST * limits[0, i] else POSITION
            steepest = max(steepest, size / limits[1, i])
            roughest = max(roughest, size / limits[2, i])
            if point > 0:
                bent[i] = (rates[i] - before[i]) / step
                part = math.sqrt(BENDING * limits[1, i] / max(abs(bent[i]), _TINY))
                if part < allowed:
                    allowed, limit, joint = part, BENDS, i
        change, jerk = min(change, BRAKING / steepest), min(jerk, JERKING / roughest)
        # Braking sets in as if it were so much later: growth has to end first, and it begins gently.
        lag = (growing + change) ** 2 / (2.0 * jerk * change)
        peak = now + growing * growing / (2.0 * jerk)
        end = gone
        if point == 0:
            first = condition
        else:
            leading_in = min(max((condition - last) / step / WORSENS, 0.0), 1.0)
            part = 1.0 - leading_in * (1.0 - _share(condition))
            if part < allowed:
                allowed, limit, joint = part, SINGULARITY, -1
                if condition > STOP_AT > last:  # the end lies between two points
                    end = gone - step * (1.0 / STOP_AT - 1.0 / condition) / (1.0 / last - 1.0 / condition)
            part = 1.0 - leading_in * (1.0 - _share(last))
            if point == 1 and part < ceiling:
                ceiling, why, which = part, SINGULARITY, -1
        reach = max(end - peak * lag, 0.0)
        part = math.sqrt(allowed * allowed + 2.0 * change * reach)
        if part < ceiling:
            ceiling, why, which = part, limit, joint
        if allowed <= 0.0 or 2.0 * change * reach >= ceiling * ceiling:
            break
        if point == 0:
            soon = min(allowed, peak + change * SOON)
            step = (soon * soon / (2.0 * change) + soon * lag) / POINTS
        fastest = 0.0
        for i in range(n):
            fastest = max(fastest, abs(rates[i]))
        ahead = min(max(step, 1e-4 / max(fastest, _TINY)), LONGEST / max(fastest, _TINY))
        step = ahead
        before[:] = rates
        for i in range(n):
            here[i] += ahead * rates[i]
        gone += ahead
    return ceiling, why, which, first
