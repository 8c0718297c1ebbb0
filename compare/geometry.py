"""Small rotations and surfaces for the checks, without packages: matrices are lists of rows.

A superellipsoid's point is `(a1 cosᵉ¹η cosᵉ²ω, a2 cosᵉ¹η sinᵉ²ω, a3 sinᵉ¹η)` with signed powers; a supertoroid's has
`a4 + cosᵉ¹η` in place of `cosᵉ¹η`. Its own symmetries are the half turns about its axes and, with the first two
semi-axes exchanged, the quarter turns about z.
"""

import itertools
import math


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def transposed(a):
    return [list(column) for column in zip(*a)]


def turned(matrix, v):
    return [sum(x * y for x, y in zip(row, v)) for row in matrix]


def rotation(wxyz):
    """The matrix of a quaternion of any length."""
    length = math.hypot(*wxyz)
    w, x, y, z = (value / length for value in wxyz)
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]


def rotation_vector(matrix):
    """The axis of a rotation times its angle, in radians."""
    axis = [matrix[2][1] - matrix[1][2], matrix[0][2] - matrix[2][0], matrix[1][0] - matrix[0][1]]
    length = math.hypot(*axis)
    angle = math.atan2(length, sum(matrix[k][k] for k in range(3)) - 1)
    return [value / length * angle if length > 1e-15 else 0.0 for value in axis]


def equivalents(matrix):
    """The poses of the same body: for each the order of its semi-axes and its rotation."""
    for order in ((0, 1, 2), (1, 0, 2)):
        for signs in itertools.product((1, -1), repeat=2):
            odd = -1 if order[0] else 1
            signs = (*signs, odd * signs[0] * signs[1])
            yield order, [[row[k] * sign for k, sign in zip(order, signs)] for row in matrix]


def power(value, exponent):
    return math.copysign(abs(value) ** exponent, value)


def surface_points(surface, count=16):
    """Points of a reported surface, the same set for all equivalent poses of it."""
    a, (e1, e2) = surface["semi_axes"], surface["exponents"]
    ring = surface.get("ring_ratio")
    matrix = rotation(surface["orientation_wxyz"])
    low, high = (-count // 2, count // 2) if ring is None else (-count, count)
    points = []
    for i, j in itertools.product(range(low, high), range(2 * count)):
        # half steps stay off the axes, where powers are steep
        eta, omega = (i + 0.5) * math.pi / count, (j + 0.5) * math.pi / count
        radius = (ring or 0.0) + power(math.cos(eta), e1)
        x, y = a[0] * radius * power(math.cos(omega), e2), a[1] * radius * power(math.sin(omega), e2)
        p = deformed([x, y, a[2] * power(math.sin(eta), e1)], a[2], surface.get("deformations") or {})
        points.append([q + t for q, t in zip(turned(matrix, p), surface["position"])])
    return points


def deformed(p, height, deformations):
    """Taper, then twist from the lower end, then the circular bend."""
    x, y, z = p
    if taper := deformations.get("taper"):
        x, y = (value * (1 + slope * z / height) for value, slope in zip((x, y), taper))
    if twist := deformations.get("twist"):
        angle = twist * math.pi * (1 + z / height)
        cos, sin = math.cos(angle), math.sin(angle)
        x, y = cos * x - sin * y, sin * x + cos * y
    if bend := deformations.get("bend"):
        k, cos, sin = bend["k"], math.cos(bend["alpha"]), math.sin(bend["alpha"])
        inwards = cos * x + sin * y
        shift = (1 - math.cos(k * z)) * (1 / k - inwards)
        x, y, z = x + cos * shift, y + sin * shift, math.sin(k * z) * (1 / k - inwards)
    return [x, y, z]
