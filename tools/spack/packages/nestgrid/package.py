# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Spack's recipe. In a clone of the sources:

    spack repo add tools/spack
    spack dev-build nestgrid@0.1.0 +program
"""
from spack.package import *


class Nestgrid(CMakePackage):
    """Isosurfaces, slices, isolines and height fields drawn directly on the hierarchical grids of
    multigrid, AMR and finite element codes: adaptive, without cracks, with a bound of the error,
    and without a conversion of the data."""

    license("BSD-3-Clause")
    version("0.1.0")

    variant("shared", default=True, description="Build a shared library")
    variant("program", default=False, description="Build the program (needs +cgal+tbb+tetgen+vtk)")
    variant("python", default=False, description="Build the Python package")
    variant("cgal", default=False, description="Coarse grids, sinks and solids of CGAL")
    variant("dealii", default=False, description="Grids of deal.II")
    variant("mpi", default=False, description="Grids that are distributed over ranks")
    variant("p4est", default=False, description="Forests of p4est")
    variant("tbb", default=False, description="Threads by oneTBB")
    variant("tetgen", default=False, description="Coarse grids by TetGen")
    variant("vtk", default=False, description="Grids and sinks of VTK")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("boost@1.74:+container+graph")
    depends_on("cgal@5.5:", when="+cgal")
    depends_on("dealii@9.4:", when="+dealii")
    depends_on("mpi", when="+mpi")
    depends_on("p4est", when="+p4est")
    depends_on("tbb", when="+tbb")
    depends_on("tetgen", when="+tetgen")
    depends_on("vtk@9.1:", when="+vtk")
    with when("+program"):
        depends_on("cli11")
        depends_on("itk@5:")
        depends_on("jsoncpp")
        depends_on("muparser@2.3.3:")
        depends_on("pkgconfig", type="build")
        depends_on("zlib-api")
        requires("+cgal+tbb+tetgen+vtk", msg="the program needs +cgal+tbb+tetgen+vtk")
    with when("+python"):
        extends("python@3.11:")
        depends_on("py-numpy", type=("build", "run"))
        depends_on("py-pybind11@2.10:", type="build")
        depends_on("zlib-api")

    generator("ninja")

    def cmake_args(self):
        components = ("cgal", "dealii", "mpi", "p4est", "python", "tbb", "tetgen", "vtk")
        # Spack has no packages of these.
        absent = ("dune", "openmesh")
        arguments = [
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define_from_variant("NESTGRID_BUILD_TOOLS", "program"),
            self.define("CMAKE_UNITY_BUILD", True),
            self.define("NESTGRID_BUILD_TESTS", False),
            self.define("NESTGRID_BUILD_EXAMPLES", False),
        ]
        for name in components:
            arguments.append(self.define_from_variant(f"NESTGRID_{name.upper()}", name))
        for name in absent:
            arguments.append(self.define(f"NESTGRID_{name.upper()}", False))
        if self.spec.satisfies("+python"):
            arguments += [
                self.define("NESTGRID_PYTHON_EXECUTABLE", python.path),
                self.define("NESTGRID_PYTHON_FOLDER", python_platlib),
            ]
        return arguments
