#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Plotfiles of AMReX: what they are taken for, surfaces, slices, times of several, and refusals.
# Arguments: the program, the maker of plotfiles.
. "$(dirname "$0")/functions.sh"

closed() { [ "$(value open_edges | sort -u)" = 0 ] || fail "$1: open edges: $(cat out)"; }

run info plt00000
[ "$(value dimension)" = 3 ] && [ "$(value type)" = float64 ] || fail "info: $(cat out)"
# 4096 - 12^3 cells of level 0, (24^3 - 16^3) of level 1, 64^3 of level 2.
[ "$(value leaf_elements)" = $((4096 - 1728 + 13824 - 4096 + 262144)) ] || fail "info: leaves: $(cat out)"
grep -qE '^ +0 +2 +4096 +-$' out && grep -qE '^ +1 +2 +13824 +2$' out && grep -qE '^ +2 +2 +262144 +4$' out ||
    fail "info: levels: $(cat out)"
grep -qE '^distance +-0\.2[0-9]+ +0\.[0-9]+$' out && grep -qE '^place +0\.03125 +0\.96875$' out ||
    fail "info: fields: $(cat out)"
cp out whole
run info plt00000/Header
cmp -s out whole || fail "a plotfile is not the one of its Header"
run info plane
[ "$(value dimension)" = 2 ] && [ "$(value type)" = float32 ] || fail "info of a plane: $(cat out)"

run isosurface plt00000 --array distance --value 0 --threshold 0 --threshold 1e-2 -o s.vtp
closed "isosurface"
awk -v area="$(value area | head -1)" 'BEGIN { exit !(area > 1.12 && area < 1.135) }' ||
    fail "a sphere of 0.36 pi has the area $(value area)"
run isosurface plt00000 --array distance --value 0 --max-triangles 500
closed "budget"
[ "$(value triangles)" -le 500 ] || fail "too many triangles: $(cat out)"
run isosurface plt00000 --array distance --value 0 --error 1%
closed "error"
run slice plt00000 --array distance --axis z --at 0.5 --threshold 0
grep -q triangles out || fail "slice: $(cat out)"
run boundary plt00000 --array distance --threshold 1e-2
printf '0.5,0.5,0.5\n0.1,0.2,0.3\n' >points
run probe plt00000 --array place --points points
run isolines plane --array distance --values 0 --threshold 0 -o l.vtp
run isolines plt00000 --array distance --on-surface 0 --by place --values 0.3,0.6 --threshold 0 -o l.vtp

# At the time of a plotfile the surface is its own; between them it moves.
run isosurface plt00010 --array distance --value 0 --threshold 1e-3 -o alone.vtp
run isosurface plt00000 plt00010 plt00020 --array distance --value 0 --threshold 1e-3 --time 1 -o timed.vtp
cmp -s alone.vtp timed.vtp || fail "the surface at the time of a plotfile is not that of the plotfile"
run isosurface plt00000 plt00010 plt00020 --array distance --value 0 --threshold 1e-3 --frames 5 -o film.vtp
[ "$(value time | tr '\n' ' ')" = "0 0.5 1 1.5 2 " ] || fail "times of the film: $(cat out)"
closed "film"

# Where leaves hold no number there is a hole; an infinite one is refused with its place.
run isosurface holed --array distance --value 0 --threshold 0
[ "$(value open_edges)" -gt 50 ] || fail "no hole: $(cat out)"
awk -v area="$(value area)" 'BEGIN { exit !(area > 1.08 && area < 1.11) }' ||
    fail "a sphere with a hole has the area $(value area)"
run isosurface holed --array place --value 0.5 --threshold 0
[ "$(value open_edges)" = 0 ] || fail "holes of another field: $(cat out)"
# What an embedded boundary covers is no part of the domain: a cylinder through the sphere.
run isosurface around_body --array distance --value 0 --threshold 0
[ "$(value open_edges)" -gt 50 ] || fail "no hole where a body is: $(cat out)"
awk -v area="$(value area)" 'BEGIN { exit !(area > 1.02 && area < 1.045) }' ||
    fail "a sphere beside a body has the area $(value area)"
run info around_body
grep -qE '^distance +-0\.2[0-9]+ +0\.[0-9]+$' out && grep -qE '^vfrac +0 +1$' out || fail "info of a body: $(cat out)"
refused 1 "a value of the field is not a usable number: inf, at \(0\.[0-9]+, 0\.[0-9]+, 0\.[0-9]+\)" \
    isosurface infinite --array distance --value 0
run info infinite
grep -qE '^distance +-0\.2[0-9]+ +inf$' out || fail "info of infinite values: $(cat out)"

# Sharper values bring a sphere nearer to its area, 0.36 pi.
off() { awk -v area="$(value area)" 'BEGIN { off = area / 1.1309734 - 1; print off < 0 ? -off : off }'; }
run isosurface plt00000 --array distance --value 0 --threshold 0
smooth=$(off)
run isosurface plt00000 --array distance --value 0 --threshold 0 --cells centres
closed "sharp values"
awk -v smooth="$smooth" -v sharp="$(off)" 'BEGIN { exit !(2 * sharp < smooth) }' ||
    fail "sharp values are off by $(off), smooth ones by $smooth"
refused 2 "^nestgrid: --cells: 'sharp' is none of 'smooth', 'centres', 'means'" \
    isosurface plt00000 --array distance --value 0 --cells sharp

refused 1 "there are several fields, choose one by --array: 'distance', 'place'" isosurface plt00000 --value 0
refused 1 "there is no field 'distence', only 'distance', 'place': did you mean 'distance'\?" \
    isosurface plt00000 --array distence --value 0
refused 1 "'other' has another grid than the first input" \
    isosurface plt00000 other --array distance --value 0 --time 0.5
refused 1 "'missing' is no plotfile, as the first is" \
    isosurface plt00000 missing --array distance --value 0 --time 0.5
refused 1 "'plane' has 2 dimensions, not 3" \
    isosurface plt00000 plane --array distance --value 0 --time 0.5
refused 1 "^nestgrid: --label is for .* files, not for 'plt00000'" \
    isosurface plt00000 --array distance --label 3 --value 0.5
refused 1 "^nestgrid: --array chooses nothing" info plt00000 --array distance
mkdir cut && cp -r plt00000/* cut
truncate -s -1 cut/Level_2/Cell_D_00001
refused 1 "'cut/Level_2/Cell_D_00001' is truncated: it has [0-9]+ bytes, too few for the record at 0" info cut
rm cut/Level_2/Cell_D_00001
refused 1 "'cut/Level_2/Cell_D_00001' cannot be opened: No such file" info cut
sed -i 's/((32,32,32) (63,95,95)/((33,32,32) (63,95,95)/' cut/Level_2/Cell_H
cp plt00000/Level_2/Cell_D_00001 cut/Level_2
refused 1 "box 0 of level 2, .* cuts cells of level 1: it is not aligned to the ratio 4" info cut

[ "$failures" = 0 ]
