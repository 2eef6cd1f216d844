#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Lagrange cells in .vtu files: what they are taken for, surfaces, slices, lines, probes within errors,
# and refusals. Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

# within ERROR WHAT: no open edge, and all bounds at most the error.
within() {
    if grep -qw open_edges out; then
        [ "$(value open_edges | sort -u)" = 0 ] || fail "$2: open edges: $(cat out)"
    fi
    [ -n "$(value error_bound)" ] || fail "$2: no bound: $(cat out)"
    for bound in $(value error_bound); do
        awk -v bound="$bound" -v error="$1" 'BEGIN { exit !(bound <= error * 1.00001) }' || fail "$2: bound $bound"
    done
}

run info solution.vtu
[ "$(value dimension)" = 3 ] && [ "$(value leaf_elements)" = 27 ] && [ "$(value nodes)" = 64 ] ||
    fail "info: $(cat out)"
[ "$(value points)" = 3,375 ] || [ "$(value points)" = 3375 ] || fail "info: points: $(cat out)"
grep -qE '^hexahedron +4 +27$' out && grep -qE '^u +1 +[0-9.e-]+ +[0-9.]+$' out || fail "info: $(cat out)"
run info plane.vtu
[ "$(value dimension)" = 2 ] && grep -qE '^quadrilateral +4 +9$' out || fail "info of a plane: $(cat out)"

for error in 0.1 0.01; do
    run isosurface solution.vtu --field u --value 0.3 --error $error -o s.vtp
    within $error isosurface
    grep -q "^drawn within $error of polynomials of degree 4$" out || fail "nothing on the degree: $(cat out)"
    run slice solution.vtu --field u --plane 0.4,0.5,0.45,0.2,0.1,1 --error $error --outlines -o c.vtp
    within $error slice
    run slice solution.vtu --field u --axis z --at 0.4 --with-isosurface 0.3 --error $error -o c.vtp
    within $error "slice with an isosurface"
    run boundary solution.vtu --array u --error $error -o b.vtp
    within $error boundary
    run isolines plane.vtu --field u --values 0.2,0.3 --error $error -o l.vtp
    within $error isolines
    run isolines solution.vtu --field u --axis x --at 0.3 --count 3 --error $error -o l.vtp
    within $error "isolines on a slice"
    run isosurface plane.vtu --field u --value 0.3 --error $error
    within $error "isosurface of a plane"
    run height plane.vtu --field u --scale 1 --error $error -o h.vtp
    within $error height
done
run isosurface solution.vtu --field u --value 0.3 --error 1%
[ "$(value error_bound)" != - ] || fail "percent: $(cat out)"
run isosurface solution.vtu --field u --value 0.3 --error 0.1 --error 0.01 -o two.vtp
[ "$(value triangles | wc -l)" = 2 ] || fail "two errors: $(cat out)"
run isosurface solution.vtu --field u --value 0.3 --cap --error 0.05 -o s.vtp
[ "$(value boundary_edges)" = 0 ] || fail "a cap leaves $(value boundary_edges) edges"

# Within a number of triangles: the error that is found is kept, and draws the same.
# at_most NUMBER WHAT: so many triangles of all surfaces, within the threshold.
at_most() {
    total=0
    for count in $(value triangles) $(value isosurface_triangles); do
        total=$((total + ${count//,/}))
    done
    [ "$total" -gt 0 ] && [ "$total" -le "$1" ] || fail "$2: $total triangles: $(cat out)"
    within "$(value threshold | sort -u)" "$2"
}
for number in 1000 20000; do
    run isosurface solution.vtu --field u --value 0.3 --max-triangles $number -o budget.vtp
    at_most $number isosurface
    [ "$total" -gt $((number * 8 / 10)) ] || fail "few of $number triangles: $(cat out)"
    run slice solution.vtu --field u --axis z --at 0.4 --max-triangles $number -o c.vtp
    at_most $number slice
    run height plane.vtu --field u --scale 1 --max-triangles $number -o h.vtp
    at_most $number height
done
run isosurface solution.vtu --field u --value 0.3 --max-triangles 1000 --max-triangles 3000
[ "$(value triangles | wc -l)" = 2 ] || fail "two numbers: $(cat out)"
run slice solution.vtu --field u --axis z --at 0.4 --with-isosurface 0.3 --max-triangles 3000 -o c.vtp
at_most 3000 "slice with an isosurface"

# In a lens, beside an error and alone.
run isosurface solution.vtu --field u --value 0.3 --error 0.1 -o s.vtp
without=$(value triangles | tr -d ,)
run isosurface solution.vtu --field u --value 0.3 --error 0.1 --lens ball:0.35,0.6,0.7,0.1 --finest 0.02 -o s.vtp
within 0.1 "a lens"
[ "$(value triangles | tr -d ,)" -gt $((2 * without)) ] || fail "a lens is as coarse: $(cat out)"
run isosurface solution.vtu --field u --value 0.3 --lens ball:0.35,0.6,0.7,0.1 --finest 0.02 -o s.vtp
grep -q 'drawn as finely as the lens asks$' out && [ "$(value open_edges)" = 0 ] || fail "a lens alone: $(cat out)"

# Curved cells: no point is farther from its place than it may be, and nearer ones take more triangles.
# placed PLACES WHAT: no open edge, and all bounds of positions at most so much.
placed() {
    within 0.2 "$2"
    [ -n "$(value position_bound)" ] || fail "$2: no bound of positions: $(cat out)"
    for bound in $(value position_bound); do
        awk -v bound="$bound" -v places="$1" 'BEGIN { exit !(0 < bound && bound <= places * 1.00001) }' ||
            fail "$2: points $bound off, not $1"
    done
    grep -q '^no point is farther than [0-9.e-]* from its place in the curved cells' out || fail "$2: $(cat out)"
}
declare -A of_curved=([isosurface]='shell.vtu --field radius --value 1.6' [band]='shell.vtu --field radius --low 1.2 --high 1.7'
    [slice]='shell.vtu --field radius --plane 0.5,0.7,0.4,0.3,0.2,1' [boundary]='shell.vtu --field radius'
    [isolines]='ring.vtu --field radius --values 1.2,1.7' [surface]='ring.vtu --field radius'
    [height]='ring.vtu --field radius --scale 1')
declare -A before=()
for places in 0.03 0.01 0.003; do
    for command in "${!of_curved[@]}"; do
        run $command ${of_curved[$command]} --error 0.2 --position-error $places
        placed $places "$command"
        count=$(value triangles | tr -d ,)
        [ "$count" -gt "${before[$command]:-0}" ] || fail "$command: $count triangles within $places"
        before[$command]=$count
    done
    run slice ${of_curved[slice]} --with-isosurface 1.6 --error 0.2 --position-error $places
    placed $places "slice with an isosurface"
    run isosurface ring.vtu --field radius --value 1.6 --error 0.2 --position-error $places
    placed $places "isosurface of a ring"
done
run isosurface ${of_curved[isosurface]} --position-error 0.01 --max-triangles 5000
placed 0.01 "a number of triangles"
run isosurface ${of_curved[isosurface]} --position-error 0.01 --lens ball:1,1,1,0.2 --finest 0.1
[ "$(awk -v bound="$(value position_bound)" 'BEGIN { print (bound <= 0.0100001) }')" = 1 ] || fail "a lens: $(cat out)"
for straight in 'solution.vtu --field u --value 0.3' 'v.vti --value 130' 'v.vti --value 130 --error 1'; do
    refused 1 '^[^ ]* --position-error is for curved cells, and all of this grid are straight$' \
        isosurface $straight --position-error 1 -o x.vtp
done
refused 1 '--position-error is for curved cells' slice v.vti --axis z --at 9 --position-error 1 -o x.vtp
for number in 0 -1 nan inf; do
    refused 2 'position-error: .* no positive finite number' isosurface ${of_curved[isosurface]} --position-error $number
done
refused 1 'tolerance of positions is below 1e-12 of the diameter' isosurface ${of_curved[isosurface]} --position-error 1e-15
refused 2 'excludes' isosurface ${of_curved[isosurface]} --position-error 0.1 --threshold 0.1

# Without an error.
run isosurface solution.vtu --field u --value 0.3
grep -q 'about a thousandth of their range: --error chooses another$' out || fail "no word on the error: $(cat out)"
within 0.004 "without an error"
run slice solution.vtu --field u --axis z --at 0.4
within 0.004 "a slice without an error"
printf '0.21,0.33,0.47\n0.5,0.5,0.5\n' >points
run probe solution.vtu --field u --points points
awk -F, 'NR > 1 { u = exp(-12 * (($1 - 0.35) ^ 2 + ($2 - 0.6) ^ 2 + ($3 - 0.4) ^ 2)) + $1 / 5; d = $4 - u; if (d > 0.02 || d < -0.02) exit 1 }' out ||
    fail "probe: $(cat out)"

# Fewer triangles within the error, what is measured of them, and colours of a slice.
run isosurface solution.vtu --field u --value 0.3 --error 0.02
drawn=$(value triangles)
run isosurface solution.vtu --field u --value 0.3 --error 0.02 --collapse --measure
[ "$(value triangles)" -lt "$drawn" ] || fail "no edge is collapsed: $(value triangles) of $drawn triangles"
grep -q 'measured' out || fail "nothing is measured: $(cat out)"
run slice solution.vtu --field u --axis z --at 0.4 --error 0.1
drawn=$(value triangles)
run slice solution.vtu --field u --axis z --at 0.4 --error 0.1 --colour-tolerance 0.01
[ "$(value triangles)" -gt "$drawn" ] || fail "no triangle is split for its colours"

run isosurface solution.vtu --field u --value 0.3 --error 0.1
drawn=$(value triangles)
run isosurface solution.vtu --field u --value 0.3 --error 0.1 --box 0,0.5,0,0.5,0,0.5 --box-threshold 0.005
[ "$(value triangles)" -gt "$drawn" ] || fail "a box is no finer than what is around it"

# Two threads, the same bits.
run isosurface solution.vtu --field u --value 0.3 --error 0.01 --threads 1 -o one.vtp
run isosurface solution.vtu --field u --value 0.3 --error 0.01 --threads 2 -o two.vtp
cmp -s one.vtp two.vtp || fail "two threads draw another surface than one"

refused 1 "there are several fields, choose one by --field: 'u', 'radius'" isosurface solution.vtu --value 0.3
refused 1 "there is no field 'radios', only 'u', 'radius': did you mean 'radius'\?" \
    isosurface solution.vtu --field radios --value 0.3
refused 1 'no threshold of nodes' isosurface solution.vtu --field u --value 0.3 --threshold 0.1 -o x.vtp
refused 1 'even the coarsest surface has more than 3 triangles' \
    isosurface solution.vtu --field u --value 0.3 --max-triangles 3 -o x.vtp
refused 1 'by no number of triangles' isosurface solution.vtu --field u --value 0.3 --max-triangles 500 --collapse -o x.vtp
refused 1 '0 < finest <= coarsest' isosurface solution.vtu --field u --value 0.3 --lens ball:0.5,0.5,0.5,0.1 -o x.vtp
refused 1 'tolerance in the region is not a positive' isosurface solution.vtu --field u --value 0.3 --error 0.1 --box 0,0.5,0,0.5,0,0.5 -o x.vtp
refused 1 "below 1e-12 of the range" isosurface solution.vtu --field u --value 0.3 --error 1e-15 -o x.vtp
refused 1 "magnitude is for" isosurface solution.vtu --field u --value 0.3 --magnitude
refused 1 "has 1 components, and none with number 2" isosurface solution.vtu --field u --component 2 --value 0.3
head -c 3000 solution.vtu >cut.vtu
refused 1 "cut.vtu is truncated" isosurface cut.vtu --field u --value 0.3
printf 'no grid' >not.vtu
refused 1 "'not.vtu' is no VTK unstructured grid file" info not.vtu
sed 's/UnstructuredGrid/PolyData/g' solution.vtu >poly.vtu
refused 1 "'poly.vtu' is no VTK unstructured grid file" info poly.vtu

# One file by hand for each thing that a mesh may have wrong.
# mesh POINTS TYPES VALUES CONNECTIVITY OFFSETS
mesh() {
    cat >"$1" <<END
<VTKFile type="UnstructuredGrid" version="2.2" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="$(($(wc -w <<<"$2") / 3))" NumberOfCells="$(wc -w <<<"$3")">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">$2</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">$5</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">$6</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">$3</DataArray></Cells>
<PointData><DataArray type="Float64" Name="u" format="ascii">$4</DataArray></PointData>
</Piece></UnstructuredGrid></VTKFile>
END
}
square='0 0 0 1 0 0 1 1 0 0 1 0'
mesh good.vtu "$square" 9 '0 1 2 1' '0 1 2 3' 4
run isosurface good.vtu --value 0.5
mesh polygon.vtu "$square" 7 '0 1 2 1' '0 1 2 3' 4
refused 1 "'polygon.vtu': cell 0 is of VTK's type 7, which is not drawn" isosurface polygon.vtu --value 0.5
mesh few.vtu "$square" 23 '0 1 2 1' '0 1 2 3' 4
refused 1 "'few.vtu': cell 0, a quadratic quadrilateral, has 4 points, not 8" isosurface few.vtu --value 0.5
six='0 0 0 1 0 0 0 1 0 0.5 0 0 0.5 0.5 0 0 0.5 0'
mesh triangle.vtu "$six" 22 '0 1 2 1 1 1' '0 1 2 3 4 5' 6
run isosurface triangle.vtu --value 0.5 --error 1e-3
[ "$(value segments)" -gt 1 ] || fail "a quadratic triangle: $(value segments) segments"
# Faces, edges and points beside cells are left out, as mesh generators write them; so are ghosts.
mesh beside.vtu "$six" '1 3 22 0' '0 1 2 1 1 1' '0 0 1 0 1 2 3 4 5' '1 3 9 9'
run isosurface triangle.vtu --value 0.5 --error 1e-3 -o alone.vtp
run isosurface beside.vtu --value 0.5 --error 1e-3 -o beside.vtp
cmp -s alone.vtp beside.vtp || fail "cells of lower dimensions change what is drawn"
grep -q '^3 cells are left out, of a dimension below 2 or ghosts$' out || fail "left out: $(cat out)"
mesh points.vtu "$six" '1 3' '0 1 2 1 1 1' '0 0 1' '1 3'
refused 1 "'points.vtu': there are no cells of dimension 2" isosurface points.vtu --value 0.5
mesh ghost.vtu "0 0 0 1 0 0 1 1 0 0 1 0 2 0 0 2 1 0" '9 9' '0 1 1.5 1 2 2' '0 1 2 3 1 4 5 2' '4 8'
sed -i 's|</Cells>|</Cells><CellData><DataArray type="UInt8" Name="vtkGhostType" format="ascii">0 1</DataArray></CellData>|' ghost.vtu
run info ghost.vtu
[ "$(value leaf_elements)" = 1 ] || fail "a ghost is drawn: $(cat out)"

# Frames: several files, or a list of them; between them the mean is drawn.
mesh later.vtu "$six" 22 '2 1 0 2 1 3' '0 1 2 3 4 5' 6
mesh mean.vtu "$six" 22 '1 1 1 1.5 1 2' '0 1 2 3 4 5' 6
run isosurface mean.vtu --value 1.2 --error 1e-3 -o mean.vtp
[ "$(value segments)" -gt 1 ] || fail "a mean without a line: $(cat out)"
run isosurface triangle.vtu later.vtu --time 0.5 --value 1.2 --error 1e-3 -o between.vtp
cmp -s mean.vtp between.vtp || fail "between two frames another line than that of their mean"
pvd() {
    echo '<VTKFile type="Collection" version="0.1"><Collection>'
    while [ $# -gt 0 ]; do
        echo "<DataSet timestep='$1' part='0' file='$2'/>"
        shift 2
    done
    echo '</Collection></VTKFile>'
}
pvd 2 triangle.vtu 4 later.vtu >run.pvd
run isosurface run.pvd --time 3 --value 1.2 --error 1e-3 -o listed.vtp
cmp -s mean.vtp listed.vtp || fail "a list of frames draws another line"
run isosurface run.pvd --value 1.2 --frames 3 --error 1% -o film.vtp
[ "$(grep -c DataSet film.pvd)" = 3 ] || fail "a film of a list: $(cat film.pvd)"
run info run.pvd
[ "$(value frames)" = 2 ] && [ "$(value last_time)" = 4 ] || fail "info of a list: $(cat out)"
# at NAME TIME FILE: the file, with its time in an array that is called so.
at() {
    sed "s|<Piece|<FieldData><DataArray type=\"Float64\" Name=\"$1\" NumberOfTuples=\"1\" format=\"ascii\">$2</DataArray></FieldData>&|" "$3"
}
at TimeValue 2 triangle.vtu >at2.vtu
at TIME 4 later.vtu >at4.vtu
run isosurface at2.vtu at4.vtu --time 3 --value 1.2 --error 1e-3 -o told.vtp
cmp -s mean.vtp told.vtp || fail "files that tell their times draw another line"
refused 1 "'good.vtu' has another grid than 'triangle.vtu'" isosurface triangle.vtu good.vtu --time 0.5 --value 1 -o x.vtp
pvd 2 triangle.vtu 2 later.vtu >twice.pvd
refused 1 "'twice.pvd' lists 'later.vtu' at no later time" isosurface twice.pvd --time 2 --value 1 -o x.vtp
pvd >none.pvd
refused 1 "'none.pvd' lists no files" isosurface none.pvd --value 1
pvd 1 lost.vtu >lost.pvd
refused 1 "'lost.vtu' does not exist" isosurface lost.pvd --value 1
refused 1 "'run.pvd' lists frames of its own" isosurface run.pvd run.pvd --time 1 --value 1 -o x.vtp

# Files of several processes are one mesh.
mesh left.vtu "$square" 9 '0 1 2 1' '0 1 2 3' 4
mesh right.vtu "1 0 0 2 0 0 2 1 0 1 1 0" 9 '1 2 2 2' '0 1 2 3' 4
cat >both.pvtu <<END
<VTKFile type="PUnstructuredGrid" version="0.1" byte_order="LittleEndian"><PUnstructuredGrid GhostLevel="0">
<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>
<PPointData><PDataArray type="Float64" Name="u"/></PPointData>
<Piece Source="left.vtu"/><Piece Source="right.vtu"/></PUnstructuredGrid></VTKFile>
END
run info both.pvtu
[ "$(value leaf_elements)" = 2 ] && [ "$(value nodes)" = 6 ] || fail "pieces: $(cat out)"
run isosurface both.pvtu --value 0.5
sed 's/right.vtu/gone.vtu/' both.pvtu >gone.pvtu
refused 1 "'gone.vtu' does not exist" isosurface gone.pvtu --value 0.5

# Another field of the file colours a surface.
run isolines solution.vtu --array u --on-surface 0.3 --by radius --values 0.8,1 --error 0.01 -o by.vtp
by_field=$(value length)
run isolines solution.vtu --array u --on-surface 0.3 --by 'sqrt(x^2+y^2+z^2)' --values 0.8,1 --error 0.01 -o by.vtp
[ "$(wc -w <<<"$by_field")" = 2 ] || fail "lines by another field: $(cat out)"
awk -v a="$by_field" -v b="$(value length)" 'BEGIN { n = split(a, x); split(b, y)
    for (i = 1; i <= n; ++i) if ((x[i] - y[i]) ^ 2 > 1e-4 * y[i] ^ 2 || x[i] == 0) exit 1 }' ||
    fail "lines by a field are $by_field long, those by its formula $(value length)"

mesh nan.vtu "$square" 9 '0 1 nan 1' '0 1 2 3' 4
refused 1 "'nan.vtu': 'u' is not a finite number at point 2" isosurface nan.vtu --value 0.5
mesh flat.vtu '0 0 0 1 0 0 2 0 0 3 0 0' 9 '0 1 2 1' '0 1 3 2' 4
refused 1 "'flat.vtu': cell 0 is flat" isosurface flat.vtu --value 0.5
mesh hanging.vtu "$square 2 0 0 2 0.5 0 1 0.5 0 2 1 0" '9 9 9' '0 1 2 1 2 2 2 2' '0 1 2 3 1 4 5 6 6 5 7 2' '4 8 12'
refused 1 "'hanging.vtu': a face of cell 0 is divided on its other side" isosurface hanging.vtu --value 0.5
quadratic='0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.1 0 1 0.5 0 0.5 1 0 0 0.5 0'
mesh curved.vtu "$quadratic" 23 '0 1 2 1 0.3 1.5 1.5 0.5' '0 1 2 3 4 5 6 7' 8
run info curved.vtu
grep -q '^1 cells are curved, by up to 0.1 in units of length' out || fail "curved: $(cat out)"
mesh empty.vtu "$square" '' '0 1 2 1' '' ''
refused 1 "'empty.vtu'" isosurface empty.vtu --value 0.5
mesh two.vtu "0 0 0 1 0 0 1 1 0 0 1 0 1 0 0 2 0 0 2 1 0 1 1 0" '9 9' '0 1 2 1 1.5 2 2 2' '0 1 2 3 4 5 6 7' '4 8'
run isosurface two.vtu --value 0.5
grep -q '^cells disagree on values at nodes that they share, by up to 0.25: their mean is drawn' out ||
    fail "values apart: $(cat out)"

exit $((failures > 0))
