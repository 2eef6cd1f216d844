#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Several isosurfaces in one walk: they are those of each value alone, to the last triangle.
# Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

# same FILE ARGUMENTS...: the rows of a command with --value 100,130,160 are those of each value
# alone, but for what a walk costs; the triangles of FILE, which it writes, are those of their files.
same() {
    local value file=$1 singles=()
    shift
    run "$@" --value 100,130,160 -o "$file"
    "$program" "$@" --value 100 --value 130,160 --json >together.json 2>err || fail "$*: $(cat err)"
    for value in 100 130 160; do
        "$program" "$@" --value $value --json -o $value.vtp >$value.json 2>err || fail "$*: $(cat err)"
        singles+=($value)
    done
    /usr/bin/python3 - "$file" "${singles[@]}" <<'END' || fail "$*: not those of each value"
import json
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

COSTS = {"seconds", "inspect_calls", "visited", "extracted", "peak_bytes", "stack_bytes",
         "measure_seconds"}


def rows(name):
    with open(f"{name}.json") as file:
        return json.load(file)["surfaces"]


def triangles(path):
    """The corners of each triangle or segment, its isovalue, if any, and its normals, if any."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    cells = data.GetPolys() if data.GetNumberOfPolys() else data.GetLines()
    at = vtk_to_numpy(cells.GetConnectivityArray()).reshape(data.GetNumberOfCells(), -1)
    points = vtk_to_numpy(data.GetPoints().GetData())[at]
    values = data.GetCellData().GetArray("value")
    normals = data.GetPointData().GetNormals()
    return (
        points,
        None if values is None else vtk_to_numpy(values),
        None if normals is None else vtk_to_numpy(normals)[at],
    )


together = rows("together")
assert [row["isovalue"] for row in together] == [float(value) for value in sys.argv[2:]], together
assert [row["visited"] is None for row in together] == [False, True, True], "costs of a walk"
points, values, normals = triangles(sys.argv[1])
for row, value in zip(together, sys.argv[2:]):
    (single,) = rows(value)
    kept = {k: v for k, v in row.items() if k not in COSTS | {"isovalue"}}
    assert kept == {k: v for k, v in single.items() if k not in COSTS}, (kept, single)
    alone, no_value, alone_normals = triangles(f"{value}.vtp")
    assert len(alone) > 0 and no_value is None
    of_value = values == float(value)
    np.testing.assert_array_equal(points[of_value], alone)
    assert (normals is None) == (alone_normals is None)
    if normals is not None:
        np.testing.assert_array_equal(normals[of_value], alone_normals)
assert set(values) == {float(value) for value in sys.argv[2:]}
END
}

raw=(v.raw --dims 20,24,18 --type uint8)
same all.vtp isosurface "${raw[@]}"
same all.vtp isosurface "${raw[@]}" --threshold 5 --cap
same all.vtp isosurface "${raw[@]}" --threshold 5 --no-normals --cuts finest
same all.vtp isosurface "${raw[@]}" --threshold 5 --at-nodes
same all.vtp isosurface "${raw[@]}" --threshold 2 --lens ball:9,9,9,3 --blend 2
same all.vtp isosurface "${raw[@]}" --threshold 30 --box 0,20,0,24,0,9
same all.vtp isosurface "${raw[@]}" --threshold 5 --measure
# What is kept of all the values may draw more than what is kept of one.
run isosurface "${raw[@]}" --value 100,130,160 --error 9
value surface_error | awk '!($1 > 0 && $1 <= 9) { exit 1 }' || fail "an error of 9: $(cat out)"
run isosurface "${raw[@]}" --value 100,130,160 --distance 0.5
many=($(value triangles))
for i in 0 1 2; do
    run isosurface "${raw[@]}" --value $((100 + 30 * i)) --distance 0.5
    [ "$(value triangles)" -le "${many[i]}" ] || fail "a distance: fewer triangles of ${many[*]}"
done
# In the plane, isolines.
{
    printf 'P5\n65 65\n255\n'
    LC_ALL=C awk 'BEGIN { for (i = 0; i < 65 * 65; ++i) printf "%c", 128 + 100 * sin(i % 65 / 9) * cos(int(i / 65) / 7) }'
} >hills.pgm
same all.vtp isosurface hills.pgm --threshold 2

# A file for each threshold, a film of a file for each time; a film is that of each value.
run isosurface "${raw[@]}" --value 100,130 --threshold 2 --threshold 5 -o t.vtp
[ "$(value isovalue | tr '\n' ' ')" = "100 130 100 130 " ] || fail "rows of two thresholds: $(cat out)"
[ -s t-1.vtp ] && [ -s t-2.vtp ] && [ ! -e t-3.vtp ] || fail "not one file for each threshold"
for name in a b; do head -c 8000 v.raw | tail -c 7680 >$name.raw; done
run isosurface a.raw b.raw --dims 20,24,16 --type uint8 --value 100,130 --threshold 2 --frames 3 -o film.vtp
[ "$(grep -c DataSet film.pvd)" = 3 ] && [ "$(value isovalue | wc -l)" = 6 ] || fail "a film: $(cat out)"
for file in t-1.vtp film_0001.vtp; do grep -q 'Name="value"' $file || fail "no values in $file"; done
run isosurface "${raw[@]}" --value 100,130 --image both.png
[ -s both.png ] || fail "no picture of two values"
"$program" isosurface --value 100,130 "${raw[@]}" --threshold 5 -o - --output-format vtp >stream.vtp 2>err || fail "a stream: $(cat err)"
grep -q 'Name="value"' stream.vtp || fail "no values in a stream"

# Values without a surface.
run isosurface "${raw[@]}" --value -7,130,900 -o one.vtp
grep -qE '^the isovalues -7 and 900 are outside the range [0-9]+ to [0-9]+ of the data$' out || fail "two values outside: $(cat out)"
run isosurface "${raw[@]}" --value -7 --value 900 -o none.vtp
grep -qE '^the isosurfaces are empty: the isovalues -7 and 900 are outside' out || fail "no value inside: $(cat out)"
[ -s none.vtp ] || fail "no file of empty surfaces"
run isosurface "${raw[@]}" --value 900
grep -qE '^the isosurface is empty: the isovalue 900 is outside' out || fail "one value: $(cat out)"

# What is wrong, or is for one value.
few=(isosurface "${raw[@]}" --value)
for values in nan 130,nan inf,1; do refused 1 'value is not a finite number' "${few[@]}" $values -o x.vtp; done
refused 1 'value has 130 twice' "${few[@]}" 130,7,130 -o x.vtp
refused 1 'value has 130 twice' "${few[@]}" 130 --value 1.3e2
refused 2 "value" "${few[@]}" '' -o x.vtp
refused 2 "value" "${few[@]}" 1,x -o x.vtp
for option in '--max-triangles 900' '--error 9 --collapse' '--distance 1 --distance-field' '--elements' --against-vtk; do
    refused 1 "is for one --value" "${few[@]}" 100,130 $option -o x.vtp
done
for ending in ply stl obj gltf; do
    refused 1 "several values need an --output as .vtp: in a .$ending nothing tells" "${few[@]}" 100,130 -o x.$ending
done
refused 1 'several values need an --output as .vtp' "${few[@]}" 100,130 -o -
refused 1 'no known format' "${few[@]}" 100,130 -o x.none
exit $((failures > 0))
