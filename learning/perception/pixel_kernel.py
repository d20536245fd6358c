"""What is done with every pixel of every picture, compiled by Numba: a picture in a third of a millisecond.

Arrays are laid out as pictures are, row by row. See `TableView` and `standing_out` for what the parts mean.
"""

import numpy as np
from numpy.typing import NDArray

from robots.ik_kernel import compiled
from robots.pose import FloatArray

NOTHING, FOUND, ROBOT = 0, 1, 2


@compiled
def sort_pixels(
    colour: NDArray[np.uint8],
    depth: NDArray[np.float32],
    body: NDArray[np.float32],
    slope: NDArray[np.float32],
    base: float,
    threshold: NDArray[np.float32],
    on_table: NDArray[np.bool_],
    mean: FloatArray,
    precision: FloatArray,
    limits: FloatArray,
) -> NDArray[np.uint8]:
    """Tell what stands out from the table, and the robot's own body, from all else.

    Args:
        colour: Red, green, blue, (h, w, 3).
        depth: Measured depth, (h, w) [m]; 0 is none.
        body: Depth of the robot's body, (h, w) [m]; 0 is none.
        slope: Height that a metre of depth adds, (h, w).
        base: Height of the camera above the table [m].
        threshold: Height that stands out, (h, w) [m].
        on_table: Pixels that look at the table, (h, w).
        mean: The table's colour, (3,).
        precision: Its inverse covariance, (3, 3).
        limits: Squared distance of another colour, largest height [m], margin before the robot's body [m], (3,).

    Returns:
        `NOTHING`, `FOUND` or `ROBOT` for each pixel, (h, w).
    """
    height, width = depth.shape
    kinds = np.zeros((height, width), dtype=np.uint8)
    for row in range(height):
        for column in range(width):
            z = depth[row, column]
            own = body[row, column]
            if own > 0.0:
                if z <= 0.0 or z > own - limits[2]:
                    kinds[row, column] = 2
                    continue
            else:
                # Sensors smear edges over a pixel: what is beside the body at the body's depth is the body.
                edge = False
                for step in range(4):
                    r = row + (1 if step == 0 else -1 if step == 1 else 0)
                    c = column + (1 if step == 2 else -1 if step == 3 else 0)
                    if 0 <= r < height and 0 <= c < width and body[r, c] > 0.0:
                        there = depth[r, c]
                        mine = there <= 0.0 or there > body[r, c] - limits[2]
                        if mine and abs(z - body[r, c]) < limits[2]:
                            edge = True
                if edge:
                    kinds[row, column] = 2
                    continue
            high = base + slope[row, column] * z
            if z > 0.0:
                if threshold[row, column] < high < limits[1]:
                    kinds[row, column] = 1
                    continue
                if high < -threshold[row, column] or high >= limits[1]:
                    continue
            if on_table[row, column]:
                a = colour[row, column, 0] - mean[0]
                b = colour[row, column, 1] - mean[1]
                c3 = colour[row, column, 2] - mean[2]
                away = precision[0, 0] * a * a + precision[1, 1] * b * b + precision[2, 2] * c3 * c3
                away += 2.0 * (precision[0, 1] * a * b + precision[0, 2] * a * c3 + precision[1, 2] * b * c3)
                if away > limits[0]:
                    kinds[row, column] = 1
    return kinds


@compiled
def connect(
    kinds: NDArray[np.uint8],
    pixels: NDArray[np.int64],
    depth: FloatArray,
    colours: FloatArray,
    limits: FloatArray,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]:
    """Connect neighbouring pixels that stand out, but for where depth jumps, or colour and depth change together.

    Pixels without depth go by colour. A patch of them may be at an edge, where pixels of the same colour are before
    and behind it: it is connected with those to one side of that jump only, the more numerous ones.

    Args:
        kinds: What each pixel shows, (h, w).
        pixels: Numbers of those that stand out, (n,).
        depth: Their depths, (n,) [m]; 0 is none.
        colours: Their red, green, blue, (n, 3) of 255.
        limits: Jump of depth, jump of depth between colours [m], change of chromaticity, how much more of it in the
            dark, the difference of depth within which neighbours agree [m], how much depth may change across a patch
            without depth [m], ratio of brightness that light and shade do not explain, and the sum of channels that
            noise in the dark makes, (8,).

    Returns:
        The part that each belongs to, (n,); how many of its neighbours agree on depth, (n,); and whether no pixel of
        the robot nor the border of the picture is beside it, (n,).
    """
    height, width = kinds.shape
    count = len(pixels)
    index = np.full((height, width), -1, dtype=np.int64)
    for n in range(count):
        index[pixels[n] // width, pixels[n] % width] = n
    parent = np.arange(count)
    agreeing = np.zeros(count, dtype=np.int64)
    exposed = np.ones(count, dtype=np.bool_)
    beside_patch = 0
    for n in range(count):
        row, column = pixels[n] // width, pixels[n] % width
        for step in range(9):
            r, c = row + step // 3 - 1, column + step % 3 - 1
            if r < 0 or c < 0 or r >= height or c >= width or kinds[r, c] == 2:
                exposed[n] = False
                continue
            m = index[r, c]
            if m <= n:  # each pair once
                continue
            changed = _changed(colours[n], colours[m], limits)
            if depth[n] > 0.0 and depth[m] > 0.0:
                jump = abs(depth[n] - depth[m])
                if jump < limits[4]:
                    agreeing[n] += 1
                    agreeing[m] += 1
                if jump > limits[0] or (jump > limits[1] and changed):
                    continue
            elif changed:
                continue
            elif depth[n] > 0.0 or depth[m] > 0.0:
                beside_patch += 1
                continue
            _unite(parent, n, m)
    if beside_patch > 0:
        _connect_patches(parent, index, pixels, depth, colours, limits)
    part = np.zeros(count, dtype=np.int64)
    parts = 0
    for n in range(count):
        root = _root(parent, n)
        if root == n:
            part[n] = parts
            parts += 1
        else:
            part[n] = part[root]
    return part, agreeing, exposed


@compiled
def _connect_patches(
    parent: NDArray[np.int64],
    index: NDArray[np.int64],
    pixels: NDArray[np.int64],
    depth: FloatArray,
    colours: FloatArray,
    limits: FloatArray,
) -> None:
    """Connect patches without depth with what is beside them; see `connect`."""
    height, width = index.shape
    count = len(pixels)
    patch = np.zeros(count, dtype=np.int64)  # roots, before anything is connected with them
    nearest = np.full(count, np.inf)
    farthest = np.zeros(count)
    votes = np.zeros(count, dtype=np.int64)
    for n in range(count):
        patch[n] = _root(parent, n)
    for turn in range(3):
        for n in range(count):
            if depth[n] > 0.0:
                continue
            own = patch[n]
            row, column = pixels[n] // width, pixels[n] % width
            for step in range(9):
                r, c = row + step // 3 - 1, column + step % 3 - 1
                if r < 0 or c < 0 or r >= height or c >= width:
                    continue
                m = index[r, c]
                if m < 0 or depth[m] <= 0.0 or _changed(colours[n], colours[m], limits):
                    continue
                parts = farthest[own] - nearest[own] > limits[5]
                far = depth[m] > 0.5 * (nearest[own] + farthest[own])
                if turn == 0:
                    nearest[own] = min(nearest[own], depth[m])
                    farthest[own] = max(farthest[own], depth[m])
                elif turn == 1:
                    votes[own] += 1 if far else -1
                elif not parts or far == (votes[own] > 0):
                    _unite(parent, n, m)


@compiled
def _changed(one: FloatArray, other: FloatArray, limits: FloatArray) -> bool:
    """Whether two colours (3,) differ by more than noise and shade explain."""
    a, b = one[0] + one[1] + one[2] + 1.0, other[0] + other[1] + other[2] + 1.0
    hue = abs(one[0] / a - other[0] / b) + abs(one[1] / a - other[1] / b)
    # In the dark hue tells nothing, and black beside a colour is told by brightness.
    return bool(hue > limits[2] + limits[3] / min(a, b) or max(a, b) + limits[7] > limits[6] * (min(a, b) + limits[7]))


@compiled
def _root(parent: NDArray[np.int64], n: int) -> int:
    """The pixel that stands for all that are connected with one; halves the paths to it."""
    while parent[n] != n:
        parent[n] = parent[parent[n]]
        n = parent[n]
    return n


@compiled
def _unite(parent: NDArray[np.int64], n: int, m: int) -> None:
    """Connect two pixels, and all that are connected with them."""
    a, b = _root(parent, n), _root(parent, m)
    if a < b:
        parent[b] = a
    else:
        parent[a] = b
