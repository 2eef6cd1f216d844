#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# A volume of 14 MB in every format and variant: each must be read as the bare samples are.
# Arguments: the program, the maker of volumes.
set -uo pipefail
. "$(dirname "$0")/values.sh"
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$2" "$work" large || exit 1
cd "$work" || exit 1
failures=0
fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

meta() {
    printf '%s\n' 'ObjectType = Image' 'NDims = 3' 'BinaryData = True' 'DimSize = 256 256 108' \
        'ElementSpacing = 1 1 1' 'ElementType = MET_SHORT' "$@"
}
nrrd() {
    printf '%s\n' NRRD0004 '# a comment' 'type: short' 'dimension: 3' 'sizes: 256 256 108' 'key:=value' "$@"
}
gzip -c large.raw >large.raw.gz
dd if=large.raw of=swapped.raw conv=swab 2>dd.log
split -b $((2 * 256 * 256 * 27)) -d -a 1 --additional-suffix=.raw large.raw part
{ head -c 100 /dev/zero && cat large.raw; } >behind.raw
od -An -v -t d2 large.raw >large.txt

meta 'BinaryDataByteOrderMSB = False' 'ElementDataFile = large.raw' >plain.mhd
meta 'BinaryDataByteOrderMSB = True' 'ElementDataFile = swapped.raw' >swapped.mhd
meta 'HeaderSize = -1' 'ElementDataFile = behind.raw' >behind.mhd
meta 'ElementDataFile = LIST' part0.raw part1.raw part2.raw part3.raw >list.mhd
meta 'ElementDataFile = part%d.raw 0 3 1' >pattern.mhd
{ meta 'ElementDataFile = LOCAL' && cat large.raw; } >plain.mha
# Of two lengths, so that the samples of one of them begin at an odd byte, where none can be looked at.
{ meta 'Comment = a' 'ElementDataFile = LOCAL' && cat large.raw; } >shifted.mha
{ meta 'Comment = ab' 'ElementDataFile = LOCAL' && cat large.raw; } >more.mha
{ head -c $((2 * 256 * 256 * 108)) /dev/zero && cat large.raw; } >two.raw
meta 'ElementDataFile = two.raw' | sed 's/NDims = 3/NDims = 4/; s/256 256 108/& 2/; s/1 1 1/& 1/' >two.mhd
nrrd 'encoding: raw' 'endian: little' 'data file: large.raw' '' >plain.nhdr
nrrd 'encoding: raw' 'endian: big' 'datafile: ./swapped.raw' '' >swapped.nhdr
nrrd 'encoding: gzip' 'endian: little' 'data file: large.raw.gz' >packed.nhdr && echo >>packed.nhdr
nrrd 'encoding: raw' 'byte skip: 100' 'data file: behind.raw' '' >skip.nhdr
nrrd 'encoding: raw' 'byte skip: -1' 'data file: behind.raw' '' >behind.nhdr
nrrd 'encoding: raw' 'data file: LIST 3' part0.raw part1.raw part2.raw part3.raw >list.nhdr
nrrd 'encoding: raw' 'data file: part%01d.raw 0 3 1 3' '' >pattern.nhdr
nrrd 'encoding: ascii' 'data file: large.txt' '' >text.nhdr
{ nrrd 'encoding: raw' 'endian: little' '' && cat large.raw; } >plain.nrrd
{ nrrd 'encoding: gzip' 'endian: little' '' && cat large.raw.gz; } >packed.nrrd
{ nrrd 'encoding: ascii' '' && cat large.txt; } >text.nrrd

raw_options=(--dims 256,256,108 --type int16)
expected=
for file in large.raw large.vti plain.mhd swapped.mhd behind.mhd list.mhd pattern.mhd \
    large_packed.mhd plain.mha shifted.mha more.mha two.mhd large_packed.mha plain.nhdr swapped.nhdr packed.nhdr skip.nhdr \
    behind.nhdr list.nhdr pattern.nhdr text.nhdr plain.nrrd packed.nrrd text.nrrd large.nii \
    large.nii.gz; do
    options=()
    [ $file = large.raw ] && options=("${raw_options[@]}")
    [ $file = two.mhd ] && options=(--frame 1)
    if ! "$program" info $file "${options[@]}" >out 2>err; then
        fail "$file: $(cat err)"
        continue
    fi
    [ ! -s err ] || fail "$file: wrote to standard error: $(cat err)"
    got="$(grep -E '^(samples|type|spacing|least_value|greatest_value)' out)"
    # The area tells the order of samples. Axes of a NIfTI file point elsewhere, so nothing else does.
    "$program" isosurface $file --value 600 --threshold 20 "${options[@]}" >out 2>err ||
        fail "$file: $(cat err)"
    got+=$'\n'"$(for name in triangles vertices open_edges area; do echo "$name $(value $name)"; done)"
    [ -n "$expected" ] || expected=$got
    [ "$got" = "$expected" ] || fail "$file gives $got, not $expected"
done
echo "$expected"
grep -q '^samples  *256 256 108$' <<<"$expected" || fail "samples"
grep -q '^greatest_value  *100[0-9]$' <<<"$expected" || fail "greatest value"
# A sphere of radius 50, to a few percent.
awk '$1 == "area" { exit !($2 > 30000 && $2 < 33000) }' <<<"$expected" || fail "area"

# The same files, too short.
head -c 7000000 large.raw >cut.raw
head -c 5000000 large.raw.gz >cut.raw.gz
sed 's/large/cut/' plain.mhd >cut.mhd
sed 's/large/cut/' plain.nhdr >cut_plain.nhdr
sed 's/large/cut/' packed.nhdr >cut_packed.nhdr
for file in large_packed.mha large.nii.gz large.nii plain.nrrd packed.nrrd text.nrrd large.vti; do
    head -c $(($(stat -c %s $file) * 3 / 4)) $file >cut_$file
done
# A header that asks for 64 GB, which a file of this size could hold.
nrrd 'encoding: gzip' 'data file: bomb.gz' '' | sed 's/256 256 108/1048576 16384 2/' >bomb.nhdr
truncate -s 70000000 bomb.gz
for file in cut.mhd cut_plain.nhdr cut_packed.nhdr cut_large_packed.mha cut_large.nii.gz cut_large.nii \
    cut_plain.nrrd cut_packed.nrrd cut_text.nrrd cut_large.vti bomb.nhdr; do
    "$program" info $file >out 2>err
    [ $? = 1 ] || fail "$file is not refused"
    [ ! -s out ] && [ "$(wc -l <err)" = 1 ] || fail "$file: not one line but: $(cat err)"
    cat err
done
[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
