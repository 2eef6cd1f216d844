#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Times between frames in several files: surfaces, slices, films, and wrong input.
# Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

# A column of the table of surfaces.
column() { awk -v at="$1" '$1 == "time" { rows = 1; next } rows { print $at }' out; }

# The second and the third frame are the first one, moved by two and by four layers.
layer=$((20 * 24))
cp v.raw a.raw
{ tail -c +$((2 * layer + 1)) v.raw && head -c $((2 * layer)) v.raw; } >b.raw
{ tail -c +$((4 * layer + 1)) v.raw && head -c $((4 * layer)) v.raw; } >c.raw
raw=(--dims 20,24,18 --type uint8 --spacing 0.5,1,2)

# At the time of a frame, the surface is that of the frame, to the last bit.
run isosurface b.raw "${raw[@]}" --value 130 --threshold 2 -o alone.vtp
run isosurface a.raw b.raw c.raw "${raw[@]}" --value 130 --threshold 2 --time 1 -o timed.vtp
cmp -s alone.vtp timed.vtp || fail "the surface at the time of a frame is not that of the frame"
run slice b.raw "${raw[@]}" --axis z --at 9.3 --threshold 2 -o alone.vtp
run slice a.raw b.raw c.raw "${raw[@]}" --axis z --at 9.3 --threshold 2 --time 1 --cubic -o timed.vtp
cmp -s alone.vtp timed.vtp || fail "the slice at the time of a frame is not that of the frame"

# Between frames.
run isosurface a.raw b.raw "${raw[@]}" --value 130 --threshold 0 --threshold 5 --time 0.4
[ "$(column 7 | sort -u)" = 0 ] || fail "open edges between frames: $(cat out)"
[ "$(column 4 | sort -un | wc -l)" = 2 ] || fail "not two thresholds: $(cat out)"
run isosurface a.raw b.raw c.raw "${raw[@]}" --value 130 --threshold 1% --times 0,1,5 --time 3.5 \
    --cubic --box=2,5,2,5,2,5
[ "$(column 7)" = 0 ] || fail "open edges: $(cat out)"

# Films.
run isosurface a.raw b.raw c.raw "${raw[@]}" --value 130 --threshold 2 --frames 5 -o film.vtp
[ "$(ls film* | tr '\n' ' ')" = "film.pvd film_0000.vtp film_0001.vtp film_0002.vtp film_0003.vtp film_0004.vtp " ] ||
    fail "files of the film: $(ls film*)"
[ "$(grep -c '<DataSet timestep="[0-9.]*" part="0" file="film_000[0-4].vtp"/>' film.pvd)" = 5 ] ||
    fail "list of the film: $(cat film.pvd)"
[ "$(column 1 | tr '\n' ' ')" = "0 0.5 1 1.5 2 " ] || fail "times of the film: $(cat out)"
run isosurface a.raw b.raw "${raw[@]}" --value 130 --threshold 2 --time 0.5 -o half.vtp
cmp -s half.vtp film_0001.vtp || fail "a picture of the film is not the surface at its time"
run slice a.raw b.raw "${raw[@]}" --axis z --at 9.3 --threshold 2 --frames 3 -o 'a & b.vtp'
grep -q 'file="a &amp; b_0002.vtp"' 'a & b.pvd' || fail "the list does not quote names"
run isosurface a.raw b.raw "${raw[@]}" --value 240 --threshold 2 --frames 2 -o outside.vtp

# Hierarchies with one grid.
run mesh "$cube" --family bisection --field 'sqrt((x-0.4)^2+y^2+z^2)' --tolerance 0.01 -o h.nestgrid
run mesh "$cube" --family bisection --field 'sqrt((x-0.9)^2+y^2+z^2)' --tolerance 0.01 -o i.nestgrid
run isosurface h.nestgrid h.nestgrid --value 0.5 --threshold 0.01 --time 0.5
[ "$(column 7)" = 0 ] || fail "open edges between hierarchies: $(cat out)"
refused 1 'has another grid than the first input' isosurface h.nestgrid i.nestgrid --value 0.5 --time 0.5
refused 1 'holds no hierarchy of the family' isosurface h.nestgrid v.vti --value 0.5 --time 0.5

# Wrong input.
both=(a.raw b.raw "${raw[@]}" --value 130)
refused 1 'several inputs need a --time' isosurface "${both[@]}"
refused 1 'several inputs need a --time' slice a.raw b.raw "${raw[@]}" --axis z --at 9
refused 1 'need several inputs' isosurface v.vti --value 130 --time 0
refused 1 'need several inputs' slice v.vti --axis z --at 9 --frames 3 -o f.vtp
refused 1 'need --time or --frames' isosurface v.vti --value 130 --times 0,1
refused 1 'does not lie between' isosurface "${both[@]}" --time 1.5
refused 1 'does not lie between' isosurface "${both[@]}" --time nan
refused 1 'ascend' isosurface "${both[@]}" --times 1,0 --time 0.5
refused 1 'times has 3 numbers, but there are 2 inputs' isosurface "${both[@]}" --times 0,1,2 --time 0.5
refused 1 'frames is below 2' isosurface "${both[@]}" --frames 1 -o f.vtp
refused 2 'excludes' isosurface "${both[@]}" --frames 2 --time 0 -o f.vtp
refused 1 'a film needs an --output' isosurface "${both[@]}" --frames 2
refused 1 'a film needs an --output' isosurface "${both[@]}" --frames 2 -o f.stl
refused 1 'draws no films' isosurface "${both[@]}" --frames 2 -o f.vtp --image f.png
refused 1 'a film has one --threshold' isosurface "${both[@]}" --frames 2 -o f.vtp --threshold 1 --threshold 2
refused 1 'max-triangles is for one input' isosurface "${both[@]}" --time 0.5 --max-triangles 100
refused 1 'against-vtk is for one volume' isosurface "${both[@]}" --time 0.5 --against-vtk
refused 1 "'float.vti' has samples of another type than 'v.vti'" isosurface v.vti float.vti --value 130 --time 0.5
head -c $((17 * layer)) v.raw >flatter.raw
header() { printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 20 24 %s\nspacings: 0.5 1 %s\nencoding: raw\ndata file: %s\n\n' "$@"; }
header 17 2 flatter.raw >flatter.nhdr
header 18 3 v.raw >longer.nhdr
refused 1 "'flatter.nhdr' has other dimensions than" isosurface v.nhdr flatter.nhdr --value 130 --time 0.5
refused 1 "'longer.nhdr' has another place in space than" slice v.nhdr longer.nhdr --axis z --at 9 --time 0.5
refused 1 'does not exist' isosurface v.vti missing.vti --value 130 --time 0.5
mkdir blocked_0001.vtp
refused 1 'blocked_0001.vtp' isosurface "${both[@]}" --threshold 2 --frames 2 -o blocked.vtp

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
