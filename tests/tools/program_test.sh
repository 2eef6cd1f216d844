#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The program as its users meet it: every format in and out, and wrong input of every kind.
# Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

raw_options=(--dims 20,24,18 --type uint8 --spacing 0.5,1,2)
expected=
for format in vti mhd mha nii nii.gz nrrd nhdr raw; do
    options=()
    [ $format = raw ] && options=("${raw_options[@]}")
    "$program" isosurface v.$format --value 130 --threshold 2 "${options[@]}" >out 2>err ||
        fail "$format: $(cat err)"
    [ ! -s err ] || fail "$format: wrote to standard error: $(cat err)"
    [ "$(value open_edges)" = 0 ] || fail "$format: open edges"
    [ "$(value components)" = 1 ] || fail "$format: components"
    got="$(value triangles) $(value vertices) $(value area) $(value volume)"
    [ -n "$expected" ] || expected=$got
    [ "$got" = "$expected" ] || fail "$format gives $got, not $expected"
    "$program" info v.$format "${options[@]}" >out || fail "info $format"
    [ "$(value greatest_value)" = 250 ] || fail "info $format: range"
done

# 2 % of the range are 4.8.
"$program" isosurface v.vti --value 130 --threshold 2% >out && a=$(value triangles)
"$program" isosurface v.vti --value 130 --threshold 4.8 >out && b=$(value triangles)
[ "$a" = "$b" ] || fail "percent: $a, $b"

# Samples of whole numbers that equal the isovalue.
"$program" isosurface v.vti --value 130 --threshold 2 >out && a=$(value triangles)
"$program" isosurface v.vti --value 130 --threshold 2 --at-nodes >out && b=$(value triangles)
[ "$b" -lt "$a" ] || fail "at nodes: $a, $b"
[ "$(value open_edges) $(value nonmanifold_edges) $(value nonmanifold_vertices)" = "0 0 0" ] || fail "at nodes: $(cat out)"

# Budgets, boxes and threads.
"$program" isosurface v.vti --value 130 --threshold 0 --threads 1 -o one.vtp >out &&
    finest=$(value triangles)
"$program" isosurface v.vti --value 130 --threshold 0 --threads 3 -o three.vtp >out || fail "threads"
cmp -s one.vtp three.vtp || fail "three threads draw something else"
"$program" isosurface v.vti --value 130 --max-triangles $((finest / 2)) >out || fail "budget"
[ "$(value triangles)" -le $((finest / 2)) ] || fail "budget: $(value triangles) triangles"
[ "$(value open_edges)" = 0 ] && [ "$(value search_trials)" -gt 5 ] || fail "budget: search"
"$program" isosurface v.vti --value 130 --max-triangles $((2 * finest)) \
    --max-triangles $((finest / 2)) >out || fail "budgets"
[ "$(value threshold | head -1)" = 0 ] && [ "$(value max_triangles | tail -1)" = $((finest / 2)) ] ||
    fail "budgets: $(cat out)"
grep -q "^$finest of $((2 * finest)) triangles: nothing is left out" out || fail "why: $(cat out)"
# An error that is asked for is kept.
for error in 5 20 60 10%; do
    "$program" isosurface v.vti --value 130 --error $error >out || fail "error $error: $(cat out)"
    awk -v b="$(value error_bound)" -v t="$(value threshold)" 'BEGIN { exit !(0 < b && b <= t) }' ||
        fail "error $error: $(cat out)"
    [ "$(value open_edges)" = 0 ] || fail "error $error: an open surface"
    awk -v b="$(value surface_error)" -v t="$(value threshold)" 'BEGIN { exit !(0 < b && b <= t) }' &&
        grep -q '^surface within .* of the isovalue' out || fail "error $error there and back: $(cat out)"
    triangles=$(value triangles)
    "$program" isosurface v.vti --value 130 --error $error --collapse --measure >out ||
        fail "collapses, error $error: $(cat out)"
    awk -v m="$(value measured_error)" -v b="$(value surface_error)" -v t="$(value threshold)" \
        'BEGIN { exit !(0 < m && m <= b && b <= t) }' || fail "collapses, error $error: $(cat out)"
    [ "$(value triangles)" -lt "$triangles" ] && [ "$(value open_edges)" = 0 ] ||
        fail "collapses, error $error: $(value triangles) triangles in the place of $triangles"
    grep -q 'lie on their side' out && grep -q '^distances are in' out || fail "collapses: $(cat out)"
done
"$program" isosurface v.vti --value 130 --distance 3 --distance-field --measure >out ||
    fail "distance: $(cat out)"
awk -v d="$(value distance)" -v b="$(value distance_back)" -v t="$(value threshold)" \
    'BEGIN { exit !(0 < d && d <= t && b <= t) }' || fail "distance: $(cat out)"
grep -q 'no point of the surface is farther' out || fail "distance: $(cat out)"
triangles=$(value triangles)
"$program" isosurface v.vti --value 130 --distance 3 --collapse --measure >out || fail "distance: $(cat out)"
awk -v d="$(value distance)" -v b="$(value distance_back)" -v t="$(value threshold)" \
    'BEGIN { exit !(0 < d && d <= t && b <= t) }' || fail "collapses, distance: $(cat out)"
[ "$(value triangles)" -lt $((triangles / 2)) ] && [ "$(value open_edges)" = 0 ] &&
    [ "$(value exceeding)" = 0 ] && grep -q 'no point of the surface is farther' out ||
    fail "collapses, distance: $(value triangles) triangles in the place of $triangles"
# Collapses to a number of triangles have the least error, and are those within that error.
"$program" isosurface v.vti --value 130 --max-triangles 300 --collapse >out || fail "budget: $(cat out)"
triangles=$(value triangles)
[ "$triangles" -le 300 ] && grep -q '^surface within .* of the isovalue' out || fail "budget: $(cat out)"
"$program" isosurface v.vti --value 130 --error "$(value threshold)" --collapse >out || fail "budget: $(cat out)"
[ "$(value triangles)" = "$triangles" ] || fail "$(value triangles) triangles of the error of a budget"
"$program" isosurface v.vti --value 130 --max-triangles 999999 --collapse >out || fail "budget: $(cat out)"
[ "$(value threshold)" = 0 ] && grep -q 'nothing is left out' out || fail "a budget for all: $(cat out)"
# All data are nowhere away from themselves, but for cuts that are kept off nodes.
"$program" isosurface v.vti --value 130 --measure >out || fail "measure: $(cat out)"
awk -v d="$(value distance)" -v b="$(value distance_back)" -v m="$(value measured_error)" \
    'BEGIN { exit !(d < 1e-5 && b < 1e-5 && m < 1e-3) }' || fail "measure: $(cat out)"
"$program" isosurface v.vti --value 130 --threshold 50 --box=-100,100,-100,100,-100,100 >out ||
    fail "box"
[ "$(value triangles)" = "$finest" ] || fail "box around everything: $(value triangles)"
"$program" isosurface v.vti --value 130 --threshold 50 --box=2,5,2,5,2,5 --box-threshold 1 >out ||
    fail "box"
[ "$(value triangles)" -lt "$finest" ] && [ "$(value open_edges)" = 0 ] || fail "small box"
# Indicators. At threshold 0 each draws the finest surface; above it the surface stays closed.
"$program" isosurface v.vti --value 130 >out && area=$(value area)
for indicator in visual numerical wavelet; do
    run_indicator() { "$program" isosurface v.vti --value 130 --indicator $indicator "$@" >out 2>err; }
    run_indicator --threshold 0 || fail "$indicator: $(cat err)"
    awk -v a="$(value area)" -v b="$area" 'BEGIN { exit !((a - b)^2 < 1e-10 * b^2) }' ||
        fail "$indicator at 0: the area is $(value area), not $area"
    threshold=$([ $indicator = visual ] && echo 0.7 || echo 10%)
    run_indicator --threshold $threshold --blend 1.5 || fail "$indicator: $(cat err)"
    [ "$(value triangles)" -lt "$finest" ] && [ "$(value open_edges)" = 0 ] || fail "$indicator"
    for blend in 1 1.5; do
        run_indicator --max-triangles $((finest / 2)) --blend $blend || fail "$indicator: $(cat err)"
        within_budget $((finest / 2)) isosurface v.vti --value 130 --indicator $indicator --blend $blend
        [ "$(value open_edges)" = 0 ] || fail "$indicator within a budget, blended by $blend: $(cat out)"
    done
    run_indicator --threshold 2 --box=2,5,2,5,2,5 --box-threshold 0 || fail "$indicator: $(cat err)"
    [ "$(value open_edges)" = 0 ] || fail "$indicator in a box"
done
"$program" isosurface v.vti --value 130 --threshold 4 --indicator offset --blend 1 >out && a=$(value triangles)
"$program" isosurface v.vti --value 130 --threshold 4 >out && b=$(value triangles)
[ "$a" = "$b" ] || fail "the indicator is not the offset by default: $a, $b"
refused 1 'blend is not a finite number' isosurface v.vti --value 130 --threshold 1 --blend 0.5
refused 1 'blend is not a finite number' isosurface v.vti --value 130 --threshold 1 --blend inf
refused 1 'leave out --blend' isosurface v.vti --value 130 --threshold 1 --blend 2 --box 0,1,0,1,0,1
refused 1 'no percentages' isosurface v.vti --value 130 --threshold 2% --indicator visual
refused 2 "'geometry' is none of 'offset'" isosurface v.vti --value 130 --threshold 2 --indicator geometry
"$program" isosurface --help-all | grep -q geometry && fail "the help offers an indicator of curved grids, which no file has"
refused 2 'indicator: ' isosurface v.vti --value 130 --threshold 2 --indicator colour
refused 1 'even the coarsest surface has more than 1' isosurface v.vti --value 130 --max-triangles 1
refused 1 'max-triangles is not positive' isosurface v.vti --value 130 --max-triangles 0
refused 2 'excludes' isosurface v.vti --value 130 --max-triangles 9 --threshold 1
refused 1 'box is empty' isosurface v.vti --value 130 --threshold 1 --box 1,0,0,1,0,1
refused 1 'box is empty' isosurface v.vti --value 130 --threshold 1 --box 0,nan,0,1,0,1
refused 1 'box-threshold is negative' isosurface v.vti --value 130 --threshold 1 --box 0,1,0,1,0,1 --box-threshold -1
refused 2 'box' isosurface v.vti --value 130 --box 0,1
refused 2 'box' isosurface v.vti --value 130 --box-threshold 1
refused 1 'threads is negative' isosurface v.vti --value 130 --threads -1

for format in vtp ply stl obj gltf; do
    "$program" isosurface float.vti --value 130 -o s.$format >out 2>err || fail "-o s.$format: $(cat err)"
    [ -s s.$format ] || fail "s.$format is missing"
done
"$program" isosurface v.vti --value 130 --threshold 0 --threshold 10 --against-vtk -o t.vtp >out ||
    fail "table"
[ -s t-1.vtp ] && [ -s t-2.vtp ] || fail "numbered output"
grep -q '^ *vtkFlyingEdges3D ' out || fail "row of VTK"

"$program" isosurface v.vti --value 900 -o empty.vtp >out 2>err || fail "empty: status"
grep -q '^the isosurface is empty: the isovalue 900 is outside the range' out || fail "empty: $(cat out)"
[ -s empty.vtp ] || fail "empty.vtp is missing"
run isosurface v.vti --value 900 --threshold 0 --threshold 9
[ "$(grep -c 'isovalue 900 is outside the range [0-9.]* to [0-9.]* of the data' out)" = 1 ] ||
    fail "two thresholds: $(cat out)"
run slice v.vti --axis z --at 9 --with-isosurface 900
grep -q 'the isosurface is empty: the isovalue 900 is outside the range' out || fail "slice: $(cat out)"
refused 1 'the isosurface is empty: the isovalue 900 is outside' isolines v.vti --on-surface 900 --by x --count 3

if command -v Xvfb >/dev/null; then
    env -u DISPLAY "$program" isosurface v.vti --value 130 --image p.png >out 2>err ||
        fail "picture: $(cat err)"
    [ "$(head -c 4 p.png | tail -c 3)" = PNG ] || fail "picture: no PNG"
    pgrep -P $$ Xvfb >/dev/null && fail "Xvfb was left running"
fi
prefix=(env -u DISPLAY PATH=/nowhere)
refused 1 'install the package xvfb' isosurface v.vti --value 130 --image q.png
prefix=(env)

for format in vti mha nii nii.gz nrrd raw; do
    size=$(stat -c %s v.$format)
    for part in 10 $((size / 2)) $((size - 2)); do
        [ $part -lt "$size" ] || continue
        head -c $part v.$format >cut.$format
        options=()
        [ $format = raw ] && options=("${raw_options[@]}")
        refused 1 "cut.$format" isosurface cut.$format --value 130 "${options[@]}" -o x.vtp
        rm cut.$format
    done
done
cp v.mhd cut.mhd && sed -i 's/v\.[a-z]*raw/cut.raw/' cut.mhd
head -c 100 v.raw >cut.raw
refused 1 'truncated' isosurface cut.mhd --value 130
rm cut.raw
refused 1 'does not exist' isosurface cut.mhd --value 130

refused 1 'has 8640 bytes, but --dims and --type ask for 8820' isosurface v.raw --value 1 --dims 20,21,21 --type uint8
refused 1 'has 8640 bytes' isosurface v.raw --value 1 --dims 20,24,18 --type int16
refused 1 'give --dims' isosurface v.raw --value 1
# A sample that is no number leaves a hole: 24 tetrahedra, or more where the lattice is finer around it.
run info nan.vti && [ "$(value missing)" = 1 ] || fail "nan.vti: $(value missing) samples are missing"
run isosurface nan.vti --value 130 && grep -q '1 of 8640 samples have no value' out || fail "nan.vti: says nothing"
refused 1 '8640 x 1 x 1' isosurface v.raw --value 1 --dims 8640,1,1 --type uint8
refused 1 '3 numbers per sample' isosurface colours.vti --value 1
{
    head -c 40 v.nii
    printf '\4\0'
    tail -c +43 v.nii | head -c 6
    printf '\2\0'
    tail -c +51 v.nii
    tail -c +353 v.nii
} >series.nii
run info series.nii
grep -q '^frame 0 of the 2 in series.nii is read; --frame chooses another, from 0 or 1$' out || fail "series.nii: $(cat out)"
refused 1 'series.nii has no frame 2: --frame is 0 or 1' info series.nii --frame 2
cp v.vti V.VTI && run isosurface V.VTI --value 130 -o X.STL && [ -s X.STL ] || fail "endings in capital letters"
refused 1 "no point data array 'rain'" isosurface v.vti --array rain --value 1
refused 1 'does not exist' isosurface nothing.vti --value 1
echo x >what.abc
refused 1 'known format' isosurface what.abc --value 1
: >empty.nii && refused 1 'is empty' isosurface empty.nii --value 1
refused 1 'cannot be written' isosurface v.vti --value 130 -o missing/x.vtp
refused 1 'names no known format' isosurface v.vti --value 130 -o x.doc
refused 1 'output has an empty name' isosurface v.vti --value 130 -o ''
refused 1 'image has an empty name' isosurface v.vti --value 130 --image ''
refused 1 "'' does not exist$" info ''
head -c 1000 /dev/zero >zeros.raw
run isosurface zeros.raw --dims 10,10,10 --type uint8 --value 0
grep -q '^the isosurface is empty: the data have the value 0 everywhere' out || fail "constant data: $(cat out)"
run isosurface v.vti --value -900 --cap
! grep -q 'is empty' out || fail "a capped volume is said to be empty: $(cat out)"
refused 1 "threshold 'much'" isosurface v.vti --value 130 --threshold much
refused 1 "threshold '-3'" isosurface v.vti --value 130 --threshold=-3
refused 2 '--frobnicate' isosurface v.vti --value 130 --frobnicate
refused 2 'value is required' isosurface v.vti
refused 2 "no option --valu=130: did you mean '--value'" isosurface v.vti --valu=130 -o x.vtp
refused 2 '' isosurface
refused 2 "there is no command 'paint'" paint v.vti
# Hierarchies.
cat >tetra.off <<'END'
OFF
4 4 0
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
END
cat >cube.smesh <<'END'
8 3 0 0
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
6 0
4 1 2 3 4
4 5 6 7 8
4 1 2 6 5
4 2 3 7 6
4 3 4 8 7
4 4 1 5 8
0
0
END
cat >quad.obj <<'END'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
f 1 2 3 4
END
for family in bisection red-green; do
    "$program" mesh cube.smesh --family $family --field 'sqrt(x^2+y^2+z^2)' --tolerance 0.004 \
        -o $family.nestgrid >out 2>err || fail "mesh $family: $(cat err)"
    [ ! -s err ] || fail "mesh $family wrote to standard error"
    [ "$(value measure)" = 1 ] || fail "mesh $family: volume $(value measure)"
    [ "$(value hanging_nodes)" = 0 ] || fail "mesh $family: hanging nodes"
    facts >first && "$program" info $family.nestgrid >out && facts | cmp -s - first || fail "info $family"
    "$program" isosurface $family.nestgrid --value 0.7 -o $family.vtp >out || fail "iso $family"
    [ "$(value open_edges)" = 0 ] || fail "iso $family: open edges"
    # An eighth of a sphere: its area to a percent.
    awk -v area="$(value area)" 'BEGIN { exit !(area > 0.76 && area < 0.775) }' ||
        fail "iso $family: area $(value area)"
done
"$program" mesh tetra.off --family red-green --field front --tolerance 0.05 -o t.nestgrid >out ||
    fail "mesh of a surface"
"$program" isosurface t.nestgrid --value 0 --array front >out || fail "isolines"
[ "$(value segments)" -gt 10 ] || fail "isolines: $(value segments) segments"
"$program" mesh tetra.off --family prism --layers 0.1,0.2 --refine 1 -o p.nestgrid >out ||
    fail "prisms"
[ "$(value leaf_prism)" = 64 ] || fail "prisms: $(value leaf_prism)"
"$program" mesh quad.obj --family octree --unbalanced --field 'sin(4*x*y)' --refine 3 -o q.nestgrid >out ||
    fail "quadtree"
[ "$(value leaf_quadrilateral)" = 64 ] || fail "quadtree: $(value leaf_quadrilateral)"
"$program" isosurface q.nestgrid --value 0.1 -o q.vtp >out || fail "isolines of a quadtree"
[ "$(value segments)" -gt 4 ] || fail "isolines of a quadtree: $(value segments) segments"
"$program" mesh tetra.off --family prism --layers 0.5,0.5 --field 'x^2+y^2+z^2' --refine 3 \
    -o pf.nestgrid >out || fail "prisms with a field"
"$program" isosurface pf.nestgrid --value 0.3 -o pf.vtp >out || fail "isosurface of prisms"
[ "$(value open_edges)" = 0 ] && [ "$(value triangles)" -gt 50 ] || fail "isosurface of prisms"

mesh=(--family bisection -o x.nestgrid)
refused 1 'nothing.off' mesh nothing.off "${mesh[@]}"
: >empty.off && refused 1 'empty' mesh empty.off "${mesh[@]}"
head -c 40 tetra.off >cut.off && refused 1 'cut.off' mesh cut.off "${mesh[@]}"
sed 's/^3 0 3 2/3 0 1 2/' tetra.off >bad.off && refused 1 'bad.off' mesh bad.off "${mesh[@]}"
sed 's/^0 1 0/1 0 0/' tetra.off >bad.off && refused 1 'duplicate' mesh bad.off "${mesh[@]}"
sed 's/^8 0 1 1/8 0.5 0.2 -1/' cube.smesh >bad.smesh && refused 1 'bad.smesh' mesh bad.smesh "${mesh[@]}"
refused 1 "expression 'sin\('" mesh tetra.off "${mesh[@]}" --field 'sin('
refused 1 'no finite number at' mesh tetra.off "${mesh[@]}" --field 'log(x)'
refused 1 'needs a --field' mesh tetra.off "${mesh[@]}" --tolerance 1
refused 1 'no rule for a tetrahedron' mesh cube.smesh --family octree -o x.nestgrid
refused 1 'more than 5000 elements' mesh tetra.off "${mesh[@]}" --refine 1000 --max-elements 5000
refused 1 'more than 5000 elements' mesh tetra.off "${mesh[@]}" --field x^2 --tolerance 1e-300 --max-elements 5000
refused 1 'tolerance is not positive' mesh tetra.off "${mesh[@]}" --field x --tolerance nan
refused 1 'refine is negative' mesh tetra.off "${mesh[@]}" --refine -1
refused 1 'levels is negative' mesh tetra.off "${mesh[@]}" --field x --tolerance 1 --levels -1
refused 1 'max-volume is not a positive' mesh cube.smesh "${mesh[@]}" --max-volume -1
refused 1 'cube.smesh. cannot be read within 0.2 seconds' mesh cube.smesh "${mesh[@]}" --max-volume 1e-6 --read-limit 0.2
refused 2 'read-limit' mesh cube.smesh "${mesh[@]}" --read-limit 0
refused 1 'layer 0 is no positive' mesh tetra.off --family prism --layers nan -o x.nestgrid
refused 1 'cannot be written' mesh tetra.off --family bisection -o missing/x.nestgrid
refused 1 't.nestgrid' mesh t.nestgrid "${mesh[@]}"
mkdir folder.off && refused 1 'folder.off' mesh folder.off "${mesh[@]}"
refused 1 'are for --family prism' mesh tetra.off "${mesh[@]}" --layers 1
refused 1 'no name of a .nestgrid' mesh tetra.off --family bisection -o x.vtp
refused 2 'family' mesh tetra.off --family oak -o x.nestgrid
refused 1 "no field 'rain'" isosurface t.nestgrid --array rain --value 1
"$program" mesh tetra.off --family bisection -o bare.nestgrid >out || fail 'mesh without a field'
refused 1 'no field; give' isosurface bare.nestgrid --value 1
refused 1 'no field; give' isosurface p.nestgrid --value 1
head -c 1000 t.nestgrid >cut.nestgrid
refused 1 'bytes long' isosurface cut.nestgrid --value 1 -o x.vtp
refused 1 'bytes long' info cut.nestgrid

"$program" --help | grep -q 'Examples:' || fail "--help"
"$program" --version | grep -qE '^nestgrid [0-9]' || fail "--version"

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
