#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs pvpython without a screen, with the package of a build: the one in PATH, or that of Debian's
# python3-paraview unpacked by tools/packages.sh, which cannot be installed beside VTK's Python.
# Ends with status 77 where there is neither.
# Arguments: the source folder, the folder of the package, Python, and what pvpython gets.
set -uo pipefail
source=$1 package=$2 python=$3
unpacked=$source/build/paraview
here=$(cd "$(dirname "$0")" && pwd)
display=$here/../with_display.sh
command -v Xvfb >/dev/null || { echo "skipped: there is no Xvfb"; exit 77; }
export PYTHONDONTWRITEBYTECODE=1
if command -v pvpython >/dev/null; then
    PYTHONPATH=$package exec bash "$display" "$python" -m nestgrid.paraview pvpython "${@:4}"
fi
if ! [ -x "$unpacked/usr/bin/pvpython" ] || ! command -v paraview >/dev/null; then
    echo "skipped: there is no pvpython"
    exit 77
fi
export PYTHONPATH=$here/unpacked:$package:$unpacked/usr/lib/python3/dist-packages
export PV_PLUGIN_PATH=$package/nestgrid/paraview/plugin
exec bash "$display" "$unpacked/usr/bin/pvpython" "${@:4}"
