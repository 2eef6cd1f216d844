#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds everything and runs all tests. Ends with a line that says how many
# passed and failed; fails where one failed or none ran. Arguments are handed to ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/packages.sh
need_packages "${build_packages[@]}" "${test_packages[@]}" "${picture_packages[@]}" \
    "${data_packages[@]}" "${python_packages[@]}" "${python_test_packages[@]}" "${paraview_packages[@]}" \
    "${view_packages[@]}" "${wasm_packages[@]}"
# Its Python conflicts with that of VTK.
unpack_package python3-paraview build/paraview

# What was installed must be found.
demanded=()
for component in CGAL DEALII DUNE OPENMESH P4EST PYTHON TBB TETGEN VTK; do
    demanded+=(-D "NESTGRID_$component=ON")
done
# The pages are made with packages of npm.
pages=ON
timeout 120 npm view three version >/dev/null 2>&1 || {
    pages=OFF
    echo "npm's registry does not answer: the pages for browsers and their tests are left out"
}
demanded+=(-D "NESTGRID_VIEW=$pages" -D "NESTGRID_WASM=$pages")
log=$(mktemp)
cmake --preset release "${demanded[@]}" >"$log" 2>&1 || { cat "$log"; exit 1; }
rm "$log"
cmake --build --preset release

results=build/release/test-results.xml
rm -f "$results"
status=0
ctest --preset release --parallel "$(nproc)" --output-junit "$PWD/$results" "$@" || status=$?
[ -f "$results" ] || exit 1
count() { grep -c "<testcase .*status=\"$1\"" "$results" || true; }
passed=$(count run)
failed=$(count fail)
skipped=$(($(count notrun) + $(count disabled)))
echo "$passed passed, $failed failed, $skipped skipped"
[ "$status" = 0 ] && [ "$passed" -gt 0 ] && [ "$failed" = 0 ]
