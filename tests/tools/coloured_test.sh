#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Slices, isolines, heights, boundaries and probes of the program: results, files, and wrong input.
# Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

expect() {
    awk -v got="$(value "$1")" -v wanted="$2" -v name="$1" 'BEGIN {
        if (got == "" || (got - wanted)^2 > 1e-10 * (1 + wanted^2)) {
            print "FAILED: " name " is " got ", not " wanted; exit 1 } }' || failures=$((failures + 1))
}

# The volume is 9.5 x 23 x 34 long. Slices through samples, between them, and on the boundary.
for z in 0 9.3 18 34; do
    run slice v.vti --axis z --at $z --threshold 2%
    expect area 218.5
    expect open_edges 0
done
run slice v.vti --plane 4.75,0,0,1,0,0
expect area 782
run boundary v.vti --threshold 5 -o b.vtp --outlines
expect area 2647
expect boundary_edges 0
for projection in "" "--indicator visual --blend 1.5" "--indicator wavelet"; do
    run boundary v.vti --max-triangles 3000 $projection
    [ "$(value triangles)" -le 3000 ] && [ "$(value triangles)" -gt 2650 ] || fail "boundary$projection: $(cat out)"
    expect area 2647
    expect open_edges 0
done
refused 1 'even the coarsest surface has more than 2000' boundary v.vti --max-triangles 2000
grep -q 'Name="value"' b.vtp || fail "the field is no array of its own name"
for array in level element; do grep -q "Name=\"$array\"" b.vtp && fail "$array is in b.vtp, where nobody asks for it"; done
# A band is its two isosurfaces in one walk; one number of triangles is for both.
areas=0
for level in 100 130; do
    run isosurface v.vti --value $level --threshold 2
    areas=$(value area | awk -v sum="$areas" '{ print sum + $1 }')
done
run band v.vti --low 100 --high 130 --threshold 2 -o band.vtp
awk -v a="$(value area)" -v b="$areas" 'BEGIN { exit !((a - b)^2 <= 1e-9 * b^2) }' || fail "band: $(value area), not $areas"
expect open_edges 0
expect upper_isovalue 130
run band v.vti --low 100 --high 130 --max-triangles 3000
[ "$(value triangles)" -le 3000 ] && [ "$(value triangles)" -gt 2500 ] || fail "band: $(cat out)"
for band in '900 901 outside' '1 9.5 outside' '1 900 holds'; do
    set -- $band
    run band v.vti --low $1 --high $2
    grep -q "^the surface is empty: the band .*$3 the range 10 to 250 of the data" out || fail "band $band: $(cat out)"
done
refused 1 'low is not below --high' band v.vti --low 130 --high 100 -o none.vtp
[ ! -e none.vtp ] || fail "none.vtp of a refused band"
run slice v.vti --sphere 4.75,11.5,17,4 --cap
run slice v.vti --cylinder 4.75,11.5,17,0,0,1,3 -o c.ply
[ -s c.ply ] || fail "no c.ply"
run slice v.vti --plane 4.75,0,0,1,0,0 --threshold 0
visited=$(value visited)
run slice v.vti --function 'x-4.75' --threshold 0
expect area 782
[ "$(value visited)" -le $((8 * visited)) ] || fail "$(value visited) elements visited by an expression, $visited by the plane"
# avg() has no bounds, so that all elements are looked at: the slice is the same.
bowl='min(((x-4)^2+(y-11)^2+(z-17)^2-30)/30,0.1)'
for function in "$bowl^65+0.001" "$bowl^66-0.001" "max($bowl,sqrt($bowl))+0.25" "max($bowl,ln($bowl+0.5))+0.8" \
    "ln((x-9.5)^2+(y-23)^2+(z-34)^2+1e-30)-4" "1/(9.5000001-x)-1" "atan((x-9.5)*1e14)+x-4.3" "max(x-5,0)" \
    "1e-320*(x-4.3)" "sin(x)*cos(y)-0.3*z+4" "abs(x-4)+abs(y-11)-5.3"; do
    run slice v.vti --function "$function" --threshold 0
    pruned="$(value triangles) $(value area)"
    run slice v.vti --function "$function+0*avg(x,x)" --threshold 0
    [ "$pruned" = "$(value triangles) $(value area)" ] || fail "$function: $pruned, not $(value triangles) $(value area)"
done
run slice v.vti --axis x --at 5 --threshold 0 --threshold 20 -o s.vtp
[ -s s-1.vtp ] && [ -s s-2.vtp ] || fail "no files for two thresholds"
[ "$(grep -c 'timestep="[12]" part="0" file="s-[12].vtp"' s.pvd)" = 2 ] || fail "s.pvd: $(cat s.pvd)"
run isosurface v.vti --value 100.5 --threshold 0 --threshold 2 -o i.vtp
grep -q 'file="i-2.vtp"' i.pvd || fail "i.pvd: $(cat i.pvd)"
run slice v.vti --axis z --at 17 --max-triangles 600
[ "$(value triangles)" -le 600 ] || fail "more triangles than asked for"

for indicator in visual numerical wavelet; do
    run slice v.vti --axis z --at 17 --threshold 0.5 --indicator $indicator --blend 1.25
    expect area 218.5
    expect open_edges 0
    run slice v.vti --axis z --at 17 --max-triangles 600 --indicator $indicator --blend 1.25
    [ "$(value triangles)" -le 600 ] && [ "$(value triangles)" -gt 400 ] || fail "$indicator: $(cat out)"
    expect area 218.5
    expect open_edges 0
done
refused 1 'no percentages' slice v.vti --axis z --at 17 --threshold 2% --indicator visual

run isolines v.vti --axis z --at 17 --count 4 -o l.vtp
[ "$(value isoline | wc -l)" = 4 ] || fail "no isolines"
grep -q 'Name="value"' l.vtp || fail "isolines without values"

# In the unit cube, the plane x = 0.3 and lines on it by another field and by expressions.
run mesh "$cube" --family bisection --field x --field 2*z --refine 6 -o cube.nestgrid
[ "$(value field | wc -l)" = 2 ] || fail "not two fields: $(cat out)"
for by in 2*z 2*y z+y; do
    for threshold in 0 1%; do
        run isolines cube.nestgrid --array x --on-surface 0.3 --by $by --values 0.5,1 \
            --threshold $threshold -o s.vtp
        [ "$(value open_lines | tr '\n' ' ')" = "1 1 " ] || fail "isolines by $by: $(cat out)"
    done
    expect area 1
    expect least_value 0
    expect greatest_value 2
    expected='1 1 '
    [ $by = z+y ] && expected='0.707107 1.41421 '
    [ "$(value length | tr '\n' ' ')" = "$expected" ] || fail "isolines by $by: $(cat out)"
done
grep -qF 'Name="z+y"' s.vtp || fail "the expression is no array of its own name"

# A slice and an isosurface in one walk are the two that are drawn alone.
for threshold in 0 3%; do
    run isosurface v.vti --value 100.5 --at-nodes --threshold $threshold
    triangles=$(value triangles)
    area=$(value area)
    run slice v.vti --axis z --at 17 --threshold $threshold
    slice_triangles=$(value triangles)
    run slice v.vti --axis z --at 17 --with-isosurface 100.5 --threshold $threshold -o both.vtp
    expect triangles "$slice_triangles"
    expect isosurface_triangles "$triangles"
    expect isosurface_area "$area"
    expect isosurface_open_edges 0
    grep -q "NumberOfPolys=\"$((triangles + slice_triangles))\"" both.vtp ||
        fail "both.vtp has not all triangles"
done
run slice v.vti --axis z --at 17 --with-isosurface 100.5
both=$(($(value triangles) + $(value isosurface_triangles)))
for projection in "" "--indicator visual --blend 1.5"; do
    run slice v.vti --axis z --at 17 --with-isosurface 100.5 --max-triangles $((both / 2)) $projection
    found=$(($(value triangles) + $(value isosurface_triangles)))
    [ $found -le $((both / 2)) ] && [ $found -gt $((both / 4)) ] || fail "$found triangles of both$projection, not $((both / 2))"
    expect isosurface_open_edges 0
done
run slice v.vti --axis z --at 17 --with-isosurface 1e9
expect isosurface_triangles 0

# A picture of 9 x 7 pixels: 2 x, and one bright pixel.
{
    printf 'P5\n9 7\n255\n'
    for y in 0 1 2 3 4 5 6; do
        for x in 0 1 2 3 4 5 6 7 8; do printf "\\$(printf %o $((20 + 2 * x)))"; done
    done
} >ramp.pgm
{
    printf 'P5\n65 65\n255\n'
    LC_ALL=C awk 'BEGIN { for (i = 0; i < 65 * 65; ++i) printf "%c", 64 + 50 * sin(i % 65 / 9) * cos(int(i / 65) / 7) }'
} >hills.pgm
run height ramp.pgm --scale 1
expect area 107.331263
expect open_edges 0
run height ramp.pgm --scale 1 --threshold 0.3 --indicator visual
expect open_edges 0
run isolines ramp.pgm --values 25 --threshold 0.3 --indicator numerical
run surface ramp.pgm --threshold 1 --outlines -o ramp.vtp
expect area 48
# Budgets in the plane: the same number of triangles for heights and surfaces.
for projection in "" "--indicator visual" "--blend 2" "--indicator numerical --blend 1.5"; do
    run surface hills.pgm --max-triangles 900 $projection
    kept=$(value triangles)
    within_budget 900 surface hills.pgm $projection
    run height hills.pgm --scale 1 --max-triangles 900 $projection -o h.vtp
    [ "$(value triangles) $(value open_edges)" = "$kept 0" ] || fail "height$projection: $(cat out)"
    run isolines hills.pgm --count 3 --max-triangles 900 $projection
    [ "$(value triangles)" = "$kept" ] || fail "isolines$projection: $(cat out)"
    run isosurface hills.pgm --value 60 --max-triangles 60 $projection
    within_budget 60 isosurface hills.pgm --value 60 $projection
done
run surface hills.pgm --max-triangles 900 --max-triangles 90000
[ "$(value triangles | head -1)" -le 900 ] && [ "$(value threshold | tail -1)" = 0 ] || fail "two budgets: $(cat out)"
run isolines ramp.pgm --values 25,31 -o r.vtp
[ "$(value length | tr '\n' ' ')" = "6 6 " ] || fail "isolines of a ramp: $(cat out)"

run probe v.vti --line 0,0,0,9.5,23,34 --count 3
[ "$(wc -l <out)" = 4 ] || fail "probe: $(cat out)"
head -1 out | grep -qx 'x,y,z,value,level' || fail "probe: no names of columns"
printf 'x,y,z\n1,2,3\n100,0,0\n' >points.csv
run probe v.vti --points points.csv -o values.csv
grep -qxE 'wrote values.csv \(2 points, [0-9]+ bytes\)' out || fail "probe -o: $(cat out)"
[ "$(sed -n 3p values.csv)" = '100,0,0,,' ] || fail "a point outside: $(cat values.csv)"

# Colours in prisms follow the data: more triangles, in the same place.
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n' >plane.off
run mesh plane.off --family prism --layers 1 --direction 0,0,1 --field 'x*z+y*z' --refine 1 -o prisms.nestgrid
oblique=(prisms.nestgrid --plane 0.5,0.5,0.3,0.3,0.5,0.81)
run slice "${oblique[@]}"
area=$(value area)
triangles=$(value triangles)
for tolerance in 0.05 0.005; do
    run slice "${oblique[@]}" --colour-tolerance $tolerance
    [ "$(value triangles)" -gt "$triangles" ] || fail "--colour-tolerance $tolerance splits nothing"
    triangles=$(value triangles)
    expect area "$area"
    expect open_edges 0
done
run boundary prisms.nestgrid --colour-tolerance 0.05 --threshold 0.1
expect area 6
for number in 0 -1 nan inf x; do
    refused 2 'colour-tolerance: .* no positive finite number' slice "${oblique[@]}" --colour-tolerance $number
done
refused 1 'excludes --colour-tolerance' slice "${oblique[@]}" --colour-tolerance 1 --max-triangles 9

# Collapses keep the error and the place, and leave fewer triangles.
for what in "slice v.vti --axis z --at 9.3" "boundary v.vti" "surface ramp.pgm" "height ramp.pgm --scale 2"; do
    run $what --error 5%
    drawn=$(value triangles)
    area=$(value area)
    run $what --error 5% --collapse -o collapsed.vtp
    [ "$(value triangles)" -le "$drawn" ] || fail "$what --collapse: $(value triangles) triangles, not $drawn"
    [ "$(value exceeding)" = 0 ] || fail "$what --collapse: $(value exceeding) triangles exceed the error"
    awk -v bound="$(value error_bound)" -v error="$(value threshold)" 'BEGIN { exit !(bound <= error) }' ||
        fail "$what --collapse: $(value error_bound)"
    case $what in height*) ;; *) expect area "$area" ;; esac
done
for what in 'slice v.vti --axis z --at 9.3' 'boundary v.vti' 'slice v.vti --sphere 5,12,17,4 --distance 0.8'; do
    run $what --max-triangles 300 --collapse -o few.vtp
    [ "$(value triangles)" -le 300 ] || fail "$what --max-triangles 300: $(value triangles) triangles"
done
refused 1 'needs an --error or --max-triangles' slice v.vti --axis z --at 9.3 --collapse -o x.vtp
# A curved slice may move: fewer triangles, within a distance.
run slice v.vti --sphere 5,12,17,4 --error 5% --collapse
drawn=$(value triangles)
run slice v.vti --sphere 5,12,17,4 --error 5% --collapse --distance 0.8 -o ball.vtp
[ "$((4 * $(value triangles)))" -le "$drawn" ] || fail "--distance: $(value triangles) triangles, not $drawn"
expect exceeding 0
expect open_edges 0
grep -q 'no point of the slice is farther than 0.8' out || fail "--distance says nothing: $(cat out)"
refused 1 'a plane keeps its place' slice v.vti --axis z --at 9.3 --error 5% --collapse --distance 1 -o x.vtp
refused 2 'distance requires --collapse' slice v.vti --sphere 5,12,17,4 --error 5% --distance 1 -o x.vtp
refused 2 'excludes' slice v.vti --sphere 5,12,17,4 --error 5% --collapse --distance 1 --cap -o x.vtp
for number in 0 -1 nan inf x; do
    refused 2 'distance: .* no positive finite number' slice v.vti --sphere 5,12,17,4 --error 5% --collapse --distance $number
done
refused 1 'collapse needs an --error' slice v.vti --axis z --at 9.3 --collapse -o x.vtp
refused 2 '--collapse' boundary v.vti --error 5% --collapse --outlines -o x.vtp

refused 1 'needs one of --plane' slice v.vti -o x.vtp
refused 1 'needs one of --plane' slice v.vti --axis x --at 1 --sphere 1,1,1,1
refused 1 'normal of the plane is 0' slice v.vti --plane 1,2,3,0,0,0 -o x.vtp
refused 1 "expression 'x\+' is no expression" slice v.vti --function x+ -o x.vtp
refused 1 'no finite number at' slice v.vti --function 'log(x-5)' -o x.vtp
refused 1 'does not meet the domain' slice v.vti --axis z --at 100 -o x.vtp --image x.png
refused 1 'radius of the sphere' slice v.vti --sphere 1,1,1,-2 -o x.vtp
refused 2 '--axis' slice v.vti --axis q --at 1 -o x.vtp
refused 2 '--plane' slice v.vti --plane 1,2,3 -o x.vtp
refused 1 'no known format' slice v.vti --axis x --at 1 -o x.doc
refused 1 'either --values or --count' isolines v.vti --axis z --at 1
refused 1 'not finite' isolines v.vti --axis z --at 1 --values nan
refused 1 'give a slice' isolines v.vti --values 3
refused 2 '--by' isolines v.vti --on-surface 100 --count 3
refused 2 '--on-surface' isolines v.vti --axis z --at 1 --by x --count 3
refused 1 'either on a slice or --on-surface' isolines v.vti --axis z --at 1 --on-surface 1 --by x --count 3
refused 1 'on-surface is not a finite' isolines v.vti --on-surface nan --by x --count 3 -o x.vtp
refused 1 'isosurface is empty' isolines v.vti --on-surface 1e9 --by x --count 3 -o x.vtp
refused 1 "expression 'x\+' is no expression" isolines v.vti --on-surface 100 --by x+ --count 3 -o x.vtp
refused 1 'no finite number at' isolines v.vti --on-surface 100 --by '1/(x-x)' --count 3 -o x.vtp
refused 1 'dimension 2, not 3' isolines ramp.pgm --on-surface 25 --by x --count 3 -o x.vtp
refused 1 'with-isosurface is not a finite' slice v.vti --axis z --at 1 --with-isosurface inf -o x.vtp
refused 2 '--with-isosurface' slice v.vti --axis z --at 1 --with-isosurface 9 --cap
refused 1 "names 'x' twice" mesh "$cube" --family bisection --field x --field x -o x.nestgrid
refused 1 'one in space' height v.vti --scale 1
refused 1 'scale is 0' height ramp.pgm --scale nan
refused 1 'even the coarsest surface has more than 1 triangles: 9' surface ramp.pgm --max-triangles 1
head -c 40 ramp.pgm >cut.pgm && refused 1 'cut.pgm is cut off' height cut.pgm --scale 1 -o x.vtp
: >empty.png && refused 1 'empty.png' height empty.png --scale 1
echo text >text.png && refused 1 'text.png' height text.png --scale 1
refused 1 'missing.pgm. does not exist' height missing.pgm --scale 1
refused 1 'either --line or --points' probe v.vti
refused 1 'none.csv. does not exist' probe v.vti --points none.csv
printf '1,2,3\n1,2\n' >bad.csv && refused 1 'bad.csv, line 2' probe v.vti --points bad.csv
printf '1,2,nan\n1,2,nan\n' >bad.csv && refused 1 'bad.csv, line 2' probe v.vti --points bad.csv
refused 1 'count is below 2' probe v.vti --line 0,0,0,1,1,1 --count 1

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
