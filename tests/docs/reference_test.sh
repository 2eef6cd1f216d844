#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The list of all public functions is made without a warning, each public class and at least one
# overload of each public function has a docstring, and the search finds them. Constants and members of
# classes may be without: what members answer is written at the concept or class that asks for it.
# Arguments: the source folder, a folder to write to.
set -uo pipefail
cd "$1" || exit 1
rm -rf "$2" && mkdir -p "$2" || exit 1
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

{ cat docs/reference/Doxyfile && echo "OUTPUT_DIRECTORY = $2"; } | doxygen - >"$2/warnings" 2>&1 ||
    fail "doxygen ended with status $?"
functions=$2/html/search/functions
cat "$functions"_*.js >"$2/found" || fail "there is no search"

while IFS= read -r line; do
    case "$line" in
    *" of class "*"is not documented"* | *" of struct "*"is not documented"*) ;;
    *"Compound nestgrid::"*::*"is not documented"* | *"(variable) of "*"is not documented"*) ;;
    *"(function) of "*"is not documented"*)
        name=$(sed -E 's/.*Member ([^(]*)\(.*/\1/' <<<"$line")
        # A guide for template arguments, and an overload of a function with a docstring.
        [[ "$line" != *" -> "* ]] && ! grep -qF "['$name'," "$2/found" && fail "$line"
        ;;
    *"The following parameter"*) ;;
    "  parameter '"*) ;;
    *) fail "$line" ;;
    esac
done <"$2/warnings"
for name in isosurface slice check_grid nestgrid_isosurface; do
    grep -qF "['$name'," "$2/found" || fail "the search does not find $name"
done
[ $failures = 0 ] && echo "$(grep -oF "['../namespacenestgrid.html" "$2/found" | wc -l) functions"
exit $((failures > 0))
