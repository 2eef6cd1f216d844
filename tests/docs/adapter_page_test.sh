#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Follows docs/write_an_adapter.md to the letter: installs this build to $HOME/nestgrid, with a temporary
# home, puts the page's blocks of cmake and C++ into an empty folder, runs its block of bash, and compares
# what that prints with its block of text.
# Arguments: the source folder, the build folder, the C++ compiler and its flags.
set -euo pipefail
page=$1/docs/write_an_adapter.md file=$1/docs/examples/own_grid.cpp build=$2
export CXX=$3 CXXFLAGS=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work/home
cmake --install "$build" --prefix "$HOME/nestgrid" >"$work/installed"
mkdir "$work/own_grid" && cd "$work/own_grid"

# The blocks of a language, one behind the other.
blocks() {
    awk -v fence="\`\`\`$1" '$0 == fence { inside = 1; next } /^```$/ { inside = 0 } inside' "$page"
}

fail() {
    echo "FAILED: $*"
    exit 1
}

blocks cmake >CMakeLists.txt
blocks cpp >own_grid.cpp
blocks bash >"$work/commands"
blocks text >"$work/expected"
diff <(tr -d ' \n' <own_grid.cpp) <(sed '1,/^$/{/^\/\//d}; /^\/\/ \[/d' "$file" | tr -d ' \n') >/dev/null ||
    fail "the blocks of the page are not the whole of $file"
bash -e "$work/commands" >"$work/printed" 2>&1 || fail "the commands end with an error: $(cat "$work/printed")"
tail -n "$(wc -l <"$work/expected")" "$work/printed" | diff "$work/expected" - || fail "the output is another one"
[ -s own_grid.obj ] || fail "own_grid.obj was not written"
echo "$(wc -l <own_grid.cpp) lines were compiled and run"
