#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds the program, and extracts the border of the white matter from a
# real magnetic resonance volume: all of it, and as near to that as 500,000 and 150,000 triangles
# allow. A table here, surfaces and a picture in build/demo.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/packages.sh
need_packages "${build_packages[@]}" "${picture_packages[@]}" "${data_packages[@]}"

log=$(mktemp)
{
    cmake --preset release -D NESTGRID_BUILD_TESTS=OFF -D NESTGRID_BUILD_EXAMPLES=OFF \
        -B build/demo-program &&
        cmake --build build/demo-program
} >"$log" 2>&1 || { tail -n 30 "$log" >&2; exit 1; }
rm "$log"

mkdir -p build/demo
build/demo-program/tools/nestgrid isosurface /usr/share/mricron/templates/ch2better.nii.gz \
    --value 95 --max-triangles 50000000 --max-triangles 500000 --max-triangles 150000 \
    --indicator slope --against-vtk \
    -o build/demo/white_matter.vtp --image build/demo/white_matter.png
echo
echo "surfaces: build/demo/white_matter-{1,2,3}.vtp   picture: build/demo/white_matter.png"
