#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds the Python package, and installs it into a virtual environment of
# Debian's Python in build/python, which sees the system's NumPy and VTK.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/packages.sh
need_packages cmake ninja-build g++ libboost-graph-dev "${python_packages[@]}"
# ParaView's Python brings a VTK of its own, which would be removed.
command -v pvpython >/dev/null || need_packages python3-vtk9 xvfb xauth

/usr/bin/python3 -m venv --system-site-packages build/python
build/python/bin/pip install . --no-index --no-build-isolation --disable-pip-version-check
echo "build/python/bin/python has the package nestgrid"
