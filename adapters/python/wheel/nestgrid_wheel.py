# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""What pip calls to make a wheel: CMake builds and installs the component, this packs it.

Needs CMake, a compiler, pybind11 and nothing from a network. The library is linked statically.
    pip install . --config-settings build-dir=DIR    builds in a CMake build tree that is configured
                                                     with NESTGRID_PYTHON=ON, in the place of
                                                     build/wheel
"""
import base64
import hashlib
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

ROOT = os.getcwd()  # as PEP 517 says
ADAPTERS = "CGAL DEALII DUNE OPENMESH P4EST TBB TETGEN VTK".split()


def get_requires_for_build_wheel(config_settings=None):
    return []


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("there are no source distributions: take the repository")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    project = _project()
    tag = _tag()
    name = f"{project['name']}-{project['version']}-{tag}.whl"
    with tempfile.TemporaryDirectory() as prefix:
        _install((config_settings or {}).get("build-dir"), prefix)
        _pack(os.path.join(prefix, "site"), os.path.join(wheel_directory, name), project, tag)
    return name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    project = _project()
    info = f"{project['name']}-{project['version']}.dist-info"
    os.mkdir(os.path.join(metadata_directory, info))
    for name, data in _texts(project, _tag()).items():
        with open(os.path.join(metadata_directory, info, name), "wb") as file:
            file.write(data)
    return info


def _project():
    with open(os.path.join(ROOT, "pyproject.toml"), "rb") as file:
        return tomllib.load(file)["project"]


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _install(build, prefix):
    """Builds in a folder, and installs the component into prefix/site."""
    configured = build is not None
    build = os.path.abspath(build) if configured else os.path.join(ROOT, "build", "wheel")
    options = [
        f"-DNESTGRID_PYTHON_EXECUTABLE={sys.executable}",
        "-DNESTGRID_PYTHON_FOLDER=site",
        "-DNESTGRID_PYTHON=ON",
    ]
    if not configured:
        options += ["-S", ROOT, "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_SHARED_LIBS=OFF"]
        options += [f"-DNESTGRID_BUILD_{part}=OFF" for part in ("TESTS", "TOOLS", "EXAMPLES")]
        options += [f"-DNESTGRID_{adapter}=OFF" for adapter in ADAPTERS]
        if shutil.which("ninja"):
            options += ["-G", "Ninja"]
        if shutil.which("ccache"):
            options += ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"]
        subprocess.run(["cmake", "-B", build, *options], check=True)
    jobs = str(os.cpu_count() or 1)
    subprocess.run(
        ["cmake", "--build", build, "--target", "nestgrid_python", "--parallel", jobs], check=True
    )
    install = ["cmake", "--install", build, "--component", "python", "--strip", "--prefix", prefix]
    subprocess.run(install, check=True)
    if configured:
        _gather(prefix)


def _gather(prefix):
    """Moves the package to prefix/site from wherever the build tree installs it."""
    for folder, folders, _ in os.walk(prefix):
        if "nestgrid" in folders:
            shutil.move(folder, os.path.join(prefix, "site"))
            return


def _texts(project, tag):
    """What a wheel says about itself, by file."""
    with open(os.path.join(ROOT, project["readme"]), encoding="utf-8") as file:
        readme = file.read()
    metadata = [
        "Metadata-Version: 2.1",
        f"Name: {project['name']}",
        f"Version: {project['version']}",
        f"Summary: {project['description']}",
        f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {package}" for package in project["dependencies"]),
        "Description-Content-Type: text/markdown",
        "",
        readme,
    ]
    wheel = ["Wheel-Version: 1.0", "Generator: nestgrid", "Root-Is-Purelib: false", f"Tag: {tag}"]
    with open(os.path.join(ROOT, project["license"]["file"]), "rb") as file:
        licence = file.read()
    return {
        "LICENSE": licence,
        "METADATA": "\n".join(metadata).encode(),
        "WHEEL": ("\n".join(wheel) + "\n").encode(),
    }


def _pack(site, path, project, tag):
    info = f"{project['name']}-{project['version']}.dist-info"
    record = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:

        def add(name, data):
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(data)}")
            archive.writestr(name, data)

        for folder, _, files in sorted(os.walk(site)):
            for each in sorted(files):
                full = os.path.join(folder, each)
                with open(full, "rb") as file:
                    add(os.path.relpath(full, site), file.read())
        for name, data in _texts(project, tag).items():
            add(f"{info}/{name}", data)
        record.append(f"{info}/RECORD,,")
        archive.writestr(f"{info}/RECORD", "\n".join(record) + "\n")
