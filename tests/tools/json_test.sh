#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# What commands print: one shape of table, the files that were written, and the same as JSON, which
# Python reads. Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

printf 'P5\n9 7\n255\n%s' "$(printf 'abcdefghi%.0s' 1 2 3 4 5 6 7)" >ramp.pgm
run mesh "$cube" --family bisection --field x+t --times 0,1 --refine 4 -o film.nestgrid

# ask CODE ARGUMENTS...: runs a command with --json and Python's CODE on the document `d`.
ask() {
    local code=$1
    shift
    "$program" "$@" --json >document 2>err || fail "$*: $(cat err)"
    [ ! -s err ] || fail "$*: wrote to standard error: $(cat err)"
    python3 - "$code" <<'END' || fail "$* --json: $code: $(cat document)"
import json, os, sys
def refuse(text): raise ValueError(text)
d = json.load(open("document"), parse_constant=refuse)
assert isinstance(d["files"], list) and isinstance(d["notes"], list)
for file in d["files"]: assert os.path.getsize(file["path"]) == file["bytes"] > 0, file
def same(rows): return len({tuple(sorted(row)) for row in rows}) == 1
assert eval(sys.argv[1]), sys.argv[1]
END
}

# Text and document say the same.
iso=(isosurface v.vti --value 130)
run "${iso[@]}" --threshold 2 -o a.vtp
ask "d['surfaces'][0]['triangles'] == $(value triangles) and d['field'] == 'value'" "${iso[@]}" --threshold 2
grep -qxE "wrote a.vtp \\($(value triangles | sed -E ':a; s/([0-9])([0-9]{3})($|,)/\1,\2\3/; ta') triangles, [0-9.]+ [kM]B\\)" out ||
    fail "wrote: $(cat out)"

# One shape for one and for many thresholds, budgets and times.
columns() { "$program" "$@" | awk '!NF { getline; $1 = $1; print }' | grep -v '^nothing\|^in all\|^wrote\|^[0-9]* of '; }
for command in "${iso[*]}" "slice v.vti --axis z --at 17" "boundary v.vti" "isolines v.vti --axis z --at 17 --count 3"; do
    one=$(columns $command --threshold 1)
    [ "$one" = "$(columns $command --threshold 1 --threshold 2)" ] || fail "$command: other columns for two"
    [[ "$one" = threshold\ triangles\ * ]] || fail "$command: $one"
    [ "$(columns $command --max-triangles 5000)" = "$(columns $command --max-triangles 5000 --max-triangles 9000)" ] ||
        fail "$command: other columns for two budgets"
    ask "same(d['surfaces']) and len(d['surfaces']) == 2" $command --threshold 1 --threshold 2
    "$program" $command --threshold 1 --threshold 2 | awk 'length > 80 { exit 1 }' || fail "$command: a wide table"
    "$program" $command --threshold 1 --threshold 2 | grep -qE '^in all: 2 surfaces, [0-9,]+ triangles, ' || fail "$command: no sum"
done
# The same facts and columns, whatever is drawn.
for command in "${iso[*]}" "band v.vti --low 100 --high 130" "slice v.vti --axis z --at 17" "boundary v.vti" "isolines v.vti --axis z --at 17 --count 3" \
    "isolines v.vti --on-surface 130 --by x --count 3" "surface ramp.pgm" "height ramp.pgm --scale 1"; do
    ask "{'nodes', 'leaf_elements', 'preroll_kept_bytes', 'read_seconds', 'least_value'} <= d.keys() and {'triangles',
        'vertices', 'error_bound', 'open_edges', 'area', 'seconds', 'boundary_edges', 'inspect_calls', 'search_trials',
        'search_seconds', 'peak_bytes'} <= d['surfaces'][0].keys()" $command --max-triangles 5000
done
timed=(isosurface film.nestgrid --value 0.5)
[ "$(columns "${timed[@]}" --time 0.5)" = "$(columns "${timed[@]}" --frames 3 -o f.vtp)" ] || fail "other columns for a film"
ask "[s['time'] for s in d['surfaces']] == [0, 0.5, 1] and len(d['files']) == 4" "${timed[@]}" --frames 3 -o f.vtp

# Sums of lines.
run isolines v.vti --axis z --at 17 --values 50,150
[ "$(value isoline | tr '\n' ' ')" = "50 150 " ] || fail "isolines: $(cat out)"
ask "all(i['rings'] + i['open_lines'] > 0 and i['length'] > 0 for i in d['isolines'])" isolines v.vti --axis z --at 17 --values 50,150

# Nothing is kept, or what is kept is named.
for command in "${iso[*]}" "slice v.vti --axis z --at 17" "boundary v.vti" "isolines v.vti --axis z --at 17 --count 3" \
    "height ramp.pgm --scale 1" "surface ramp.pgm"; do
    run $command
    grep -qx 'nothing was kept: give -o FILE or --image FILE' out || fail "$command does not say that nothing was kept"
    ask "'nothing was kept' in d['notes'][0] and d['files'] == []" $command
    run $command -o k.ply
    grep -q '^wrote k.ply (' out && ! grep -q nothing out || fail "$command -o: $(cat out)"
    ask "[f['path'] for f in d['files']] == ['k-1.vtp', 'k-2.vtp', 'k.pvd'] and d['files'][2]['files'] == 2" \
        $command -o k.vtp --threshold 1 --threshold 2
done
if command -v Xvfb >/dev/null; then
    run "${iso[@]}" --image p.png && grep -q '^wrote p.png (' out || fail "picture: $(cat out)"
    ask "d['files'][0]['path'] == 'p.png'" "${iso[@]}" --image p.png
fi

# The other commands.
for format in vti mhd nii.gz nrrd; do ask "d['samples'] == [20, 24, 18] and d['greatest_value'] == 250" info v.$format; done
ask "d['samples'] == [9, 7]" info ramp.pgm
ask "d['fields'][0]['field'] == 'x+t' and d['times'] == [0, 1]" info film.nestgrid
ask "d['files'][0]['elements'] == d['leaf_elements']" mesh "$cube" --family bisection --field x -o o.nestgrid
ask "d['files'][0]['path'] == 'p.nestgrid'" pack film.nestgrid --encode -o p.nestgrid
ask "d['fields'][0]['encoded'] == 'exactly'" info p.nestgrid
ask "len(d['points']) == 3 and d['points'][0]['value'] == 10 and 'level' in d['points'][0]" \
    probe v.vti --line 0,0,0,9.5,23,34 --count 3
ask "len(d['points']) == 6 and d['points'][5]['time'] == 1 and d['points'][5]['x+t'] == 2" \
    probe film.nestgrid --line 0,0,0,1,1,1 --count 2 --frames 3
ask "'points' not in d and d['files'][0]['points'] == 3" probe v.vti --line 0,0,0,9.5,23,34 --count 3 -o p.csv
ask "d['vtk'][0]['triangles'] > 0" "${iso[@]}" --against-vtk
ask "'outside the range' in ' '.join(d['notes'])" isosurface v.vti --value 900
# Errors stay sentences.
refused 1 'does not exist' isosurface none.vti --value 1 --json
refused 2 'no option' isosurface v.vti --frobnicate --json

# Names and units are those of the file.
sed 's/space: left-posterior-superior/&\nspace units: "um" "um" "um"\ncontent: density/' v.nrrd >units.nrrd
ask "d['length_unit'] == 'um' and d['field'] == 'density'" info units.nrrd
ask "d['length_unit'] == 'um' and d['field'] == 'density'" isosurface units.nrrd --value 130 -o u.vtp
grep -q 'Name="length_unit"' u.vtp && grep -q 'Name="density"' u.vtp || fail "u.vtp does not say what it is"
ask "d['field'] == 'density'" slice units.nrrd --axis z --at 17 -o u.vtp
grep -q 'Name="length_unit"' u.vtp && grep -q 'Name="density"' u.vtp || fail "the slice does not say what it is"
run probe units.nrrd --line 0,0,0,1,1,1 --count 2
head -1 out | grep -qx 'x,y,z,density,level' || fail "probe: $(cat out)"
# The unit of a NIfTI file is its byte 123: 1 is m, 2 mm, 3 um.
for unit in 1:m 2:mm 3:µm; do
    cp v.nii unit.nii && printf "\\x${unit%:*}" | dd of=unit.nii bs=1 seek=123 conv=notrunc 2>/dev/null
    ask "d['length_unit'] == '${unit#*:}'" info unit.nii
done
ask "'length_unit' not in d" info v.vti
sed 's/^ElementDataFile/Name = density\nDistanceUnits = mm\n&/' v.mhd >units.mhd
ask "d['length_unit'] == 'mm' and d['field'] == 'density'" info units.mhd

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
