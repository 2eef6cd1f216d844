#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Lenses of the program: results, and wrong input. Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

# run_closed ARGUMENTS...: the same, and draws a surface without open edges. Sets `triangles`.
run_closed() {
    run "$@"
    [ "$(value open_edges)" = 0 ] || fail "$*: open edges"
    triangles=$(value triangles)
}

# The volume is 9.5 x 23 x 34 long. A lens around all of it, in which no node is dropped, also none
# without an offset; and one that is far away.
run_closed isosurface v.vti --value 130 --lens ball:5,11,17,100 && finest=$triangles
run_closed isosurface v.vti --value 130 && [ "$triangles" -le "$finest" ] && [ $((2 * triangles)) -gt "$finest" ] ||
    fail "a lens around everything: $finest triangles, without it $triangles"
run_closed isosurface v.vti --value 130 --lens ball:1000,0,0,1 --slope 10 && coarsest=$triangles
[ "$coarsest" -lt $((finest / 2)) ] || fail "a lens far away: $coarsest of $finest triangles"

# Between them, more with every demand.
last=$coarsest
for more in "ball:5,11,8,3 --finest 3" "ball:5,11,8,3" "box:2,8,8,15,4,12 --lens ball:5,11,25,4"; do
    run_closed isosurface v.vti --value 130 --slope 0.5 --lens $more
    [ "$triangles" -ge "$last" ] && [ "$triangles" -le "$finest" ] ||
        fail "$more: $triangles triangles, before $last"
    last=$triangles
done
run_closed isosurface v.vti --value 130 --lens ball:1000,0,0,1 --slope 10 --coarsest 3
[ "$triangles" -gt "$coarsest" ] || fail "coarsest: $triangles triangles"
run_closed isosurface v.vti --value 130 --lens ball:5,11,8,3 --threshold 2
awk -v bound="$(value error_bound)" 'BEGIN { exit !(bound < 20) }' ||
    fail "the threshold is not kept: $(value error_bound)"
# A lens that blends: nodes that jump without it move, so the surface is another one, and closed.
blended() { run_closed isosurface v.vti --value 130 --lens ball:5,11,8,3 --slope 0.5 --blend "$@"; }
blended 1 -o jumps.vtp && blended 1.5 -o moves.vtp && cmp -s jumps.vtp moves.vtp && fail "the lens does not blend"
[ "$triangles" -le "$finest" ] || fail "blended: $triangles of $finest triangles"

# The other domains, and the other commands.
printf '0 0\n9 0\n9 10\n0 10\n' >half.txt
frustum=frustum:5,-20,17,0,1,0,0,0,1,20,1,5,60
printf '0 0 9 0 0 -1\n0 0 20 0 0 1\n0 12 0 0 2 0\n' >slab.txt
for lens in halfspace:0,11,0,0,1,0 cone:5,-20,17,0,1,0,8 polygon:half.txt $frustum polyhedron:slab.txt; do
    run_closed isosurface v.vti --value 130 --lens $lens
    [ "$triangles" -gt "$coarsest" ] && [ "$triangles" -lt "$finest" ] ||
        fail "$lens: $triangles triangles"
done
run_closed slice v.vti --axis z --at 17 && all=$triangles
run_closed slice v.vti --axis z --at 17 --lens ball:5,11,17,3 -o s.vtp
[ "$triangles" -lt "$all" ] && [ -s s.vtp ] || fail "slice: $triangles of $all triangles"
run_closed slice v.vti --axis z --at 17 --lens ball:5,11,17,3 --max-triangles 3250
[ "$triangles" -le 3250 ] || fail "slice: $triangles triangles within a budget of 3250"
awk -v threshold="$(value threshold)" 'BEGIN { exit !(threshold > 0) }' || fail "no threshold: $(cat out)"
run_closed boundary v.vti && all=$triangles
run_closed boundary v.vti --lens ball:0,0,0,3 --threshold 20
[ "$triangles" -lt "$all" ] || fail "boundary: $triangles of $all triangles"
"$program" isolines v.vti --axis z --at 17 --count 4 --lens ball:5,11,17,3 >out 2>err ||
    fail "isolines: $(cat err)"
{
    printf 'P5\n33 33\n255\n'
    for ((i = 0; i < 33 * 33; ++i)); do printf "\\$(printf %o $((i % 33 * (i / 33) % 200 + 20)))"; done
} >wave.pgm
run isolines v.vti --axis z --at 17 --count 4 && all=$(value triangles)
run isolines v.vti --axis z --at 17 --count 4 --lens ball:5,11,17,3
[ "$(value triangles)" -lt "$all" ] || fail "isolines: $(value triangles) of $all triangles"
run_closed height wave.pgm --scale 1 && all=$triangles
run_closed height wave.pgm --scale 1 --lens ball:10,10,0,4
[ "$triangles" -lt "$all" ] || fail "height: $triangles of $all triangles"

# A closed surface, here that of a box, in every format; and the box itself.
box='2 8 4\n8 8 4\n8 15 4\n2 15 4\n2 8 12\n8 8 12\n8 15 12\n2 15 12\n'
faces='4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n'
printf "OFF\n8 6 0\n$box${faces}4 0 4 7 3\n" >box.off
printf "OFF\n8 5 0\n$box$faces" >open.off
printf "OFF\n12 10 0\n${box}5 11 1\n5 11 9\n20 9 5\n5 20 5\n${faces}4 0 4 7 3\n3 8 9 10\n3 8 10 11\n3 8 11 9\n3 9 11 10\n" >crossing.off
printf 'OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n' >point.off
run mesh box.off --family red-green --field x -o box.nestgrid
for format in stl obj ply vtp; do run surface box.nestgrid -o box.$format; done
run_closed isosurface v.vti --value 130 --lens box:2,8,8,15,4,12 -o box-lens.vtp && expected=$triangles
for format in off stl obj ply vtp; do
    run_closed isosurface v.vti --value 130 --lens surface:box.$format -o lens.vtp
    [ "$triangles" = "$expected" ] || fail "surface:box.$format: $triangles triangles, box: $expected"
    cmp -s lens.vtp box-lens.vtp || fail "surface:box.$format draws another surface than box:"
done
# Faces that share no points, and are not turned the same way.
awk 'BEGIN { split("0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1", u); split("0 3 2 1 4 5 6 7 0 5 4 1 1 2 6 5 2 3 7 6 0 4 7 3", f)
    f[10] = 1; f[11] = 5; f[12] = 4; print "OFF\n24 6 0"
    for (i = 1; i <= 24; ++i) print 2 + 6 * u[3 * f[i] + 1], 8 + 7 * u[3 * f[i] + 2], 4 + 8 * u[3 * f[i] + 3]
    for (i = 0; i < 6; ++i) print 4, 4 * i, 4 * i + (i % 2 ? 1 : 3), 4 * i + 2, 4 * i + (i % 2 ? 3 : 1) }' >apart.off
run_closed isosurface v.vti --value 130 --lens surface:apart.off
[ "$triangles" = "$expected" ] || fail "surface:apart.off: $triangles triangles, box: $expected"
# A surface of the program itself: everything in it is drawn finely.
run_closed isosurface v.vti --value 30 --cap -o core.vtp
run_closed isosurface v.vti --value 130 --lens surface:core.vtp
[ "$triangles" = "$finest" ] || fail "surface:core.vtp: $triangles of $finest triangles"
run_closed boundary v.vti --lens surface:box.stl --threshold 20 --blend 1.5
run probe v.vti --line 5,11,0,5,11,30 --count 3 --lens surface:box.stl
refused 1 "'open.off': the surface of a solid is open" isosurface v.vti --value 130 --lens surface:open.off -o x.vtp
refused 1 "crossing.off': the surface of a solid goes through itself" isosurface v.vti --value 130 --lens surface:crossing.off -o x.vtp
refused 1 "point.off': the surface of a solid is empty" isosurface v.vti --value 130 --lens surface:point.off -o x.vtp
refused 1 "'none.stl' does not exist" isosurface v.vti --value 130 --lens surface:none.stl -o x.vtp
refused 1 "'v.vti' is of no format for meshes" isosurface v.vti --value 130 --lens surface:v.vti -o x.vtp
cp v.vti other.vtp
refused 1 "'other.vtp' is no VTK poly data" isosurface v.vti --value 130 --lens surface:other.vtp -o x.vtp
head -c 300 box.vtp >cut.vtp
refused 1 'cut.vtp' isosurface v.vti --value 130 --lens surface:cut.vtp -o x.vtp

surface() { echo isosurface v.vti --value 130 -o x.vtp; }
for lens in ball ball: ball:1,2,3 ball:1,2,3,4,5 ball:1,2,3,x ball:1,2,3,nan ring:1,2 :1; do
    refused 1 "the lens '$lens' is none of ball" $(surface) --lens="$lens"
done
refused 1 'radius of .* is negative' $(surface) --lens=ball:1,2,3,-4
refused 1 'is empty' $(surface) --lens=box:2,1,0,1,0,1
refused 1 'normal of a half-space' $(surface) --lens=halfspace:1,2,3,0,0,0
refused 1 'angle between' $(surface) --lens=cone:1,2,3,0,0,1,100
refused 1 "'nothing.txt' does not exist" $(surface) --lens=polygon:nothing.txt
refused 1 "'.' is a folder" $(surface) --lens=polygon:.
: >empty.txt && refused 1 "'empty.txt' is empty" $(surface) --lens=polygon:empty.txt
echo 1 2 3 >odd.txt && refused 1 'no list of corners' $(surface) --lens=polygon:odd.txt
echo 1 2 3 4 x >words.txt && refused 1 'no list of corners' $(surface) --lens=polygon:words.txt
refused 1 'no list of half-spaces' $(surface) --lens=polyhedron:odd.txt
echo 0 0 0 0 0 0 >flat.txt && refused 1 'normal' $(surface) --lens=polyhedron:flat.txt
refused 1 'nearest' $(surface) --lens="${frustum%5,60}60,5"
refused 1 'none of ball' $(surface) --lens=frustum:1,2,3
echo 1 2 3 4 >two.txt && refused 1 'fewer than three' $(surface) --lens=polygon:two.txt
refused 1 'finest is negative' $(surface) --lens=ball:1,2,3,4 --finest=-1
refused 1 'finest is negative' $(surface) --lens=ball:1,2,3,4 --finest=nan
refused 1 'coarsest is below' $(surface) --lens=ball:1,2,3,4 --finest=2 --coarsest=1
refused 1 'slope is negative' $(surface) --lens=ball:1,2,3,4 --slope=-1
refused 2 'lens' $(surface) --finest=1
refused 2 'excludes' $(surface) --lens=ball:1,2,3,4 --box=0,1,0,1,0,1
refused 1 'even the coarsest surface' slice v.vti --axis z --at 17 --lens ball:1,2,3,4 --max-triangles 100

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
