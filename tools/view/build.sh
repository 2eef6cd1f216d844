#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing on Debian 12, and builds the program with its page in build/view.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/packages.sh
need_packages "${build_packages[@]}" "${view_packages[@]}"
cmake -S . -B build/view -G Ninja -D CMAKE_BUILD_TYPE=Release -D NESTGRID_VIEW=ON \
    -D NESTGRID_BUILD_TESTS=OFF -D NESTGRID_BUILD_EXAMPLES=OFF
cmake --build build/view --target nestgrid_program
echo "the program is build/view/tools/nestgrid"
