# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
import os
import subprocess

import numpy as np
import pytest


class Reference:
    """Arrays that the library has written from C++."""

    def __init__(self, folder):
        self.folder = folder

    def array(self, name, dtype, *shape):
        return np.fromfile(os.path.join(self.folder, name), dtype).reshape(*shape or (-1,))

    def same_numbers(self, name, result):
        counts = result.counts
        ours = [result.error_bound, result.threshold]
        ours += [counts["calls"], counts["visited"], counts["extracted"]]
        theirs = self.array(name + ".numbers", float)
        np.testing.assert_array_equal(ours, theirs)

    def same_surface(self, name, surface):
        """Asserts that two surfaces are equal to the last bit, and that there is one."""
        assert len(surface.triangles) > 0
        for part, dtype in (("vertices", float), ("triangles", np.uint32), ("normals", float)):
            theirs = self.array(f"{name}.{part}", dtype, -1, 3)
            ours = getattr(surface, part)
            assert ours.dtype == dtype
            assert ours.shape == theirs.shape and ours.tobytes() == theirs.tobytes(), part
        theirs = self.array(name + ".attributes", float)
        assert surface.attributes.tobytes() == theirs.tobytes()
        self.same_numbers(name, surface)

    def same_triangles(self, name, surface):
        """Asserts that two surfaces have the same triangles, in any order, and that there is one."""

        def sorted_triangles(vertices, triangles):
            turned = (np.roll(t, -min(range(3), key=lambda k: tuple(t[k])), axis=0) for t in vertices[triangles])
            return sorted(t.tobytes() for t in turned)

        assert len(surface.triangles) > 0
        theirs = self.array(f"{name}.vertices", float, -1, 3), self.array(f"{name}.triangles", np.uint32, -1, 3)
        assert sorted_triangles(surface.vertices, surface.triangles) == sorted_triangles(*theirs)
        self.same_numbers(name, surface)

    def same_lines(self, name, lines):
        assert len(lines) > 0
        theirs = {
            "vertices": self.array(name + ".vertices", float, -1, 3),
            "points": self.array(name + ".points", np.uint32),
            "first": self.array(name + ".first", np.uint64),
            "values": self.array(name + ".values", float),
        }
        for part, array in theirs.items():
            np.testing.assert_array_equal(getattr(lines, part), array)


@pytest.fixture(scope="session")
def reference(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reference")
    subprocess.run([os.environ["NESTGRID_REFERENCE"], folder], check=True)
    return Reference(folder)


@pytest.fixture(scope="session")
def gyroid():
    """Samples of a gyroid of two periods, 65 along each index, in C order."""
    x, y, z = np.meshgrid(*[np.linspace(0, 4 * np.pi, 65)] * 3, indexing="ij")
    values = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return values.astype(np.float32)
