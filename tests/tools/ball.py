# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""A ball in a turned lattice, whose samples are 100 - |p - CENTRE|: the isosurface of a value v is a
sphere of radius 100 - v around the centre, wherever an axis points.
"""

import numpy as np

SHAPE = (24, 22, 20)
SPACING = np.array([1.5, 2.0, 2.5])
ORIGIN = np.array([-7.0, 31.0, 12.5])
FLIP = np.array([-1, -1, 1])  # from LPS to RAS


def rotation():
    a, b = 0.4, -0.7
    x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    z = np.array([[np.cos(b), -np.sin(b), 0], [np.sin(b), np.cos(b), 0], [0, 0, 1]])
    return z @ x


AXES = rotation()  # its columns
STEPS = AXES * SPACING
CENTRE = ORIGIN + STEPS @ [11.3, 10.2, 9.6]


def ball(steps=STEPS, origin=ORIGIN, centre=CENTRE, shape=SHAPE):
    """Samples of the ball where index (i, j, k) is at origin + steps (i, j, k)."""
    places = np.indices(shape).reshape(3, -1)
    distance = np.linalg.norm(steps @ places + (origin - centre)[:, None], axis=0)
    return (100 - distance).reshape(shape)


def affine(steps=STEPS, origin=ORIGIN):
    matrix = np.eye(4)
    matrix[:3, :3] = steps
    matrix[:3, 3] = origin
    return matrix


def nearest_sphere(points):
    """Centre and radius of the sphere nearest to some points, by least squares."""
    matrix = np.column_stack([2 * points, np.ones(len(points))])
    solution = np.linalg.lstsq(matrix, (points**2).sum(axis=1), rcond=None)[0]
    return solution[:3], np.sqrt(solution[3] + solution[:3] @ solution[:3])
