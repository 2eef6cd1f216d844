# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Boxes of cells on levels, from arrays."""
import numpy as np

import nestgrid

# [arrays]
coarse = np.fromfunction(lambda i, j, k: np.hypot(i - 7.5, j - 7.5) + 0.1 * k, (16, 16, 16))
fine = np.fromfunction(lambda i, j, k: np.hypot(i - 7.5, j - 7.5) / 2 + 0.05 * k + 0.375, (16, 16, 16))
field = nestgrid.Blocks([(0, (0, 0, 0), coarse), (1, (8, 8, 8), fine)], ratio=2, spacing=(1, 1, 1))
surface = field.isosurface(3, error=0.01)
# [arrays]

print(len(surface.triangles), "triangles")
