# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# How tests of the program read what it prints.

# value NAME: the fact of this name in the file `out`, or the column of this name in a table of it,
# one line for each row. Tables follow an empty line, and begin with the names of their columns.
value() {
    awk -v name="$1" '
        NF == 0 {
            table = 1
            column = 0
            if (getline > 0 && !seen) for (i = 1; i <= NF; ++i) if ($i == name) column = i
            seen = seen || column
            next
        }
        table { if (column) print $column; next }
        $1 == name { print $2 }' out
}
# What the file `out` tells, but the files that were written.
facts() { grep -v '^wrote' out | grep .; }
