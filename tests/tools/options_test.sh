#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Every option that is given has an effect, or is refused in one sentence. The options are those of
# --help-all: one that no case here names fails the test. Arguments: the program, the maker of
# volumes.
. "$(dirname "$0")/functions.sh"

: >covered
# result ARGUMENTS...: what a command prints and writes, without times and memory; where it is
# refused, the sentence.
result() {
    rm -rf kept && mkdir kept
    "$program" "$@" --json >document 2>err || { echo "refused: $(cat err)"; return; }
    # One key or number a line.
    grep -vE '"[a-z_]*(seconds|bytes)[a-z_]*" :|"in all: ' document
    find kept -type f -exec sha256sum {} + | sort
}
# plain ARGUMENTS...: the same, kept from one call to the next.
mkdir known
plain() {
    local of
    of=known/$(sha256sum <<<"$*" | cut -c1-32)
    [ -e "$of" ] || result "$@" >"$of"
    cat "$of"
}

# effect COMMAND BASE OPTION [VALUE]: with the option, the result is another one.
effect() {
    local command=$1 base=$2
    shift 2
    echo "$command $1" >>covered
    local without with
    without=$(plain $command $base)
    with=$(result $command $base "$@")
    [[ "$without" != refused:* ]] || fail "$command $base: $without"
    [[ "$with" != refused:* ]] || fail "$command $base $*: $with"
    [ "$with" != "$without" ] || fail "$command $base: $* has no effect"
}

# differ COMMAND OPTION ARGUMENTS OTHERS: two values of the option have two results.
differ() {
    local one other
    one=$(result $1 $3)
    other=$(result $1 $4)
    echo "$1 $2" >>covered
    [[ "$one$other" != *refused:* ]] || fail "$1 $3, $4: $one $other"
    [ "$one" != "$other" ] || fail "$1: $3 and $4 are the same"
}

# void COMMAND PATTERN BASE OPTION [VALUE]: where the option would have no effect, it is refused.
void() {
    local command=$1 pattern=$2 base=$3
    shift 3
    [[ "$(plain $command $base)" != refused:* ]] || fail "$command $base: $(cat err)"
    refused 1 "$pattern" $command $base "$@"
}

{
    printf 'P5\n65 65\n255\n'
    LC_ALL=C awk 'BEGIN { for (i = 0; i < 65 * 65; ++i) printf "%c", 64 + 50 * sin(i % 65 / 9) * cos(int(i / 65) / 7) }'
} >hills.pgm
run mesh "$cube" --family bisection --field 'sqrt(x^2+y^2+z^2)+t' --times 0,1,3 --refine 8 -o film.nestgrid
run mesh "$cube" --family bisection --field x --field z*z --refine 6 -o two.nestgrid
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n' >plane.off
run mesh plane.off --family bisection --field x --field 'x*y' --refine 6 -o plane.nestgrid
run mesh plane.off --family prism --layers 1 --direction 0,0,1 --field 'x*z+y*z' --refine 1 -o prisms.nestgrid
cp two.nestgrid first.nestgrid && cp two.nestgrid second.nestgrid
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n' >quad.obj
run mesh quad.obj --family red-green --field 'x*y' --refine 3 -o quads.nestgrid
raw='v.raw --dims 20,24,18 --type uint8'
for name in a b; do head -c 8000 v.raw | tail -c 7680 >$name.raw; done
head -c 8640 v.raw | tail -c 7680 >b.raw
local_samples() { printf '%s\n' 'DimSize = 20 24 9' 'ElementSpacing = 1 1 2' 'ElementType = MET_UCHAR' 'ElementDataFile = LOCAL' && cat v.raw; }
{ echo 'NDims = 4' && local_samples | sed 's/24 9$/24 9 2/; s/1 1 2$/1 1 2 1/'; } >series.mha
{ printf '%s\n' 'NDims = 3' 'ElementNumberOfChannels = 2' && local_samples; } >vectors.mha
{ printf '%s\n' 'NDims = 4' 'DimSize = 20 216 1 2' 'ElementSpacing = 1 1 1 1' 'ElementType = MET_UCHAR' \
    'ElementDataFile = LOCAL' && cat v.raw; } >plane.mha
{ printf '%s\n' 'NDims = 2' 'DimSize = 20 216' 'ElementSpacing = 1 1' 'ElementNumberOfChannels = 2' \
    'ElementType = MET_UCHAR' 'ElementDataFile = LOCAL' && cat v.raw; } >pairs.mha
{ echo 'AnatomicalOrientation = RAI' && echo 'NDims = 3' && local_samples; } >patient.mha
{ printf '%s\n' 'AnatomicalOrientation = RAI' 'NDims = 3' 'DimSize = 20 432 1' 'ElementSpacing = 1 1 1' \
    'ElementType = MET_UCHAR' 'ElementDataFile = LOCAL' && cat v.raw; } >body.mha
# Twelve rows of 1, twelve of 0, and so on.
for ((i = 0; i < 18; ++i)); do head -c 240 /dev/zero | tr '\0' '\1' && head -c 240 /dev/zero; done >half.raw
{ printf '%s\n' 'NDims = 3' 'DimSize = 20 24 18' 'ElementSpacing = 0.5 1 2' 'ElementType = MET_UCHAR' \
    'ElementDataFile = half.raw'; } >half.mhd
{ printf '%s\n' 'NDims = 3' 'DimSize = 20 432 1' 'ElementSpacing = 1 1 1' 'ElementType = MET_UCHAR' \
    'ElementDataFile = half.raw'; } >half_plane.mhd
frames='a.raw b.raw --dims 20,24,16 --type uint8'

declare -A base=([isosurface]='--value 130' [slice]='--axis z --at 9' [isolines]='--axis z --at 9 --count 3'
    [band]='--low -9 --high 130' [boundary]='' [probe]='--line 0,0,0,9,17,11 --count 7' [info]='')
for command in isosurface band slice isolines boundary probe info; do
    options=${base[$command]}
    keep='-o kept/x.vtp'
    [ $command = probe ] && keep='-o kept/x.csv'
    [ $command = info ] && keep=
    # Input.
    void $command 'is for .raw files' "v.vti $options" --dims 20,24,18
    void $command 'is for .raw files' "v.vti $options" --type uint8
    void $command 'is for .raw files' "v.nii.gz $options" --endian big
    void $command 'is for .raw files' "v.nrrd $options" --spacing 1,1,1
    void $command 'is for AMReX plotfile, .athdf, Chombo, .dcm, .hierarchy, FLASH, .pvd, .htg, .phtg, .vti, .vthb, .vtu, .pvtu and .nestgrid' "v.mha $options" --array value
    void $command 'is for AMReX plotfile, .* files' "v.mha $options" --cells centres
    echo "$command --cells" >>covered
    void $command 'one frame only' "v.mha $options" --frame 0
    void $command 'one number per sample' "v.nrrd $options" --component 0
    void $command 'one number per sample' "v.vti $options" --magnitude
    void $command 'is for .dcm, .mha' "two.nestgrid $([ $command = info ] || sed 's/^/--array x /; s/130/0.5/; s/at 9/at 0.5/; s/9,17,11/1,1,1/' <<<"$options")" --magnitude
    effect $command "series.mha $options" --frame 1
    differ $command --component "vectors.mha $options --component 0" "vectors.mha $options --component 1"
    differ $command --magnitude "vectors.mha $options --component 0" "vectors.mha $options --magnitude"
    void $command 'does not say where its axes point' "v.mha $options" --space ras
    differ $command --space "patient.mha $options $keep --space ras" "patient.mha $options $keep --space lps"
    half=$(sed 's/130/0.5/' <<<"$options")
    differ $command --label "v.mha $half $keep --label 130" "v.mha $half $keep"
    effect $command "v.mha $options $keep" --mask half.mhd
    differ $command --missing "half.mhd $half $keep --missing 0" "half.mhd $half $keep"
    # Streams have a test of their own.
    void $command 'is for standard input' "v.mha $options" --input-format mha
    echo "$command --input-format" >>covered
    refused 1 'exclude each other' $command vectors.mha $options --component 0 --magnitude
    void $command "not for 'two.nestgrid'" "$([ $command = info ] && echo two.nestgrid || echo "two.nestgrid --array x $options" | sed 's/130/0.5/; s/at 9/at 0.5/; s/9,17,11/1,1,1/')" --read-limit 5
    refused 1 'give --dims' $command v.raw $options && echo "$command --dims" >>covered
    refused 1 'has 8640 bytes' $command v.raw $options --dims 20,24,18 --type int16 && echo "$command --type" >>covered
    # Neither order of the bytes has the greatest value of the other one.
    LC_ALL=C awk 'BEGIN { srand(1); for (i = 0; i < 8640; ++i) printf "%c%c", 1 + 100 * rand(), 1 + 120 * rand() }' >two.raw
    two="two.raw --dims 20,24,18 --type int16 $(sed 's/130/9000/' <<<"$options")"
    effect $command "$two" --endian big
    effect $command "$raw $options" --spacing 0.9,1.1,1.3
    refused 1 'within 1e-06 seconds' $command v.nii.gz $options --read-limit 1e-6 && echo "$command --read-limit" >>covered
    echo "$command --json" >>covered
    [ $command = info ] && continue
    inside=$(sed 's/130/0.5/; s/at 9/at 0.4/; s/9,17,11/1,1,1/' <<<"$options")
    differ $command --array "two.nestgrid $inside --array x" "two.nestgrid $inside --array z*z"
    # Detail.
    effect $command "$raw $options $keep" --threshold 30
    void $command 'needs a --threshold' "$raw $options" --indicator visual
    void $command 'needs a --threshold' "$raw $options" --blend 2
    void $command 'needs a --threshold' "$raw $options --lens ball:9,9,9,3" --indicator visual
    effect $command "$raw $options $keep --threshold 1" --indicator visual
    effect $command "$raw $options $keep --threshold 10" --blend 2
    # Lens.
    effect $command "$raw $options $keep" --lens ball:0,0,0,2
    lens='--lens ball:0,0,0,2'
    effect $command "$raw $options $keep $lens" --finest 4
    effect $command "$raw $options $keep $lens --slope 9" --coarsest 2
    effect $command "$raw $options $keep $lens" --slope 3
    for option in finest coarsest slope; do refused 2 lens $command $raw $options --$option 1; done
    # Time.
    effect $command "$frames $options $keep --time 0.5" --times 0,2
    effect $command "film.nestgrid $(sed 's/130/1.5/; s/at 9/at 0.4/; s/9,17,11/1,1,1/' <<<"$options") $keep --time 1.7" --cubic
    refused 1 'at least three frames' $command $frames $options --time 0.5 --cubic
    void $command 'need --time or --frames' "$raw $options" --cubic
    void $command 'need --time or --frames' "$raw $options" --times 0
    void $command 'need several inputs' "$raw $options" --time 0
    void $command 'need several inputs' "$raw $options $keep" --frames 3
    "$program" $command $frames $options $keep --frames 3 >out 2>err || fail "$command --frames: $(cat err)"
    echo "$command --frames" >>covered
    echo "$command --time" >>covered
done

void info 'chooses nothing' two.nestgrid --array x
refused 1 'no point data array' info v.vti --array none && echo "info --array" >>covered

# What is drawn.
# encoding COMMAND ARGUMENTS: --compress and --double of a file, and where there is none.
encoding() {
    for packed in zlib none; do effect $1 "$2 -o kept/x.vtp" --compress $packed; done
    [ "$(result $1 $2 -o kept/x.vtp --compress lz4)" = "$(plain $1 $2 -o kept/x.vtp)" ] || fail "$1: lz4 is not the default"
    effect $1 "$2 -o kept/x.vtp" --double
    [[ "$(result $1 $2 -o kept/x.ply --double)" != refused:* ]] || fail "$1 --double: refused for a .ply"
    grep -aq 'property double z' kept/x.ply || fail "$1 --double: a .ply of single precision"
    for output in '' '-o kept/x.ply' '-o kept/x.stl' '-o kept/x.obj' '-o kept/x.gltf'; do
        void $1 'compress is for an --output as .vtp' "$2 $output" --compress none
        [[ $output = *ply ]] || void $1 'double is for an --output as .ply or .vtp' "$2 $output" --double
    done
    refused 2 "'zip' is none of" $1 $2 -o kept/x.vtp --compress zip
}
for command in isosurface band slice isolines boundary; do
    encoding $command "$raw ${base[$command]}"
    effect $command "$raw ${base[$command]}" --max-triangles 3000
    void $command 'is for standard output' "$raw ${base[$command]}" --output-format ply
    echo "$command --output-format" >>covered
    effect $command "$raw ${base[$command]}" --error 30
    case $command in slice | boundary) effect $command "$raw ${base[$command]} --error 30" --collapse ;; esac
    if [ $command != isolines ]; then
        effect $command "$raw ${base[$command]} -o kept/x.vtp" --elements
        grep -q 'Name="element"' kept/x.vtp && grep -q 'Name="level"' kept/x.vtp || fail "$command --elements: no arrays"
        void $command 'elements is for an --output as .vtp' "$raw ${base[$command]} -o kept/x.ply" --elements
        void $command 'elements is for an --output as .vtp' "$raw ${base[$command]}" --elements
        [ $command = band ] || refused 2 'excludes' $command $raw ${base[$command]} --error 30 --collapse --elements -o x.vtp
    fi
    for option in '--threshold 1' '--max-triangles 900' '--indicator visual'; do
        refused 2 'error excludes|excludes --error' $command $raw ${base[$command]} --error 30 $option
    done
    effect $command "$raw ${base[$command]}" --output kept/x.vtp
    effect $command "$raw ${base[$command]}" -o kept/x.vtp
    "$program" $command $raw ${base[$command]} --threads 1 -o one.vtp >out && "$program" $command $raw ${base[$command]} --threads 3 -o three.vtp >out
    cmp -s one.vtp three.vtp || fail "$command: another surface by three threads"
    refused 1 'threads is negative' $command $raw ${base[$command]} --threads -1
    echo "$command --threads" >>covered
done
differ band --low "$raw --low -9 --high 130" "$raw --low 50 --high 130"
differ band --high "$raw --low 50 --high 130" "$raw --low 50 --high 120"
effect band "$raw ${base[band]} -o kept/x.vtp" --no-normals
effect isosurface "$raw ${base[isosurface]}" --distance 0.5
for option in '--threshold 1' '--max-triangles 900' '--error 5' '--indicator visual'; do
    refused 2 'distance excludes|excludes --distance' isosurface $raw --value 130 --distance 1 $option
done
for number in 0 -1 nan x; do
    refused 1 "the distance '$number' is no number > 0" isosurface $raw --value 130 --distance=$number
    refused 1 "the error '$number' is no number > 0" isosurface $raw --value 130 --error=$number
done
for indicator in cut slope; do
    effect isosurface "$raw --value 130 --max-triangles 900" --indicator $indicator
    refused 2 "'$indicator'" slice $raw --axis z --at 9 --threshold 1 --indicator $indicator
done
refused 1 'is a length, not a percentage' isosurface $raw --value 130 --threshold 5% --indicator slope
effect isosurface "$raw --value 130 --distance 6" --distance-field
refused 2 'distance-field requires --distance' isosurface $raw --value 130 --distance-field
for option in "--lens 0,0,0,1" "--box 0,1,0,1,0,1 --box-threshold 1"; do
    refused 2 'distance-field excludes|excludes --distance-field' isosurface $raw --value 130 --distance 1 --distance-field $option
done
effect isosurface "$raw --value 130 --error 20" --collapse
refused 1 'collapse needs an --error, a --distance or --max-triangles' isosurface $raw --value 130 --collapse
for option in --cap --at-nodes '--lens ball:5,5,5,4' '--box 0,9,0,9,0,9'; do
    refused 2 'collapse excludes|excludes --collapse' isosurface $raw --value 130 --error 9 --collapse $option
done
refused 2 'collapse excludes|excludes --collapse' isosurface $raw --value 130 --collapse --threshold 1
refused 1 'collapse keeps an error: leave out --indicator' isosurface $raw --value 130 --collapse --max-triangles 900 --indicator visual
effect isosurface "$raw --value 130 --max-triangles 300 --collapse" --indicator slope
effect isosurface "$raw --value 130 --distance 6" --collapse
effect isosurface "$raw --value 130 --max-triangles 300" --collapse
effect slice "$raw --sphere 9,9,9,4 --error 30 --collapse" --distance 1
effect isosurface "$raw --value 130 --error 20" --measure
refused 2 'measure excludes|excludes --measure' isosurface $raw --value 130 --measure --cap
for option in --collapse --measure; do
    void isosurface 'is for surfaces, not for isolines' 'hills.pgm --value 60 --error 9' $option
done
void isosurface 'is for surfaces, not for isolines' 'hills.pgm --value 60 --distance 2' --distance-field
refused 1 'is a length, not a percentage' isosurface $raw --value 130 --distance 5%
effect isosurface "$raw --value 130 --threshold 30" --box 0,20,0,24,0,9
effect isosurface "$raw --value 130 --threshold 30 --box 0,20,0,24,0,9" --box-threshold 5
void isosurface 'needs a --threshold' "$raw --value 130" --box 0,9,0,9,0,9
refused 2 box isosurface $raw --value 130 --box-threshold 1
effect isosurface "$raw --value 30" --cap
effect isosurface "$raw --value 130 -o kept/x.vtp" --no-normals
void isosurface 'changes no .stl file' "$raw --value 130 -o kept/x.stl" --no-normals
effect isosurface "$raw --value 130 -o kept/x.ply" --no-normals
void isosurface 'is for surfaces, not for isolines' "hills.pgm --value 60" --cap
void isosurface 'is for surfaces, not for isolines' "hills.pgm --value 60 -o kept/x.vtp" --no-normals
effect isosurface "$raw --value 130" --at-nodes
effect isosurface "$raw --value 130 --threshold 20" --cuts finest
effect isosurface "$raw --value 130" --against-vtk
void isosurface 'is for one volume' "hills.pgm --value 60" --against-vtk

slices=("--axis z --at 9" "--axis x --at 9" "--axis z --at 8" "--plane 9,9,9,1,1,1" "--sphere 9,9,9,4" "--cylinder 9,9,9,0,0,1,4" "--function x*x-50")
for command in slice isolines; do
    count=
    [ $command = isolines ] && count='--count 3'
    seen=
    for slice in "${slices[@]}"; do
        new=$(result $command $raw $count $slice)
        [[ "$new" != refused:* ]] || fail "$command $slice: $new"
        [[ "$seen" != *"$new"* ]] || fail "$command: $slice has no effect"
        seen+=$new
        for name in $slice; do [[ $name != --* ]] || echo "$command $name" >>covered; done
    done
    refused 1 'needs one of' $command $raw $count --axis z --at 9 --sphere 9,9,9,4
    refused 2 axis $command $raw $count --at 9
done
effect slice "$raw --sphere 9,9,9,4" --cap
effect slice "$raw --axis z --at 9" --with-isosurface 130
for command in slice boundary; do
    effect $command "two.nestgrid --array x $([ $command = slice ] && echo --axis z --at 0.5) -o kept/x.vtp" --outlines
    void $command 'is about what is kept' "$raw ${base[$command]}" --outlines
    effect $command "prisms.nestgrid $([ $command = slice ] && echo --plane 0.5,0.5,0.3,0.3,0.5,0.81)" --colour-tolerance 0.01
done
[ "$(result isolines $raw --axis z --at 9 --count 3)" != "$(result isolines $raw --axis z --at 9 --count 4)" ] || fail "isolines --count"
[ "$(result isolines $raw --axis z --at 9 --values 30)" != "$(result isolines $raw --axis z --at 9 --values 40)" ] || fail "isolines --values"
[ "$(result isolines $raw --on-surface 130 --by x --count 3)" != "$(result isolines $raw --on-surface 130 --by y --count 3)" ] || fail "isolines --by"
[ "$(result isolines $raw --on-surface 130 --by x --count 3)" != "$(result isolines $raw --on-surface 140 --by x --count 3)" ] || fail "isolines --on-surface"
for name in count values on-surface by; do echo "isolines --$name" >>covered; done
refused 1 'either --values or --count' isolines $raw --axis z --at 9 --values 3 --count 3
refused 2 "values takes V,V,..., but nothing follows it" isolines $raw --axis z --at 9 --values ""
echo "isosurface --value" >>covered

# The plane.
for command in height surface; do
    options=$([ $command = height ] && echo --scale 2)
    keep='-o kept/x.vtp'
    differ $command --array "plane.nestgrid $options --array x" "plane.nestgrid $options --array x*y"
    void $command 'is for AMReX plotfile, .athdf, Chombo, .dcm, .hierarchy, FLASH, .pvd, .htg, .phtg, .vti, .vthb, .vtu, .pvtu and .nestgrid' "hills.pgm $options" --array value
    void $command 'is for AMReX plotfile, .* files' "hills.pgm $options" --cells centres
    echo "$command --cells" >>covered
    void $command 'is for standard input' "hills.pgm $options" --input-format pgm
    void $command 'is for standard output' "hills.pgm $options" --output-format ply
    for name in input output; do echo "$command --$name-format" >>covered; done
    refused 1 'within 1e-06 seconds' $command hills.pgm $options --read-limit 1e-6 && echo "$command --read-limit" >>covered
    void $command 'does not say where its axes point' "hills.pgm $options" --space ras
    differ $command --space "body.mha $options $keep --space ras" "body.mha $options $keep --space lps"
    # Bare samples in a plane, with several frames and components.
    differ $command --label "hills.pgm $options $keep --label 64" "hills.pgm $options $keep"
    effect $command "body.mha $options $keep" --mask half_plane.mhd
    differ $command --missing "half_plane.mhd $options $keep --missing 0" "half_plane.mhd $options $keep"
    effect $command "plane.mha $options" --frame 1
    differ $command --component "pairs.mha $options --component 0" "pairs.mha $options --component 1"
    differ $command --magnitude "pairs.mha $options --component 0" "pairs.mha $options --magnitude"
    differ $command --dims "v.raw $options --type uint8 --dims 20,432,1" "v.raw $options --type uint8 --dims 40,216,1"
    differ $command --type "v.raw $options --dims 20,432,1 --type uint8" "v.raw $options --dims 20,216,1 --type uint16"
    differ $command --endian "v.raw $options --dims 20,216,1 --type uint16" "v.raw $options --dims 20,216,1 --type uint16 --endian big"
    effect $command "v.raw $options --dims 20,432,1 --type uint8" --spacing 1,2,3
    effect $command "hills.pgm $options" --threshold 5
    effect $command "hills.pgm $options" --error 5
    effect $command "hills.pgm $options --error 5" --collapse
    effect $command "hills.pgm $options" --max-triangles 900
    effect $command "hills.pgm $options" -o kept/x.vtp
    effect $command "hills.pgm $options" --output kept/x.vtp
    effect $command "hills.pgm $options $keep" --outlines
    effect $command "hills.pgm $options $keep" --elements
    encoding $command "hills.pgm $options"
    void $command 'is about what is kept' "hills.pgm $options" --outlines
    effect $command "hills.pgm $options $keep --threshold 0.3" --indicator visual
    effect $command "hills.pgm $options $keep --threshold 3" --blend 2
    void $command 'needs a --threshold' "hills.pgm $options" --indicator visual
    void $command 'needs a --threshold' "hills.pgm $options" --blend 2
    effect $command "hills.pgm $options" --lens ball:9,9,0,3
    effect $command "hills.pgm $options --lens ball:9,9,0,3" --finest 4
    effect $command "hills.pgm $options --lens ball:9,9,0,3 --slope 9" --coarsest 2
    effect $command "hills.pgm $options --lens ball:9,9,0,3" --slope 3
    sed 's/@/A/g' hills.pgm >next.pgm
    cp next.pgm last.pgm
    pair="hills.pgm next.pgm $options $keep"
    effect $command "$pair --time 0.5" --times 0,2
    [ "$(result $command $pair --time 0.2)" != "$(result $command $pair --time 0.7)" ] || fail "$command --time"
    [ "$(result $command hills.pgm next.pgm last.pgm $options $keep --time 0.7)" != "$(result $command hills.pgm next.pgm last.pgm $options $keep --time 0.7 --cubic)" ] || fail "$command --cubic"
    run $command $pair --frames 3
    for name in time cubic frames json threads; do echo "$command --$name" >>covered; done
done
[ "$(result height hills.pgm --scale 1)" != "$(result height hills.pgm --scale 2)" ] || fail "height --scale"
echo "height --scale" >>covered
effect surface quads.nestgrid --colour-tolerance 1e-4

# Curved cells.
declare -A curved=([isosurface]='shell.vtu --value 1.6' [band]='shell.vtu --low 1.2 --high 1.7'
    [slice]='shell.vtu --plane 0.5,0.7,0.4,0.3,0.2,1' [boundary]=shell.vtu [isolines]='ring.vtu --count 3'
    [height]='ring.vtu --scale 1' [surface]=ring.vtu)
for command in "${!curved[@]}"; do
    effect $command "${curved[$command]} --field radius --error 0.2" --position-error 0.01
done
void isosurface 'is for curved cells' "solution.vtu --field u --value 0.3 --error 0.2" --position-error 0.01
void slice 'is for curved cells' "$raw --axis z --at 9" --position-error 0.01

# Probes.
printf '1,2,3\n4,5,6\n' >points.csv
[[ "$(result probe $raw --points points.csv)" != refused:* ]] && echo "probe --points" >>covered
effect probe "$raw --line 0,0,0,9,9,9" --count 7
echo "probe --line" >>covered
void probe 'is for --line' "$raw --points points.csv" --count 7
effect probe "$raw --line 0,0,0,9,9,9" -o kept/x.csv
effect probe "$raw --line 0,0,0,9,9,9" --output kept/x.csv

# Hierarchies. --levels, --max-volume and others are for some families and formats.
mesh="$cube --family bisection --field x*x -o kept/x.nestgrid"
effect mesh "$mesh" --field y
effect mesh "$mesh" --tolerance 0.01
effect mesh "$mesh --tolerance 0.001" --levels 3
effect mesh "$mesh" --times 0,1
effect mesh "$mesh" --refine 2
effect mesh "$mesh" --max-volume 0.01
effect mesh "$mesh" --encode
effect mesh "$mesh" --encode-within 0.1
refused 1 'more than 3' mesh $cube --family bisection -o x.nestgrid --max-elements 3 && echo "mesh --max-elements" >>covered
refused 1 'within 1e-06 seconds' mesh $cube --family bisection -o x.nestgrid --read-limit 1e-6 && echo "mesh --read-limit" >>covered
prisms="plane.off --family prism --layers 1 -o kept/x.nestgrid"
effect mesh "$prisms" --direction 0.1,0,1
[ "$(result mesh $prisms)" != "$(result mesh plane.off --family prism --layers 2 -o kept/x.nestgrid)" ] || fail "mesh --layers"
[ "$(result mesh $mesh)" != "$(result mesh ${mesh/bisection/red-green})" ] || fail "mesh --family"
effect mesh "quad.obj --family octree --field (x^2+y^2)^0.1 --tolerance 0.02 -o kept/x.nestgrid" --unbalanced
for name in layers family output json; do echo "mesh --$name" >>covered; done
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 1e-9\nv 1 1 0\nv 0 1 1e-9\nf 1 2 3\nf 4 5 6\n' >apart.obj
effect mesh "apart.obj --family bisection -o kept/x.nestgrid" --weld 1e-6
void mesh 'is negative' "$mesh" --weld -1
void mesh 'limits --tolerance' "$mesh" --levels 3
void mesh 'for --family octree' "$mesh" --unbalanced
void mesh 'for .poly and .smesh' "plane.off --family bisection -o kept/x.nestgrid" --max-volume 1
void mesh 'for --family prism' "$mesh" --layers 1
void mesh 'that of --layers' "$mesh" --direction 0,0,1
void mesh 'need a --field' "plane.off --family bisection -o kept/x.nestgrid" --encode
pack="first.nestgrid second.nestgrid -o kept/x.nestgrid"
effect pack "$pack" --times 0,3
effect pack "$pack" --encode
effect pack "$pack" --encode-within 0.1
for name in output json; do echo "pack --$name" >>covered; done

for command in isosurface band slice isolines height surface boundary probe info mesh pack; do
    "$program" $command --help-all >help-all
    for option in $(grep -oE -e '^  (-.,)?--[a-z-]+' help-all | grep -oE -e '--[a-z-]+'); do
        case $option in --help | --help-all) continue ;; esac
        # The options of pictures have a test of their own.
        [ "$(awk '/^[A-Z]/ { group = $1 } $1 ~ /'"$option"'$/ { print group; exit }' help-all)" = Picture: ] && continue
        grep -qxF -e "$command $option" covered || fail "nothing tries '$command $option'"
    done
done

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
