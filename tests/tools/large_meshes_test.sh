#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Meshes of 10 MB and more in every format, and complexes of thousands of facets, become hierarchies.
# Arguments: the program, the maker of meshes.
set -uo pipefail
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$2" "$work" 36 || exit 1
cd "$work" || exit 1
failures=0
fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}
value() { awk -v name="$1" '$1 == name { print $2 }' out; }

# A torus of radii 3 and 1 has the area 12 pi^2 = 118.435.
for file in t.off t.obj t.ply t.stl c.ele c.node p.poly s.smesh; do
    "$program" mesh $file --family bisection -o x.nestgrid >out 2>err || fail "$file: $(cat err)"
    [ ! -s err ] || fail "$file: wrote to standard error: $(cat err)"
    case $file in
    t.*) elements=311040 least=118.42 most=118.44 ;;
    c.*) elements=384000 least=0.99999 most=1.00001 ;;
    *) elements=$(value coarse_elements) least=0.99999 most=1.00001 ;;
    esac
    [ "$(value coarse_elements)" = "$elements" ] || fail "$file: $(value coarse_elements) elements"
    [ "$(value coarse_elements)" -gt 10000 ] || fail "$file: $(value coarse_elements) elements"
    awk -v measure="$(value measure)" -v least=$least -v most=$most \
        'BEGIN { exit !(measure > least && measure < most) }' || fail "$file: $(value measure)"
done
[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
