#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Every "<!-- output of NAME -->" in the README and the pages stands before a block or a table: each of its
# lines must be printed by the example NAME. Arguments: the source folder, the folder of the examples.
set -uo pipefail
source=$1 examples=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
count=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# Lines "NAME<tab>line" that a page says are printed.
claims() {
    awk '/^<!-- output of [a-z_]+ -->$/ { name = $4; fenced = 0; next }
         name && /^```/ { if (fenced) name = ""; fenced = 1; next }
         name && !fenced && /^$/ { name = ""; next }
         name && NF { print name "\t" $0 }' "$1"
}

for page in "$source"/README.md "$source"/docs/*.md "$source"/docs/tutorial/*.md; do
    while IFS=$'\t' read -r name line; do
        count=$((count + 1))
        if [ ! -e "$work/$name" ]; then
            (cd "$work" && "$examples/$name" >"$work/$name" 2>&1) || fail "$name ended with an error"
        fi
        grep -qxF -e "$line" "$work/$name" || fail "${page##*/}: $name does not print '$line'"
    done < <(claims "$page")
done
[ $count -gt 20 ] || fail "only $count lines were found"
[ $failures = 0 ] && echo "$count lines are printed"
exit $((failures > 0))
