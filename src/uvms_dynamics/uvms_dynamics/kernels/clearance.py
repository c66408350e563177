"""Clearances of a vehicle: arm from hull and from itself, all of it from obstacles and seabed.

The shapes are one table, whose rows are

- row 0: how many rows of each kind follow, one kind after the other,
- parts of the hull (spheroid, box, capsule or ball) in the body frame,
- capsules of the links, by link, each in the frame of its joint as the model has it,
- obstacles (ball, box, plane) in map_ned,
- pairs of bodies, 0 for the hull and i for link i, one of which is a link.

The clearances are those of the pairs, then for each obstacle those of hull, link 1, link 2 ...
"""

import math

import numpy as np

from uvms_dynamics.kernels.chain import joint_frames
from uvms_dynamics.kernels.distances import (
    dot,
    point_box,
    point_segment,
    segment_box,
    segment_segment,
    spheroid_box,
    spheroid_segment,
)
from uvms_dynamics.kernels.jit import inner, kernel, shared
from uvms_dynamics.kernels.layout import FIRST, HULL, JOINTS
from uvms_dynamics.kernels.spatial import load3

SHAPE_COLUMNS = 20

# Row 0
PARTS, CAPSULES, OBSTACLES, PAIRS = np.arange(4)

# Parts of the hull, capsules and obstacles
KIND = np.int64(0)
CAPSULE, BOX, SPHEROID, BALL, PLANE = 0.0, 1.0, 2.0, 3.0, 4.0
BODY = np.int64(1)  # of a capsule
START = np.int64(2)  # of a capsule; centre of a box or ball; any point of a plane
DIRECTION = np.int64(5)  # of a capsule: from its start to its end
HALF = np.int64(5)  # half sides of a box; a spheroid's half axes; a plane's normal, to its inside
RADIUS = np.int64(8)  # of a capsule or ball
ROTATION = np.int64(9)  # axes of a box, row by row

# Pairs
FIRST_BODY, SECOND_BODY = np.int64(0), np.int64(1)

_FRAME = np.int64(12)  # numbers of a frame, and those of a capsule in the body frame
_ORIGIN = np.int64(9)


@inner
def clearance_count(model, shapes):
    """k, the number of clearances."""
    return np.int64(shapes[0, PAIRS] + shapes[0, OBSTACLES] * (model[HULL, JOINTS] + 1.0))


@inner
def clearance_work(model, shapes):
    """Scratch table for `clearances_into`; its contents do not outlive a call."""
    rows = np.int64(model[HULL, JOINTS] + 1.0 + shapes[0, CAPSULES])
    return np.empty((rows, _FRAME))


@shared
def clearances_into(model, shapes, position, rotation, q, work, out):
    """Write all clearances (k,), m, to `out`; nothing is allocated.

    position: three numbers, m, and rotation: nine numbers, row by row, the vehicle's pose in
    map_ned; q (n,) rad; work: from `clearance_work`.
    """
    joint_frames(model, q, work)
    _place_capsules(shapes, q.shape[0] + 1, work)
    count = np.int64(shapes[0, PAIRS])
    first = np.int64(1.0 + shapes[0, PARTS] + shapes[0, CAPSULES] + shapes[0, OBSTACLES])
    for k in range(count):
        one = np.int64(shapes[first + k, FIRST_BODY])
        other = np.int64(shapes[first + k, SECOND_BODY])
        out[k] = _between_bodies(shapes, work, q.shape[0] + 1, one, other)
    first -= np.int64(shapes[0, OBSTACLES])
    for j in range(np.int64(shapes[0, OBSTACLES])):
        for body in range(q.shape[0] + 1):
            out[count] = _from_obstacle(
                shapes, work, q.shape[0] + 1, body, first + j, position, rotation
            )
            count += 1


@inner
def level_clearances_into(model, shapes, configuration, work, out):
    """The same in the configuration c (m,) = (x, y, z, psi, q) of a level vehicle."""
    c, s = math.cos(configuration[3]), math.sin(configuration[3])
    rotation = (c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
    position = (configuration[0], configuration[1], configuration[2])
    clearances_into(model, shapes, position, rotation, configuration[4:], work, out)


@kernel
def clearances_of(model, shapes, configuration):
    """Clearances (k,), m, in the configuration c (m,) = (x, y, z, psi, q) of a level vehicle."""
    if configuration.shape[0] != np.int64(model[HULL, JOINTS]) + 4:
        raise ValueError("a configuration is x, y, z, psi and one angle for each joint")
    out = np.empty(clearance_count(model, shapes))
    level_clearances_into(model, shapes, configuration, clearance_work(model, shapes), out)
    return out


@kernel
def clearances_along(model, shapes, configurations):
    """Clearances (N, k), m, in the configurations (N, m) of a level vehicle."""
    if configurations.shape[1] != np.int64(model[HULL, JOINTS]) + 4:
        raise ValueError("a configuration is x, y, z, psi and one angle for each joint")
    out = np.empty((configurations.shape[0], clearance_count(model, shapes)))
    work = clearance_work(model, shapes)
    for i in range(configurations.shape[0]):
        level_clearances_into(model, shapes, configurations[i], work, out[i])
    return out


@kernel
def clearances_of_poses(model, shapes, positions, quaternions, angles):
    """Clearances (N, k), m, at positions (N, 3), quaternions (N, 4) and joint angles (N, n)."""
    if angles.shape[1] != np.int64(model[HULL, JOINTS]) or positions.shape[1] != 3:
        raise ValueError("poses have three coordinates and one angle for each joint")
    if quaternions.shape[1] != 4:
        raise ValueError("quaternions have 4 values: x, y, z, w")
    if not positions.shape[0] == quaternions.shape[0] == angles.shape[0]:
        raise ValueError("there must be as many positions as quaternions and joint angles")
    out = np.empty((positions.shape[0], clearance_count(model, shapes)))
    work = clearance_work(model, shapes)
    for i in range(positions.shape[0]):
        rotation = _rotation(
            quaternions[i, 0], quaternions[i, 1], quaternions[i, 2], quaternions[i, 3]
        )
        position = load3(positions, i, FIRST)
        clearances_into(model, shapes, position, rotation, angles[i], work, out[i])
    return out


@inner
def _rotation(x, y, z, w):
    """The nine numbers of R_world_body of a unit quaternion, row by row."""
    return (
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - z * w),
        2.0 * (x * z + y * w),
        2.0 * (x * y + z * w),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - x * w),
        2.0 * (x * z - y * w),
        2.0 * (y * z + x * w),
        1.0 - 2.0 * (x * x + y * y),
    )


@inner
def _turned(work, i, x):
    """Components in the body frame of a vector of the frame in row i."""
    return dot(load3(work, i, 0), x), dot(load3(work, i, 3), x), dot(load3(work, i, 6), x)


@inner
def _place_capsules(shapes, frames, work):
    """Start and direction of each link's capsules in the body frame, behind the frames."""
    first = 1 + np.int64(shapes[0, PARTS])
    for k in range(np.int64(shapes[0, CAPSULES])):
        body = np.int64(shapes[first + k, BODY])
        x, y, z = _turned(work, body, load3(shapes, first + k, START))
        row = frames + k
        d0, d1, d2 = _turned(work, body, load3(shapes, first + k, DIRECTION))
        work[row, 0] = work[body, _ORIGIN] + x
        work[row, 1] = work[body, _ORIGIN + 1] + y
        work[row, 2] = work[body, _ORIGIN + 2] + z
        work[row, 3], work[row, 4], work[row, 5] = d0, d1, d2


@shared
def _between_bodies(shapes, work, frames, one, other):
    """Clearance of link `other` from the hull, `one` = 0, or from link `one`."""
    least = math.inf
    parts = np.int64(shapes[0, PARTS])
    capsules = np.int64(shapes[0, CAPSULES])
    for j in range(capsules):
        row = 1 + parts + j
        if np.int64(shapes[row, BODY]) == other:
            p, d = load3(work, frames + j, 0), load3(work, frames + j, 3)
            if one == 0:
                for i in range(1, 1 + parts):
                    least = min(least, _from_part(shapes, i, p, d) - shapes[row, RADIUS])
            else:
                for i in range(capsules):
                    if np.int64(shapes[1 + parts + i, BODY]) == one:
                        q, e = load3(work, frames + i, 0), load3(work, frames + i, 3)
                        gap = segment_segment(p, d, q, e) - shapes[1 + parts + i, RADIUS]
                        least = min(least, gap - shapes[row, RADIUS])
    return least


@shared
def _from_part(shapes, i, p, d):
    """Distance of a segment, body frame, from a part of the hull."""
    kind = shapes[i, KIND]
    if kind == SPHEROID:
        return spheroid_segment(shapes[i, HALF], shapes[i, HALF + 1], p, d)
    if kind == BOX:
        start, direction = _in_box(shapes, i, p), _in_axes(shapes, i, d)
        return segment_box(start, direction, load3(shapes, i, HALF))
    q, e = load3(shapes, i, START), load3(shapes, i, DIRECTION)
    if kind == BALL:
        return point_segment(q, p, d) - shapes[i, RADIUS]
    return segment_segment(p, d, q, e) - shapes[i, RADIUS]


@inner
def _in_axes(shapes, i, x):
    """Components of a vector along the axes of the box in row i."""
    return (
        shapes[i, ROTATION] * x[0]
        + shapes[i, ROTATION + 3] * x[1]
        + shapes[i, ROTATION + 6] * x[2],
        shapes[i, ROTATION + 1] * x[0]
        + shapes[i, ROTATION + 4] * x[1]
        + shapes[i, ROTATION + 7] * x[2],
        shapes[i, ROTATION + 2] * x[0]
        + shapes[i, ROTATION + 5] * x[1]
        + shapes[i, ROTATION + 8] * x[2],
    )


@inner
def _in_box(shapes, i, x):
    """A point as seen from the box in row i."""
    return _in_axes(
        shapes,
        i,
        (x[0] - shapes[i, START], x[1] - shapes[i, START + 1], x[2] - shapes[i, START + 2]),
    )


@inner
def _in_world(rotation, x):
    """A vector of the body frame in map_ned."""
    return (
        rotation[0] * x[0] + rotation[1] * x[1] + rotation[2] * x[2],
        rotation[3] * x[0] + rotation[4] * x[1] + rotation[5] * x[2],
        rotation[6] * x[0] + rotation[7] * x[1] + rotation[8] * x[2],
    )


@inner
def _point_in_world(position, rotation, x):
    y = _in_world(rotation, x)
    return position[0] + y[0], position[1] + y[1], position[2] + y[2]


@shared
def _from_obstacle(shapes, work, frames, body, obstacle, position, rotation):
    """Clearance of hull or link from an obstacle."""
    least = math.inf
    parts = np.int64(shapes[0, PARTS])
    if body == 0:
        for i in range(1, 1 + parts):
            least = min(least, _part_from_obstacle(shapes, i, obstacle, position, rotation))
        return least
    for j in range(np.int64(shapes[0, CAPSULES])):
        row = 1 + parts + j
        if np.int64(shapes[row, BODY]) == body:
            p = _point_in_world(position, rotation, load3(work, frames + j, 0))
            d = _in_world(rotation, load3(work, frames + j, 3))
            gap = _segment_from_obstacle(shapes, obstacle, p, d) - shapes[row, RADIUS]
            least = min(least, gap)
    return least


@shared
def _segment_from_obstacle(shapes, obstacle, p, d):
    """Distance of a segment, map_ned, from an obstacle."""
    kind = shapes[obstacle, KIND]
    if kind == PLANE:
        r = load3(shapes, obstacle, START)
        n = load3(shapes, obstacle, HALF)
        r = (r[0] - p[0], r[1] - p[1], r[2] - p[2])
        return dot(n, r) - max(dot(n, d), 0.0)
    if kind == BOX:
        start, direction = _in_box(shapes, obstacle, p), _in_axes(shapes, obstacle, d)
        return segment_box(start, direction, load3(shapes, obstacle, HALF))
    return point_segment(load3(shapes, obstacle, START), p, d) - shapes[obstacle, RADIUS]


@shared
def _part_from_obstacle(shapes, i, obstacle, position, rotation):
    """Distance of a part of the hull from an obstacle."""
    kind = shapes[i, KIND]
    if kind == SPHEROID:
        return _spheroid_from_obstacle(shapes, i, obstacle, position, rotation)
    p = _point_in_world(position, rotation, load3(shapes, i, START))
    if kind != BOX:
        d = _in_world(rotation, load3(shapes, i, DIRECTION))
        return _segment_from_obstacle(shapes, obstacle, p, d) - shapes[i, RADIUS]
    return _box_from_obstacle(shapes, i, obstacle, p, rotation)


@shared
def _spheroid_from_obstacle(shapes, i, obstacle, position, rotation):
    a, b = shapes[i, HALF], shapes[i, HALF + 1]
    axis = rotation[0], rotation[3], rotation[6]
    kind = shapes[obstacle, KIND]
    if kind == PLANE:  # the support function of an ellipsoid
        n, r = load3(shapes, obstacle, HALF), load3(shapes, obstacle, START)
        r = (r[0] - position[0], r[1] - position[1], r[2] - position[2])
        x = dot(n, axis)
        return dot(n, r) - math.sqrt(b * b + (a * a - b * b) * x * x)
    if kind == BOX:
        centre, direction = _in_box(shapes, obstacle, position), _in_axes(shapes, obstacle, axis)
        return spheroid_box(a, b, centre, direction, load3(shapes, obstacle, HALF))
    c = load3(shapes, obstacle, START)
    c = (c[0] - position[0], c[1] - position[1], c[2] - position[2])
    squared = dot(c, c)
    x = dot(c, axis)
    across = math.sqrt(max(squared - x * x, 0.0))
    gap = spheroid_segment(a, b, (x, across, 0.0), (0.0, 0.0, 0.0))
    return gap - shapes[obstacle, RADIUS]


@shared
def _box_from_obstacle(shapes, i, obstacle, centre, rotation):
    """Distance of a box of the hull, whose centre is given in map_ned, from an obstacle."""
    h = load3(shapes, i, HALF)
    x = _in_world(rotation, _column(shapes, i, 0))
    y = _in_world(rotation, _column(shapes, i, 1))
    z = _in_world(rotation, _column(shapes, i, 2))
    kind = shapes[obstacle, KIND]
    if kind == BOX:
        return _box_from_box(shapes, obstacle, centre, x, y, z, h)
    r = load3(shapes, obstacle, START)
    r = (r[0] - centre[0], r[1] - centre[1], r[2] - centre[2])
    if kind == PLANE:
        n = load3(shapes, obstacle, HALF)
        reach = h[0] * abs(dot(n, x)) + h[1] * abs(dot(n, y)) + h[2] * abs(dot(n, z))
        return dot(n, r) - reach
    return point_box((dot(x, r), dot(y, r), dot(z, r)), h) - shapes[obstacle, RADIUS]


@inner
def _column(shapes, i, k):
    """Axis k of the box in row i."""
    return shapes[i, ROTATION + k], shapes[i, ROTATION + 3 + k], shapes[i, ROTATION + 6 + k]


@shared
def _box_from_box(shapes, obstacle, centre, x, y, z, h):
    """Signed distance of two boxes: the nearest points are on an edge of one of them at least.

    x, y, z, h: axes and half sides of the one with the centre `centre`, map_ned.
    """
    g = load3(shapes, obstacle, HALF)
    c = _in_box(shapes, obstacle, centre)
    x, y, z = (
        _in_axes(shapes, obstacle, x),
        _in_axes(shapes, obstacle, y),
        _in_axes(shapes, obstacle, z),
    )
    least = _edges_from_box(c, x, y, z, h, g)
    # the other way round: the axes of the obstacle seen from the hull's box
    u, v, w = (x[0], y[0], z[0]), (x[1], y[1], z[1]), (x[2], y[2], z[2])
    c = -dot(x, c), -dot(y, c), -dot(z, c)
    return min(least, _edges_from_box(c, u, v, w, g, h))


@shared
def _edges_from_box(c, x, y, z, h, g):
    """Least distance of the edges of a box (centre c, axes x, y, z, half sides h) from another."""
    least = math.inf
    for _ in range(3):
        for i in (-1.0, 1.0):
            for j in (-1.0, 1.0):
                start = _corner(c, x, y, z, (-h[0], i * h[1], j * h[2]))
                edge = (2.0 * h[0] * x[0], 2.0 * h[0] * x[1], 2.0 * h[0] * x[2])
                least = min(least, segment_box(start, edge, g))
        x, y, z = y, z, x
        h = (h[1], h[2], h[0])
    return least


@inner
def _corner(c, x, y, z, s):
    return (
        c[0] + s[0] * x[0] + s[1] * y[0] + s[2] * z[0],
        c[1] + s[0] * x[1] + s[1] * y[1] + s[2] * z[1],
        c[2] + s[0] * x[2] + s[1] * y[2] + s[2] * z[2],
    )
