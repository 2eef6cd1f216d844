#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds everything, the program, the solvers' adapters, Python and the page included, with each of
# the presets asan, tsan and tidy, and runs the tests of the first two. Ends with one line a preset:
# what it did and how long it took. Arguments name presets; without any, all three run.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/packages.sh
need_packages "${build_packages[@]}" "${test_packages[@]}" "${picture_packages[@]}" \
    "${python_packages[@]}" "${python_test_packages[@]}" "${view_packages[@]}" clang-tidy

# OpenMPI keeps memory in plugins that it unloads, so that nobody can name who leaks.
# What cannot be allocated throws std::bad_alloc, as it does without the sanitizers.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS="halt_on_error=1:allocator_may_return_null=1:suppressions='$PWD/tests/tsan.supp'"
# deal.II's own threads hand on work by libraries without the sanitizer, and so does the executor by
# oneTBB; what that runs is run by plain threads in other tests.
export DEAL_II_NUM_THREADS=1
left_out=(--exclude-regex '^TbbExecutor')
presets=("$@")
[ ${#presets[@]} -gt 0 ] || presets=(asan tsan tidy)
report=()
status=0
for preset in "${presets[@]}"; do
    begin=$SECONDS
    outcome=passed
    {
        cmake --preset "$preset" && cmake --build --preset "$preset" &&
            case $preset in
                tsan) ctest --preset tsan --parallel "$(nproc)" "${left_out[@]}" ;;
                asan) ctest --preset asan --parallel "$(nproc)" ;;
            esac
    } || { outcome=failed; status=1; }
    report+=("$preset $outcome in $((SECONDS - begin)) s")
done
printf '%s\n' "${report[@]}"
exit "$status"
