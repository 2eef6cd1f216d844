#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Standard input and output in the place of files. Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

# What is kept for a while goes again.
mkdir kept && export TMPDIR=$work/kept
empty() { [ -z "$(ls -A kept)" ] || fail "$*: left $(ls -A kept) behind"; }

printf 'P5\n9 7\n255\n%s' "$(printf 'abcdefghi%.0s' 1 2 3 4 5 6 7)" >ramp.pgm
run mesh "$cube" --family bisection --field x --refine 4 -o cube.nestgrid

# A stream is what the file is, whatever its format.
for name in v.vti v.mha v.nii v.nii.gz v.nrrd v.raw ramp.pgm cube.nestgrid; do
    options=()
    [ $name = v.raw ] && options=(--dims 20,24,18 --type uint8)
    run info $name "${options[@]}" && mv out of_file
    run info - --input-format "${name#*.}" "${options[@]}" <$name
    cmp -s out of_file || fail "info - of $name: $(diff out of_file)"
    empty "info - of $name"
done
run info - --input-format .VTI <v.vti
run probe v.vti --line 0,0,0,9,9,9 --count 3 && mv out of_file
run probe - --input-format vti --line 0,0,0,9,9,9 --count 3 -o - <v.vti
cmp -s out of_file || fail "probe -: $(cat out)"

# What goes to standard output is the file, and nothing else; the table goes to standard error.
for format in ply vtp stl obj gltf; do
    run isosurface v.vti --value 130 --threshold 2 -o s.$format
    triangles=$(value triangles)
    "$program" isosurface - --input-format vti --value 130 --threshold 2 -o - --output-format $format \
        <v.vti >stream 2>out || fail "-o - as $format: $(cat out)"
    cmp -s stream s.$format || fail "standard output is not s.$format"
    [ "$(value triangles)" = "$triangles" ] || fail "the table of $format: $(cat out)"
    grep -q "^wrote standard output.$format (" out || fail "$format: $(cat out)"
    empty "-o - as $format"
done
for command in "slice v.vti --axis z --at 9" "boundary v.vti" "isolines v.vti --axis z --at 9 --count 2" \
    "surface ramp.pgm" "height ramp.pgm --scale 2"; do
    run $command -o s.ply
    "$program" $command -o - --json >stream 2>document || fail "$command -o -: $(cat document)"
    cmp -s stream s.ply || fail "$command -o - is not s.ply"
    python3 -c 'import json; json.load(open("document"))["files"][0]["triangles"]' 2>err ||
        grep -q '"lines"' document || fail "$command -o - --json: $(cat document)"
done
"$program" isosurface v.vti --value 130 -o - 2>err >/dev/full && fail "a full device takes a surface"
grep -q 'standard output could not be written: No space' err || fail "a full device: $(cat err)"
empty "a full device"

# Wrong use, in one sentence.
in=v.vti
wrong() { refused "$@" <$in; }
wrong 1 'no name that tells its format: give --input-format' info -
wrong 1 "input format 'vtj' is none of .*: did you mean '.vti'" info - --input-format vtj
wrong 1 "input format 'vtp' is none of" info - --input-format vtp
for format in mhd nhdr hdr img; do wrong 1 "a .$format file comes with others" info - --input-format $format; done
wrong 1 'input-format is for standard input' info v.vti --input-format vti
wrong 1 'only the INPUT can be standard input' info - --input-format vti --mask -
wrong 1 'only the first input can be standard input' isosurface - - --input-format vti --value 1 --time 0.5
wrong 1 'array is for ' info - --input-format nii --array x
wrong 1 'output-format is for standard output' isosurface v.vti --value 130 --output-format ply
wrong 1 'output-format is for standard output' isosurface v.vti --value 130 -o x.ply --output-format ply
wrong 1 "output format 'doc' is none of" isosurface v.vti --value 130 -o - --output-format doc
wrong 1 'takes one surface' isosurface v.vti --value 130 --threshold 1 --threshold 2 -o -
wrong 1 'takes one surface' isosurface v.vti --value 0.5 --label 1 --label 2 -o -
wrong 1 'a film needs an --output' isosurface cube.nestgrid cube.nestgrid --value 0.5 --frames 3 -o -
in=/dev/null
wrong 1 "^nestgrid: 'standard input.vti' is empty$" info - --input-format vti
head -c 3000 v.nii >cut.nii && in=cut.nii
wrong 1 '^nestgrid: standard input.nii' info - --input-format nii
empty "wrong use"

# Nor does what is kept stay where the program is ended.
mkfifo pipe
"$program" info - --input-format vti <pipe >out 2>err &
exec 3>pipe
head -c 1000 v.vti >&3
for _ in $(seq 50); do [ -n "$(ls -A kept)" ] && break || sleep 0.1; done
[ -n "$(ls -A kept)" ] || fail "nothing is kept while standard input is read"
kill -TERM $! && wait $!
exec 3>&-
empty "a signal"

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
