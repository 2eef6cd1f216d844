#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Commands of the README and the pages, each line of a block of code marked "sh":
#   nestgrid ...                        is run, with small files in the place of the reader's
#                                       its pictures in docs/figures are shown by the same page
#   cp /usr/share/mricron/templates/... names a volume of the Debian package mricron-data
#   build/release/docs/examples/figures is run, and makes a figure that the same page shows
#   mpirun -n N build/release/...       likewise, as the next
#   other programs of build/release     are programs of this build, with a test or benchmark of their own
#   build/release/tests/tools/make_plotfiles is run
#   build/python/bin/python SCRIPT      is run with the package of this build, if there is one and a
#                                       display, and makes a figure that the same page shows,
#                                       unless it is a benchmark, which has a test of its own
#   cmake -B ...                        configures
#   cmake, ctest --preset NAME          name a preset
#   doxygen docs/reference/Doxyfile     is run by the test "reference"
#   nestgrid view ...                   is started, and interrupted when it has printed its address
#   bash SCRIPT PICTURE ...             name a script, and pictures that the same page shows
# A file behind < is standard input; what follows > is left out.
# Any other command fails the test, and so does a figure that no command makes.
# Arguments: the source folder, the build folder, the program, the maker of volumes, Python if it has
# the package.
set -uo pipefail
source=$1 build=$2 program=$3 python=${5:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
ran=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# What the commands call head.nii.gz, brain.nii.gz, part.poly and own_grid.obj.
"$4" "$work" || exit 1
cp v.nii.gz head.nii.gz
cp v.nii.gz brain.nii.gz
cp "$source/docs/examples/grids/cube.poly" part.poly
"$build/docs/examples/own_grid" >out || exit 1

# The commands of a page, one a line.
commands() {
    awk '/^```sh$/ { inside = 1; next }
         /^```$/ { inside = 0 }
         inside && NF && $1 !~ /^#/ {
             if (sub(/\\$/, "")) { printf "%s", $0 } else { print }
         }' "$1"
}

# Runs a command, unless another page shows the same one.
run() {
    grep -qxF -e "$*" known && return
    echo "$*" >>known
    ran=$((ran + 1))
    "$@" >out 2>&1 || fail "$page: '$*' ended with status $?: $(cat out)"
}

# The page shows a figure.
shown_here() {
    local place
    place=$(realpath -m --relative-to="$(dirname "$page")" "$source/$1")
    grep -qF "($place)" "$page" || fail "$page does not show $1"
    echo "$1" >>made
}

# A figure, by its own command, which the page shows.
figure() {
    local name=$1 file=$2
    run "$build/docs/examples/figures" "$name" "$work/$name.png"
    [ -s "$name.png" ] || fail "$page: figure $name was not written"
    [ -s "$source/$file" ] || fail "$page: $file is missing"
    shown_here "$file"
}

# A figure that the program makes, which the page shows.
picture() {
    [ -s "$source/$1" ] || fail "$page: $1 is missing"
    shown_here "$1"
}

# Starts a server, which is to print its address and to end when it is interrupted.
served() {
    grep -qxF -e "$*" known && return
    echo "$*" >>known
    : >out  # so that nothing here is another command's
    "$@" --no-browser >>out 2>&1 &
    local server=$!
    until grep -q . out || ! kill -0 $server 2>/dev/null; do sleep 0.1; done
    # Not every build has the page.
    grep -q "NESTGRID_VIEW=ON" out && return
    ran=$((ran + 1))
    grep -qx "http://127.0.0.1:[0-9]*/[0-9a-f]*/" out || fail "$page: '$*' printed: $(cat out)"
    kill -INT $server && wait $server || fail "$page: '$*' did not end cleanly: $(cat out)"
}

nestgrid() {
    local arguments=() skip=
    for argument in "$@"; do
        [ -z "$skip" ] || { skip= && continue; }
        # Pictures need a display.
        if [ "$argument" = --image ] && ! command -v Xvfb >/dev/null; then skip=1 && continue; fi
        case "$argument" in
        docs/figures/*) picture "$argument" && argument=${argument##*/} ;;
        docs/examples/grids/*) argument=$source/$argument ;;
        esac
        arguments+=("$argument")
    done
    if [ "$1" = view ]; then
        served "$program" "${arguments[@]}"
    else
        run "$program" "${arguments[@]}"
    fi
}

# A figure that a script in Python makes, which the page shows.
python() {
    local start=(bash "$source/tests/adapters/python/with_display.sh" "$python") package=$build/adapters/python/package
    if [ "$1 $2" = "-m nestgrid.paraview" ]; then
        [ "$*" = "-m nestgrid.paraview paraview" ] && return
        [ "$3" = pvpython ] || fail "$page: '$*' is tested by nothing"
        start=(bash "$source/tests/adapters/python/paraview/pvpython.sh" "$source" "$package" "$python")
        set -- "${@:4}"
    fi
    [ -s "$source/$1" ] || fail "$page: there is no $1"
    if [[ "$1" == tests/benchmarks/* ]]; then
        grep -qF "/${1##*/}" "$source/tests/benchmarks/CMakeLists.txt" || fail "$page: no test runs $1"
        for file in "${@:2}"; do [[ "$file" != docs/figures/* ]] || picture "$file"; done
        return
    fi
    picture "$2"
    [ -n "$python" ] && command -v Xvfb >/dev/null || return 0
    PYTHONPATH=$package "${start[@]}" "$source/$1" "${2##*/}" >out 2>&1
    case $? in
    0) ran=$((ran + 1)) && [ -s "${2##*/}" ] || fail "$page: $1 wrote no ${2##*/}" ;;
    77) ;;
    *) fail "$page: $1 failed: $(cat out)" ;;
    esac
}

check() {
    local file
    case "$1" in
    nestgrid) nestgrid "${@:2}" ;;
    cp) [ "$2 $3" = "/usr/share/mricron/templates/ch2bet.nii.gz brain.nii.gz" ] || fail "$page: '$*'" ;;
    mpirun) check "${@:4}" ;;
    doxygen) [ "$2" = docs/reference/Doxyfile ] || fail "$page: '$*' is tested by nothing" ;;
    build/python/bin/python) python "${@:2}" ;;
    build/release/docs/examples/figures) figure "$2" "$3" ;;
    build/release/docs/examples/*)
        file=${1##*/}
        grep -q "_test(\(NAME \)\?example.$file\b\|^foreach.*\b$file\b" "$source/docs/examples/CMakeLists.txt" ||
            fail "$page: no test runs $1"
        ;;
    build/release/tests/tools/make_plotfiles) run "$build/${1#build/release/}" "${@:2}" ;;
    build/release/tests/benchmarks/*)
        [ -s "$source/tests/benchmarks/${1##*/}.cpp" ] || fail "$page: there is no $1"
        ;;
    bash)
        [ -s "$source/$2" ] || fail "$page: there is no $2"
        for file in "${@:3}"; do picture "$file"; done
        ;;
    cmake | ctest)
        case "$2 $3" in
        "--preset "* | "--build --preset")
            file=$3
            [ "$file" = --preset ] && file=$4
            grep -q "\"name\": \"$file\"" "$source/CMakePresets.json" || fail "$page: no preset $file"
            ;;
        "-B build/library") run cmake -S "$source" -B "$work/library" "${@:4}" ;;
        "--build build/library" | "--install build/library") ;;
        *) fail "$page: '$*' is tested by nothing" ;;
        esac
        ;;
    *) fail "$page: '$*' is tested by nothing" ;;
    esac
}

: >made
: >known
for page in "$source"/README.md "$source"/docs/*.md "$source"/docs/tutorial/*.md; do
    while IFS= read -r line; do
        # Standard output is looked at by other tests.
        line=${line%% > *}
        from=/dev/null
        [[ "$line" = *" < "* ]] && from=${line##* < } && line=${line%% < *}
        eval "words=($line)"
        check "${words[@]}" <"$from"
    done < <(commands "$page")
done
for file in "$source"/docs/figures/*.png; do
    grep -qxF "docs/figures/${file##*/}" made || fail "no page has the command that makes ${file##*/}"
    [ "$(stat -c %s "$file")" -lt 327680 ] || fail "${file##*/} is larger than 320 KiB"
done
[ $ran -gt 20 ] || fail "only $ran commands were found"
[ $failures = 0 ] && echo "$ran commands were run"
exit $((failures > 0))
