#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Times between frames in several files: surfaces, slices, films, and wrong input.
# Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

# within COUNT: no surface has more triangles, or an open edge.
within() {
    [ "$(value triangles | sort -n | tail -1)" -le "$1" ] && [ "$(value open_edges | sort -u)" = 0 ]
}

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
[ "$(value open_edges | sort -u)" = 0 ] || fail "open edges between frames: $(cat out)"
[ "$(value triangles | sort -un | wc -l)" = 2 ] || fail "not two thresholds: $(cat out)"
run isosurface a.raw b.raw c.raw "${raw[@]}" --value 130 --threshold 1% --times 0,1,5 --time 3.5 \
    --cubic --box=2,5,2,5,2,5
[ "$(value open_edges)" = 0 ] || fail "open edges: $(cat out)"

# Films.
run isosurface a.raw b.raw c.raw "${raw[@]}" --value 130 --threshold 2 --frames 5 -o film.vtp
[ "$(ls film* | tr '\n' ' ')" = "film.pvd film_0000.vtp film_0001.vtp film_0002.vtp film_0003.vtp film_0004.vtp " ] ||
    fail "files of the film: $(ls film*)"
[ "$(grep -c '<DataSet timestep="[0-9.]*" part="0" file="film_000[0-4].vtp"/>' film.pvd)" = 5 ] ||
    fail "list of the film: $(cat film.pvd)"
[ "$(value time | tr '\n' ' ')" = "0 0.5 1 1.5 2 " ] || fail "times of the film: $(cat out)"
run isosurface a.raw b.raw "${raw[@]}" --value 130 --threshold 2 --time 0.5 -o half.vtp
cmp -s half.vtp film_0001.vtp || fail "a picture of the film is not the surface at its time"
run slice a.raw b.raw "${raw[@]}" --axis z --at 9.3 --threshold 2 --frames 3 -o 'a & b.vtp'
grep -q 'file="a &amp; b_0002.vtp"' 'a & b.pvd' || fail "the list does not quote names"
run isosurface a.raw b.raw "${raw[@]}" --value 240 --threshold 2 --frames 2 -o outside.vtp

# Hierarchies with one grid.
run mesh "$cube" --family bisection --field 'sqrt((x-0.4)^2+y^2+z^2)' --tolerance 0.01 -o h.nestgrid
run mesh "$cube" --family bisection --field 'sqrt((x-0.9)^2+y^2+z^2)' --tolerance 0.01 -o i.nestgrid
run isosurface h.nestgrid h.nestgrid --value 0.5 --threshold 0.01 --time 0.5
[ "$(value open_edges)" = 0 ] || fail "open edges between hierarchies: $(cat out)"
refused 1 'has another grid than the first input' isosurface h.nestgrid i.nestgrid --value 0.5 --time 0.5
refused 1 'holds no hierarchy of the family' isosurface h.nestgrid v.vti --value 0.5 --time 0.5

# One file with frames is the several files.
moving='sqrt((x-0.3-t)^2+y^2+z^2)'
run mesh "$cube" --family bisection --field "$moving" --field x+t --times 0,0.5,2 --tolerance 0.02 -o film.nestgrid
[ "$(value frames)" = 3 ] && grep -qx 'times  *0 0.5 2' out || fail "info of a film: $(cat out)"
facts >first && run info film.nestgrid && facts | cmp -s - first || fail "info is not what mesh prints"
film=(film.nestgrid --array "$moving")
for t in 0 0.5 2; do
    run mesh "$cube" --family bisection --field "${moving/-t/-$t}" --refine 9 -o "at$t.nestgrid"
done
run pack at0.nestgrid at0.5.nestgrid at2.nestgrid --times 0,0.5,2 -o packed.nestgrid
run isosurface packed.nestgrid --value 0.5 --threshold 1% --time 1.25 -o packed.vtp
run isosurface at0.nestgrid at0.5.nestgrid at2.nestgrid --times 0,0.5,2 --value 0.5 --threshold 1% --time 1.25 -o files.vtp
cmp -s packed.vtp files.vtp || fail "a file with frames is not the files of the frames"
# Percents are those of all frames, numbers are not.
run isosurface packed.nestgrid --value 0.5 --threshold 0.02 --time 0.5 -o packed.vtp
run isosurface at0.5.nestgrid --value 0.5 --threshold 0.02 -o alone.vtp
# The name of the field, which has the time in it, differs.
unnamed() { LC_ALL=C sed 's/Name="sqrt[^"]*"/Name="u"/' "$1"; }
unnamed alone.vtp >alone && unnamed packed.vtp | cmp -s - alone ||
    fail "a frame of a file is not the file of the frame"
run isosurface packed.nestgrid --value 0.5 --times 0,1,2 --time 1 --threshold 0.02 -o packed.vtp
unnamed packed.vtp | cmp -s - alone || fail "--times are not those of the frames"

# Encoded values: bit for bit, and within a bound; every command reads them.
run pack film.nestgrid --encode -o exact.nestgrid
[ "$(value encoded | tr '\n' ' ')" = "exactly exactly " ] || fail "info of encoded values: $(cat out)"
run pack film.nestgrid --encode-within 0.001 -o near.nestgrid
[ "$(value encoded_within)" = "0.001
0.001" ] || fail "info of encoded values: $(cat out)"
bytes() { stat -c %s "$1"; }
[ "$(bytes near.nestgrid)" -lt "$(bytes exact.nestgrid)" ] && [ "$(bytes exact.nestgrid)" -lt "$(bytes film.nestgrid)" ] ||
    fail "encoding saves nothing: $(bytes film.nestgrid) $(bytes exact.nestgrid) $(bytes near.nestgrid) bytes"
run pack exact.nestgrid -o back.nestgrid
cmp -s exact.nestgrid back.nestgrid && fail "pack without --encode leaves values encoded"
cmp -s film.nestgrid back.nestgrid || fail "encoded values do not come back bit for bit"
commands() {
    run isosurface "$@" --value 0.5 --threshold 1% --time 0.3 -o a.vtp
    run slice "$@" --axis z --at 0.4 --threshold 1% --time 0.3 -o b.vtp
    run isolines "$@" --on-surface 0.5 --by x+t --values 0.6 --time 0.3 -o c.vtp
    run boundary "$@" --threshold 1% --time 0.3 -o d.vtp
    run probe "$@" --line 0,0,0,1,1,1 --count 20 --threshold 1% --frames 4 -o e.csv
}
commands "${film[@]}"
for file in a.vtp b.vtp c.vtp d.vtp e.csv; do mv $file plain.$file; done
commands exact.nestgrid --array "$moving"
for file in a.vtp b.vtp c.vtp d.vtp e.csv; do
    cmp -s $file plain.$file || fail "$file of encoded values is not that of the values"
done
commands near.nestgrid --array "$moving"
paste -d, e.csv plain.e.csv | awk -F, 'NR > 1 && ($5 - $11)^2 > 0.0012^2 { exit 1 }' ||
    fail "values are farther off than their bound and the threshold allow"
run mesh "$cube" --family bisection --field x --encode --refine 3 -o x.nestgrid
run isosurface x.nestgrid --value 0.5
[ "$(value area)" = 1 ] || fail "the surface of encoded values: $(cat out)"

# Between frames: the other commands, budgets, lenses, blending and indicators.
run slice "${film[@]}" --axis z --at 0.4 --frames 3 --max-triangles 60 -o s.vtp
[ "$(value triangles | sort -n | tail -1)" -le 60 ] || fail "slices beyond a budget: $(cat out)"
run isosurface "${film[@]}" --value 0.5 --frames 4 --max-triangles 150 -o s.vtp
within 150 || fail "budget: $(cat out)"
run isosurface "${film[@]}" --value 0.5 --frames 4 --max-triangles 150 --indicator numerical --blend 1.25 -o s.vtp
within 150 || fail "budget of jumps: $(cat out)"
run isosurface "${film[@]}" --value 0.8 --time 1 && all=$(value triangles)
run isosurface "${film[@]}" --value 0.8 --time 1 --lens ball:0.8,0,0,0.1 --slope 10 --threshold 0.02 --blend 1.25
[ "$(value triangles)" -lt "$all" ] && [ "$(value open_edges)" = 0 ] || fail "lens between frames: $(cat out)"
for indicator in visual numerical wavelet; do
    run isosurface "${film[@]}" --value 0.5 --time 1 --threshold 0.1 --indicator $indicator --blend 1.25
    [ "$(value open_edges)" = 0 ] || fail "$indicator between frames: $(cat out)"
done
run isolines "${film[@]}" --axis z --at 0.4 --count 3 --frames 3 -o lines.vtp
grep -q 'NumberOfLines="[1-9]' lines_0001.vtp && grep -q 'NumberOfPolys="0"' lines_0001.vtp || fail "no film of lines"
run slice "${film[@]}" --axis z --at 0.4 --with-isosurface 0.5 --time 0.3
[ "$(value isosurface_open_edges)" = 0 ] || fail "slice and isosurface between frames: $(cat out)"
# The surface vanishes before the last frame.
run isolines "${film[@]}" --on-surface 0.5 --by x+t --values 0.6 --frames 3 -o vanishes.vtp
[ "$(value triangles | tail -1)" = 0 ] && [ -s vanishes_0002.vtp ] || fail "a surface that vanishes: $(cat out)"
refused 1 'needs --values' isolines "${film[@]}" --on-surface 0.5 --by x+t --count 3 --frames 2 -o f.vtp
ramp() {
    printf 'P5\n9 7\n255\n'
    for ((i = 0; i < 63; ++i)); do printf "\\$(printf %o $(($1 + 2 * (i % 9))))"; done
}
ramp 20 >first.pgm && ramp 40 >second.pgm
run isolines first.pgm second.pgm --values 35 --time 0.5
[ "$(value length)" = 6 ] || fail "isolines between pictures: $(cat out)"
run height first.pgm second.pgm --scale 1 --frames 3 --threshold 1 -o h.vtp
run surface first.pgm second.pgm --threshold 1 --time 0.25
[ "$(value area)" = 48 ] && [ "$(value least_value)" = 25 ] || fail "surface between pictures: $(cat out)"
printf 'P5\n3 3\n255\nabcdefghi' >small.pgm
refused 1 "'small.pgm' has other dimensions than 'first.pgm'" height first.pgm small.pgm --scale 1 --time 0.5

# Wrong input.
refused 1 'has 3 frames, from time 0 to 2' isosurface "${film[@]}" --value 0.5
refused 1 'has 3 frames, from time 0 to 2' probe "${film[@]}" --line 0,0,0,1,1,1
refused 1 'does not lie between' isosurface "${film[@]}" --value 0.5 --time 3
refused 1 'times has 2 numbers, but there are 3 frames' isosurface "${film[@]}" --value 0.5 --times 0,1 --time 0.5
refused 1 'has 3 frames of its own' isosurface "${film[@]}" film.nestgrid --value 0.5 --time 0.5
refused 1 'need several inputs, or one with several frames' isosurface at0.nestgrid --value 0.5 --time 0
refused 1 'no name of a .nestgrid' pack v.vti -o x.nestgrid
refused 1 'no name of a .nestgrid' pack film.nestgrid -o x.vtp
refused 1 'not finite numbers in ascending' pack at0.nestgrid at2.nestgrid --times 1,0 -o x.nestgrid
refused 1 'has another grid' pack at0.nestgrid h.nestgrid -o x.nestgrid
refused 2 'excludes' pack film.nestgrid --encode --encode-within 1 -o x.nestgrid
refused 2 'no positive finite number' pack film.nestgrid --encode-within 0 -o x.nestgrid
refused 1 'no place among the multiples' pack film.nestgrid --encode-within 1e-300 -o x.nestgrid
refused 1 'not finite numbers in ascending' mesh "$cube" --family bisection --field t --times 1,0 -o x.nestgrid
refused 1 'no expression in x, y and z' mesh "$cube" --family bisection --field t -o x.nestgrid
refused 1 'need a --field' mesh "$cube" --family bisection --times 0,1 -o x.nestgrid
both=(a.raw b.raw "${raw[@]}" --value 130)
refused 1 'several inputs need a --time' isosurface "${both[@]}"
refused 1 'several inputs need a --time' slice a.raw b.raw "${raw[@]}" --axis z --at 9
refused 1 'need several inputs' isosurface v.vti --value 130 --time 0
refused 1 'need several inputs' slice v.vti --axis z --at 9 --frames 3 -o f.vtp
refused 1 'need --time or --frames' isosurface v.vti --value 130 --times 0,1
refused 1 'does not lie between' isosurface "${both[@]}" --time 1.5
refused 1 'does not lie between' isosurface "${both[@]}" --time nan
refused 1 'ascend' isosurface "${both[@]}" --times 1,0 --time 0.5
refused 1 'times has 3 numbers, but there are 2 frames' isosurface "${both[@]}" --times 0,1,2 --time 0.5
refused 1 'frames is below 2' isosurface "${both[@]}" --frames 1 -o f.vtp
refused 2 'excludes' isosurface "${both[@]}" --frames 2 --time 0 -o f.vtp
refused 1 'a film needs an --output' isosurface "${both[@]}" --frames 2
refused 1 'a film needs an --output' isosurface "${both[@]}" --frames 2 -o f.stl
refused 1 'draws no films' isosurface "${both[@]}" --frames 2 -o f.vtp --image f.png
refused 1 'a film has one --threshold' isosurface "${both[@]}" --frames 2 -o f.vtp --threshold 1 --threshold 2
refused 1 'even the coarsest surface' isosurface "${both[@]}" --time 0.5 --max-triangles 100
refused 1 'a film has one --max-triangles' isosurface "${both[@]}" --frames 2 -o f.vtp --max-triangles 900 --max-triangles 800
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
