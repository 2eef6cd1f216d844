#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# A real piecewise linear complex with holes becomes hierarchies of all simplicial families.
# Arguments: the program, example.poly of the package tetgen; without it the test is skipped, in
# continuous integration (CI=true) it fails.
set -uo pipefail
. "$(dirname "$0")/values.sh"
program=$1
complex=$2
if [ ! -s "$complex" ]; then
    echo "example.poly is missing: install the package tetgen"
    [ "${CI:-}" = true ] && exit 1
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
for family in bisection red-green; do
    "$program" mesh "$complex" --family $family --field 'sqrt((x-5)^2+y^2+(z-2)^2)' \
        --tolerance 0.01 -o "$work/c.nestgrid" >"$work/out" || exit 1
    [ "$(value measure)" = 17.9375 ] || { echo "volume $(value measure)"; exit 1; }
    "$program" isosurface "$work/c.nestgrid" --value 3.5 --cap >"$work/out" || exit 1
    [ "$(value open_edges)" = 0 ] && [ "$(value triangles)" -gt 100 ] || { cat "$work/out"; exit 1; }
done
