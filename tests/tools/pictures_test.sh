#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The options about pictures: each has an effect or is refused, in every command that draws one.
# Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

surface=(isosurface v.vti --value 130 --threshold 20)
slice=(slice v.vti --axis z --at 17 --threshold 5)

refused 2 'size requires --image' "${surface[@]}" --size 300x200
refused 2 'axes requires --image' "${slice[@]}" --axes
for size in 300 x 300x 0x200 -3x200 300x200x100 99x200 300x8193 1e2x200 99999999999x200 ''; do
    refused 1 'is no size of a picture' "${surface[@]}" --image p.png --size "$size"
done
for colour in '' reddish '#12345' '#12345g' '#1234567'; do
    refused 1 'is no colour' "${surface[@]}" --image p.png --background "$colour"
done
refused 1 'is no view' "${surface[@]}" --image p.png --view above
refused 1 'position is where the focus is' "${surface[@]}" --image p.png --view 1,1,1,1,1,1
refused 1 'direction upwards' "${surface[@]}" --image p.png --view 0,0,1,0,0,0,0,0,1
for opacity in 0 -1 1.5 nan; do
    refused 1 'opacity is not a number' "${surface[@]}" --image p.png --opacity $opacity
done
refused 1 'colours has no effect: an isosurface' "${surface[@]}" --image p.png --colours magma
refused 1 'range has no effect: an isosurface' "${surface[@]}" --image p.png --range 0,1
refused 1 'is no colour map: .*viridis' "${slice[@]}" --image p.png --colours rainbow
for range in 1,0 1,1 1 nan,1 0,1,2 ''; do
    refused 1 'is no range' "${slice[@]}" --image p.png --range "$range"
done
refused 1 'scale-bar has no length in --perspective' "${slice[@]}" --image p.png --scale-bar mm --perspective
refused 1 'names no known format, which is .png' "${slice[@]}" --image p.vtp

command -v Xvfb >/dev/null || exit $((failures > 0))

# Each option changes the picture.
options=(--image p.png --size 240x200)
differs() {
    run "$@" "${options[@]}"
    cmp -s p.png plain.png && fail "$*: no effect"
}
plain() {
    run "$@" "${options[@]}"
    mv p.png plain.png
}
common=("--background #203040" "--background transparent" "--view right" "--view 10,70" "--view 0,0,200,5,12,17"
    "--perspective --view 30,30" "--opacity 0.4" "--title word" --axes "--scale-bar mm" --orientation --detail)
coloured=("--colours magma" "--colours viridis_r" "--range 0,300")
for command in surface slice; do
    declare -n arguments=$command
    plain "${arguments[@]}"
    for option in "${common[@]}"; do
        # shellcheck disable=SC2086
        differs "${arguments[@]}" $option
    done
done
for option in "${coloured[@]}"; do
    # shellcheck disable=SC2086
    differs "${slice[@]}" $option
done
differs "${slice[@]}" --outlines
run "${slice[@]}" --image p.png --size 300x200
cmp -s p.png plain.png && fail "--size: no effect"
differs "${slice[@]}" --with-isosurface 130
differs "${slice[@]}" --threshold 30

# Every command draws one.
{
    printf 'P5\n9 7\n255\n'
    for y in 0 1 2 3 4 5 6; do
        for x in 0 1 2 3 4 5 6 7 8; do printf "\\$(printf %o $((20 + 2 * x + y)))"; done
    done
} >ramp.pgm
for command in "boundary v.vti --threshold 20" "isolines v.vti --axis x --at 4 --count 30 --threshold 5" \
    "isolines v.vti --on-surface 130 --by x+y --count 5 --threshold 5" "height ramp.pgm --scale 0.3 --outlines" \
    "surface ramp.pgm --threshold 1" "isolines ramp.pgm --values 25,31"; do
    # shellcheck disable=SC2086
    plain $command
    # shellcheck disable=SC2086
    differs $command --axes
done

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
