"""Signed distances between points, segments, boxes and spheroids, in closed form where possible.

A shape with a radius is its segment or point less the radius. Outside each other all distances are
exact. Inside a box or spheroid the distance of the deepest point of a segment counts, negative:
continuous, of the right sign, and no greater in size than the least translation that parts the two.

Vectors are tuples of three numbers. Boxes lie about the origin along the axes, with half sides `h`;
spheroids about the origin along x.
"""

import math

from uvms_dynamics.kernels.jit import inner, shared

_TINY = 1e-300  # keeps a division from failing; what is multiplied by it is zero as well
_CONVERGED = 1e-15  # of a spheroid's length: twice what Newton's step still wins
_NARROW = 1e-9  # of it: the range in which a distance is least; its value is off by the square
_ITERATIONS = 40  # bisection alone needs 31
_NEWTON = 6  # steps by Newton's method alone, before every other one halves the range


@inner
def dot(a, b):
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inner
def along(p, d, t):
    """The point p + t d."""
    return p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]


@inner
def _unit_range(x):
    return min(max(x, 0.0), 1.0)


@inner
def point_segment(x, p, d):
    """Distance of a point x from the segment from p to p + d."""
    r = (x[0] - p[0], x[1] - p[1], x[2] - p[2])
    t = _unit_range(dot(r, d) / (dot(d, d) + _TINY))
    r = along(r, d, -t)
    return math.sqrt(dot(r, r))


@shared
def segment_segment(p, d, q, e):
    """Distance between the segments from p to p + d and from q to q + e.

    Ericson, Real-Time Collision Detection (2005), sec. 5.1.9; then each end of the one that is
    nearer still, as parallel segments have no single pair of nearest points.
    """
    r = (p[0] - q[0], p[1] - q[1], p[2] - q[2])
    a, b, f = dot(d, d), dot(d, e), dot(e, e)
    c, g = dot(d, r), dot(e, r)
    determinant = a * f - b * b
    s = _unit_range((b * g - c * f) / determinant) if determinant > 0.0 else 0.0
    t = _unit_range((b * s + g) / (f + _TINY))
    s = _unit_range((b * t - c) / (a + _TINY))
    t = _unit_range((b * s + g) / (f + _TINY))
    r = along(along(r, d, s), e, -t)
    return math.sqrt(dot(r, r))


@inner
def _excess(x, h):
    """How far a coordinate lies beyond -h..h, with its sign."""
    return x - min(max(x, -h), h)


@inner
def point_box(x, h):
    """Signed distance of a point from a box: outside the distance, inside -(that to a face)."""
    u = (_excess(x[0], h[0]), _excess(x[1], h[1]), _excess(x[2], h[2]))
    squared = dot(u, u)
    if squared > 0.0:
        return math.sqrt(squared)
    return max(abs(x[0]) - h[0], abs(x[1]) - h[1], abs(x[2]) - h[2])


@inner
def _box_slope(p, d, t, h):
    """Half the derivative by t of the squared distance of p + t d from a box."""
    return (
        d[0] * _excess(p[0] + t * d[0], h[0])
        + d[1] * _excess(p[1] + t * d[1], h[1])
        + d[2] * _excess(p[2] + t * d[2], h[2])
    )


@shared
def segment_box(p, d, h):
    """Signed distance of the segment from p to p + d from a box.

    The squared distance along the segment is convex, and its derivative linear between the six
    places where a coordinate passes a face: they narrow down where it is zero.
    """
    low, high = 0.0, 1.0
    slope_low, slope_high = _box_slope(p, d, low, h), _box_slope(p, d, high, h)
    if slope_low >= 0.0:
        high, slope_high = low, slope_low
    elif slope_high <= 0.0:
        low, slope_low = high, slope_high
    else:
        for k in range(3):
            for sign in (-1.0, 1.0):
                t = (sign * h[k] - p[k]) / d[k] if d[k] != 0.0 else -1.0
                if low < t < high:
                    slope = _box_slope(p, d, t, h)
                    if slope < 0.0:
                        low, slope_low = t, slope
                    else:
                        high, slope_high = t, slope
        rise = slope_high - slope_low
        if rise > 0.0:
            low -= slope_low * (high - low) / rise
    x = along(p, d, low)
    u = (_excess(x[0], h[0]), _excess(x[1], h[1]), _excess(x[2], h[2]))
    squared = dot(u, u)
    return math.sqrt(squared) if squared > 0.0 else _deepest(p, d, h)


@shared
def _deepest(p, d, h):
    """Least signed distance from the faces of a box along a segment that enters it, <= 0.

    The greatest of the six linear functions +-(p_i + t d_i) - h_i is least at an end of the segment
    or where two of them cross.
    """
    least = min(_from_faces(p, h), _from_faces(along(p, d, 1.0), h))
    for i in range(6):
        for j in range(i):
            si, sj = (1.0 if i < 3 else -1.0), (1.0 if j < 3 else -1.0)
            a, b = i % 3, j % 3
            slope = si * d[a] - sj * d[b]
            if slope != 0.0:
                t = (h[a] - h[b] - si * p[a] + sj * p[b]) / slope
                if 0.0 < t < 1.0:
                    least = min(least, _from_faces(along(p, d, t), h))
    return least


@inner
def _from_faces(x, h):
    return max(abs(x[0]) - h[0], abs(x[1]) - h[1], abs(x[2]) - h[2])


# A prolate spheroid with half axes a and b is the union of the balls about (c, 0, 0), |c| <= a e^2,
# with radius r(c) = b sqrt(1 - (c / (a e))^2), which touch its surface from inside. So its signed
# distance from a shape is min over c of D(c) - r(c), D being the distance of (c, 0, 0) from it: a
# convex function, whose derivative is <= 0 at one end and >= 0 at the other.


@shared
def spheroid_segment(a, b, p, d):
    """Signed distance of the segment from p to p + d from a spheroid with half axes a > b.

    By Newton's method, with the curvature of the distance from the nearest point of the segment.
    """
    focus2 = a * a - b * b
    inverse = 1.0 / (dot(d, d) + _TINY)
    low, high = -focus2 / a, focus2 / a
    c = _first_ball(a, b, p, d)
    gap = 0.0
    for k in range(_ITERATIONS):
        r = (c - p[0], -p[1], -p[2])
        t = _unit_range(dot(r, d) * inverse)
        u = along(r, d, -t)
        distance = math.sqrt(dot(u, u)) + _TINY
        cosine = u[0] / distance
        root = math.sqrt(1.0 - c * c / focus2)
        slope = cosine + b * c / (focus2 * root)
        straight = d[0] * d[0] * inverse if 0.0 < t < 1.0 else 0.0
        curve = max(1.0 - straight - cosine * cosine, 0.0) / distance
        curve += b / (focus2 * root * root * root)
        step = slope / curve
        gap = distance - b * root - 0.5 * slope * step
        if slope < 0.0:
            low = c
        else:
            high = c
        if slope * step < _CONVERGED * a or high - low < _NARROW * a:
            break
        c -= step
        if not low < c < high or (k > _NEWTON and k % 2):
            c = 0.5 * (low + high)
    return gap


@inner
def _first_ball(a, b, p, d):
    """Where the search begins: what is nearest for the point of the segment next to the axis."""
    t = _unit_range(-(p[1] * d[1] + p[2] * d[2]) / (d[1] * d[1] + d[2] * d[2] + _TINY))
    x, y, z = along(p, d, t)
    focus2 = a * a - b * b
    c = x * focus2 / (a * a + a * max(math.sqrt(y * y + z * z) - b, 0.0))
    return min(max(c, -focus2 / a), focus2 / a)


@shared
def spheroid_box(a, b, p, d, h):
    """Signed distance of a spheroid from a box; its axis is the line p + c d, |d| = 1, there."""
    focus2 = a * a - b * b
    low, high = -focus2 / a, focus2 / a
    least = math.inf
    for _ in range(_ITERATIONS):
        c = 0.5 * (low + high)
        x = along(p, d, c)
        distance = point_box(x, h)
        root = math.sqrt(1.0 - c * c / focus2)
        least = min(least, distance - b * root)
        slope = _box_distance_slope(x, d, h, distance) + b * c / (focus2 * root)
        if slope < 0.0:
            low = c
        else:
            high = c
    return least


@inner
def _box_distance_slope(x, d, h, distance):
    """Derivative of the signed distance from a box along d, at x."""
    if distance > 0.0:
        return _box_slope(x, d, 0.0, h) / distance
    for k in range(3):
        if abs(x[k]) - h[k] >= distance:
            return math.copysign(1.0, x[k]) * d[k]
    return 0.0
