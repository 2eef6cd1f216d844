#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The program as its users meet it: every format in and out, and wrong input of every kind.
# Arguments: the program, the maker of volumes.
set -uo pipefail
program=$1
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
"$2" "$work" || exit 1
cd "$work" || exit 1
failures=0
prefix=(env)

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}
value() { awk -v name="$1" '$1 == name { print $2 }' out; }

# refused STATUS PATTERN ARGUMENTS...: one line on stderr, no output, no file.
refused() {
    local status=$1 pattern=$2
    shift 2
    ls -A >before
    "${prefix[@]}" "$program" "$@" >out 2>err
    local got=$?
    ls -A | grep -vxF -f before >new
    [ "$got" = "$status" ] || fail "$*: exit status $got, not $status"
    [ "$(wc -l <err)" = 1 ] || fail "$*: not one line but: $(cat err)"
    grep -qE -e "$pattern" err || fail "$*: '$(cat err)' does not say '$pattern'"
    [ ! -s out ] || fail "$*: wrote to standard output"
    grep -vxE 'out|err|new|before' new && fail "$*: left a file behind"
    return 0
}

raw_options=(--dims 20,24,18 --type uint8 --spacing 0.5,1,2)
expected=
for format in vti mhd mha nii nii.gz nrrd raw; do
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

for format in vtp ply stl obj gltf; do
    "$program" isosurface float.vti --value 130 -o s.$format >out 2>err || fail "-o s.$format: $(cat err)"
    [ -s s.$format ] || fail "s.$format is missing"
done
"$program" isosurface v.vti --value 130 --threshold 0 --threshold 10 --against-vtk -o t.vtp >out ||
    fail "table"
[ -s t-1.vtp ] && [ -s t-2.vtp ] || fail "numbered output"
grep -q '^VTK FlyingEdges' out || fail "row of VTK"

"$program" isosurface v.vti --value 900 -o empty.vtp >out 2>err || fail "empty: status"
grep -q '^empty: the isovalue 900 is outside the range' out || fail "empty: $(cat out)"
[ -s empty.vtp ] || fail "empty.vtp is missing"

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
refused 1 'sample at \(5, 7, 3\) is not a number' isosurface nan.vti --value 130 -o x.vtp
refused 1 '5 x 5 x 1' isosurface flat.vti --value 1
refused 1 '3 numbers per sample' isosurface colours.vti --value 1
refused 1 "no point data array 'rain'" isosurface v.vti --array rain --value 1
refused 1 'does not exist' isosurface nothing.vti --value 1
echo x >what.abc
refused 1 'known format' isosurface what.abc --value 1
: >empty.nii && refused 1 'is empty' isosurface empty.nii --value 1
refused 1 'cannot be written' isosurface v.vti --value 130 -o missing/x.vtp
refused 1 'names no known format' isosurface v.vti --value 130 -o x.doc
refused 1 "threshold 'much'" isosurface v.vti --value 130 --threshold much
refused 1 "threshold '-3'" isosurface v.vti --value 130 --threshold=-3
refused 2 '--frobnicate' isosurface v.vti --value 130 --frobnicate
refused 2 'value is required' isosurface v.vti
refused 2 '' isosurface
refused 2 '' paint v.vti
"$program" --help | grep -q 'Examples:' || fail "--help"
"$program" --version | grep -qE '^nestgrid [0-9]' || fail "--version"

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
