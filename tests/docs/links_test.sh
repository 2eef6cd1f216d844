#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Links of the README and the pages lead to files; headings that are linked to are there; the index
# names every page; the README has fewer than 100 lines. Argument: the source folder.
set -uo pipefail
cd "$1" || exit 1
failures=0
count=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# The anchors that a Markdown file offers, one a line.
anchors() {
    sed -nE 's/^#+ //p' "$1" | tr '[:upper:]' '[:lower:]' | sed -E "s/[^a-z0-9 _-]//g; s/ /-/g"
}

for page in README.md CHANGELOG.md CONTRIBUTING.md docs/*.md docs/tutorial/*.md; do
    while IFS= read -r target; do
        case "$target" in http*) continue ;; esac
        count=$((count + 1))
        file=${target%%#*}
        [ -n "$file" ] && file=$(dirname "$page")/$file || file=$page
        [ -e "$file" ] || fail "$page: $target leads nowhere"
        case "$target" in
        *#*) anchors "$file" | grep -qxF "${target#*#}" || fail "$page: $target has no such heading" ;;
        esac
    done < <(awk '/^```/ { inside = !inside } !inside' "$page" | grep -oE '\]\([^) ]+\)' | sed 's/^](//; s/)$//')
done
for page in docs/*.md docs/tutorial/*.md; do
    name=${page#docs/}
    [ "$name" = index.md ] || grep -qF "($name)" docs/index.md || fail "the index does not name $name"
done
[ "$(wc -l <README.md)" -lt 100 ] || fail "the README has 100 lines or more"
[ $count -gt 50 ] || fail "only $count links were found"
[ $failures = 0 ] && echo "$count links"
exit $((failures > 0))
