# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The hints are those of the real module, and programs of users pass mypy with them."""
import inspect
import os
import re
import subprocess
import sys

import pytest

pytest.importorskip("mypy")

import nestgrid  # noqa: E402
from nestgrid import _nestgrid  # noqa: E402

PACKAGE = os.path.dirname(nestgrid.__file__)
ENVIRONMENT = dict(os.environ, MYPYPATH=os.path.dirname(PACKAGE))


def run(*arguments, cwd):
    return subprocess.run(
        [sys.executable, "-m", *arguments],
        capture_output=True,
        text=True,
        cwd=cwd,
        env=ENVIRONMENT,
    )


def test_stub_of_the_compiled_module(tmp_path):
    # Classes of pybind11 have a metaclass, and constructors that take anything and refuse it.
    allowed = r"nestgrid\._nestgrid\.\w+(\.__init__)?"
    (tmp_path / "allowed").write_text(allowed + "\n")
    done = run(
        "mypy.stubtest", "nestgrid._nestgrid", "--allowlist", str(tmp_path / "allowed"), cwd=tmp_path
    )
    assert done.returncode == 0, done.stdout + done.stderr


def stub_signatures():
    """The parameters of each function and method of the stub."""
    import ast

    with open(os.path.join(PACKAGE, "_nestgrid.pyi"), encoding="utf-8") as file:
        tree = ast.parse(file.read())

    def functions(body, prefix):
        for node in body:
            if isinstance(node, ast.ClassDef):
                yield from functions(node.body, node.name + ".")
            elif isinstance(node, ast.FunctionDef) and not any(
                isinstance(each, ast.Name) and each.id == "property"
                for each in node.decorator_list
            ):
                yield prefix + node.name, [each.arg for each in node.args.args]

    yield from functions(tree.body, "")


@pytest.mark.parametrize("name, parameters", list(stub_signatures()))
def test_arguments_of_the_compiled_module(name, parameters):
    """pybind11 writes the arguments into the docstring, which no tool compares with the stub."""
    function = _nestgrid
    for part in name.split("."):
        function = inspect.getattr_static(function, part)
    function = getattr(function, "__func__", function)
    signature = function.__doc__.splitlines()[0]
    # Commas within types stand in brackets.
    inside = re.sub(r"\[[^][]*\]", "", re.sub(r"\[[^][]*\]", "", signature))
    real = re.findall(r"[(,] ?(\w+): ", inside)
    assert real[: len(parameters)] == parameters, signature
    assert len(real) == len(parameters), signature


def test_the_package(tmp_path):
    done = run(
        "mypy",
        "--check-untyped-defs",
        "--disallow-untyped-defs",
        "--ignore-missing-imports",
        "--exclude",
        "paraview",
        "-p",
        "nestgrid",
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stdout


PROGRAM = """
import numpy as np
import nestgrid

volume = nestgrid.Volume(np.zeros((3, 3, 3)), spacing=(1, 1, 2))
surface = volume.isosurface(0.5, max_triangles=100, indicator="{indicator}", lens=((0, 0, 0), 1))
reveal_type(surface)
reveal_type(surface.vertices)
verts, faces, normals, values = nestgrid.marching_cubes(np.zeros((3, 3, 3)), method="{method}")
field = nestgrid.load("x.raw", dims=(3, 3, 3), type="{type}")
"""
RIGHT = {"indicator": "visual", "method": "lewiner", "type": "float32"}


@pytest.mark.parametrize("wrong", [None, *RIGHT])
def test_a_program_of_a_user(tmp_path, wrong):
    """Names are literals: a wrong one is an error before the program runs."""
    names = RIGHT | ({wrong: "wrong"} if wrong else {})
    (tmp_path / "program.py").write_text(PROGRAM.format(**names))
    done = run("mypy", "program.py", cwd=tmp_path)
    assert (done.returncode == 0) == (wrong is None), done.stdout
    assert 'Revealed type is "nestgrid._results.Surface"' in done.stdout
    assert "numpy.ndarray" in done.stdout
    if wrong:
        assert "Literal" in done.stdout and done.stdout.count("error:") == 1
