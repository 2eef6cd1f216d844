#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# What a serial program needs to run on ranks: at most 12 lines more, and as many lines more and
# other ones as docs/distributed.md says. Comments are not counted. Argument: the source folder.
set -euo pipefail
cd "$1/docs"
code() { sed 's,//.*,,; s/ *$//' "examples/$1.cpp" | grep -v '^$'; }
changes=$(diff <(code p4est_serial) <(code p4est_ranks) || true)
# Each place where they differ, from its line without < or >.
read -r more other < <(awk '
    function count() { more += new > old ? new - old : 0; other += new < old ? new : old }
    /^[0-9]/ { count(); new = old = 0 }
    /^>/ { ++new }
    /^</ { ++old }
    END { count(); print more + 0, other + 0 }' <<<"$changes")
echo "$more lines more, $other others"
[ "$more" -le 12 ] || { echo "these are more than 12"; exit 1; }
grep -q "it has $more lines more, and $other others" distributed.md || {
    echo "docs/distributed.md says otherwise"
    exit 1
}
