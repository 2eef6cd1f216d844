# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The beginning of a test of the program: a folder of its own with volumes in it, and functions.
# Arguments of the test: the program, the maker of volumes.

set -uo pipefail
. "$(dirname "$0")/values.sh"
program=$1
work=$(mktemp -d)
# Six faces of the unit cube.
cube=$(cd "$(dirname "$0")/../../docs/examples/grids" && pwd)/cube.poly
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
"$2" "$work" || exit 1
cd "$work" || exit 1
failures=0
prefix=(env)

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}
# within_budget COUNT ARGUMENTS...: what has just been drawn with --max-triangles COUNT and these
# ARGUMENTS has no more triangles, and has more at a threshold that is a little less.
within_budget() {
    local most=$1 count found
    shift
    found=$(value threshold)
    count=$(grep -ow segments out | head -1)
    count=${count:-triangles}
    [ "$(value "$count")" -le "$most" ] || fail "$*: $(value "$count") $count, not $most"
    awk -v t="$found" 'BEGIN { exit !(t > 0) }' || fail "$*: threshold $found"
    cp out out.kept
    "$program" "$@" --threshold "$(awk -v t="$found" 'BEGIN { print 0.997 * t }')" >out 2>err ||
        fail "$*: $(cat err)"
    [ "$(value "$count")" -gt "$most" ] || fail "$*: $(value "$count") $count below $found, too"
    mv out.kept out
}

# run ARGUMENTS...: ends well, and says nothing on stderr; what it prints is in the file `out`.
run() {
    "$program" "$@" >out 2>err || fail "$*: $(cat err)"
    [ ! -s err ] || fail "$*: wrote to standard error: $(cat err)"
}

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

