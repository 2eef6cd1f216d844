#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds small programs on the installed package as users do, one line a case. A second build, with
# the other kind of library, hidden symbols and a folder for libraries as Debian has it, is made of
# the objects of the first.
# Arguments: the source and the build folder, one to work in, the compilers of C++ and C, and flags.
set -euo pipefail
source=$1 build=$2 work=$3 cxx=$4 cc=$5 flags=$6
here=$source/tests/consumer/matrix
sphere=$source/tests/consumer/project/sphere.cpp
c_grid=$source/docs/examples/c_grid.c
rm -rf "$work"
# Users have such folders.
prefix="$work/a larger prefix größer"
mkdir -p "$prefix" && cd "$work"
failed=0

report() {
    printf '%-6s %3d s  %s\n' "$1" "$((SECONDS - begin))" "$2"
}

# fine <case> <command> ...: the command succeeds.
fine() {
    local name=$1 begin=$SECONDS
    shift
    if ("$@") >log 2>&1; then
        report ok "$name"
    else
        report FAILED "$name"
        tail -n 30 log
        failed=1
    fi
}

# refused <case> <text> <command> ...: the command fails and says the text.
refused() {
    local name=$1 text=$2 begin=$SECONDS
    shift 2
    if ! ("$@") >log 2>&1 && grep -q -- "$text" log; then
        report ok "$name"
    else
        report FAILED "$name, which must say '$text'"
        tail -n 30 log
        failed=1
    fi
}

value() {
    sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"
}

second_build() {
    local shared=ON without=()
    [ "$first" = shared ] && shared=OFF
    for name in CGAL DEALII DUNE OPENMESH P4EST PYTHON TBB TETGEN VTK VIEW BUILD_TESTS BUILD_TOOLS \
        BUILD_EXAMPLES; do
        without+=(-D "NESTGRID_$name=OFF")
    done
    cmake -S "$source" -B second -G Ninja -D CMAKE_CXX_COMPILER="$cxx" -D CMAKE_C_COMPILER="$cc" \
        -D CMAKE_CXX_FLAGS="$flags" -D CMAKE_BUILD_TYPE="$(value CMAKE_BUILD_TYPE)" \
        -D CMAKE_UNITY_BUILD="$(value CMAKE_UNITY_BUILD)" -D BUILD_SHARED_LIBS="$shared" \
        -D NESTGRID_WIDE_KEYS="$(value NESTGRID_WIDE_KEYS)" \
        -D CMAKE_CXX_VISIBILITY_PRESET=hidden -D CMAKE_VISIBILITY_INLINES_HIDDEN=ON \
        -D CMAKE_INSTALL_LIBDIR=lib/x86_64-linux-gnu -D CMAKE_INSTALL_PREFIX=/opt/nestgrid \
        -D CMAKE_CXX_COMPILER_LAUNCHER="bash;$here/reuse.sh;$build" "${without[@]}" &&
        cmake --build second && DESTDIR=$work/staged cmake --install second &&
        mv staged/opt/nestgrid "$prefix/$other"
}

# with <static|shared> <compiler> <program> <argument> ...: compiles by pkg-config, and runs.
with() {
    local kind=$1 compiler=$2 program=$3 libdir arguments=()
    shift 3
    libdir=$(dirname "$(find "$prefix/$kind" -name nestgrid.pc -print -quit)")
    eval "arguments=($(PKG_CONFIG_PATH=$libdir pkg-config --cflags --libs nestgrid))"
    # shellcheck disable=SC2086 # flags are several words
    "$compiler" $flags "$@" "$program" "${arguments[@]}" -Wl,-rpath,"$(dirname "$libdir")" -lm \
        -o program && { [ "${1-}" = -shared ] || ./program; }
}

plugins() {
    with "$1" "$cxx" "$here/refusal.cpp" -shared -fPIC -std=c++20 -D NESTGRID_PLUGIN "${@:2}" &&
        cp program one.so && cp program two.so && "$cxx" "$here/host.cpp" -std=c++20 -o host -ldl &&
        ./host ./one.so ./two.so
}

# configured <static|shared> <project> <folder> <argument> ...
configured() {
    local kind=$1 project=$2 folder=$3
    shift 3
    cmake -S "$here/$project" -B "$folder" -G Ninja -D CMAKE_PREFIX_PATH="$prefix/$kind" \
        -D CMAKE_CXX_COMPILER="$cxx" -D CMAKE_C_COMPILER="$cc" -D CMAKE_CXX_FLAGS="$flags" "$@"
}

alone() {
    configured "$first" alone "alone_$1" -D component="$1" && cmake --build "alone_$1" -j 1 &&
        "./alone_$1/alone"
}

in_c() {
    configured "$1" c "c_$1" -D program="$c_grid" && cmake --build "c_$1" && "./c_$1/c_grid"
}

twice() {
    configured "$1" twice "twice_$1" -G "Ninja Multi-Config" -D program="$sphere" &&
        cmake --build "twice_$1" --config RelWithDebInfo &&
        "./twice_$1/a/RelWithDebInfo/first" && "./twice_$1/b/RelWithDebInfo/second"
}

# The library is not built again: the object alone, and the flags it would be built with.
parent() {
    configured "$first" parent parent -D nestgrid="$source" -D program="$sphere" \
        -D NESTGRID_BUILD_TESTS=OFF "${without_solvers[@]}" &&
        ninja -C parent CMakeFiles/sphere.dir"$sphere".o &&
        grep -q 'NAMESPACE nestgrid::\|nestgrid::nestgrid' parent/CMakeFiles/Export/*/parent.cmake
}
without_solvers=()
for name in CGAL DEALII DUNE OPENMESH P4EST TBB TETGEN VTK; do
    without_solvers+=(-D "NESTGRID_$name=OFF")
done

# What is a weak symbol in an object without being defined there pulls nothing out of an archive.
no_weak_symbols() {
    for name in walk walk_functions walk_questions; do
        "$cxx" -std=gnu++20 -O1 -flto -fPIC -I "$source/interface" -I "$source/algorithms" \
            -c "$source/algorithms/walk/$name.cpp" -o "$name.o"
    done
    nm -C walk.o walk_functions.o walk_questions.o >symbols
    ! grep '^ *w .*nestgrid' symbols
}

fat_objects() {
    grep -q -- '^  FLAGS = .*-flto.*-fno-fat-lto-objects.* -ffat-lto-objects' parent/build.ninja
}

begin=$SECONDS
cmake --install "$build" --prefix "$work/installed" >log 2>&1 || { cat log; exit 1; }
first=static other=shared
[ -f "$(find installed -name 'libnestgrid*.a' -print -quit)" ] || first=shared other=static
mv installed "$prefix/$first"
report ok "install: $first, then moved"
fine "the other kind, symbols hidden by preset, DESTDIR, lib/x86_64-linux-gnu: $other" second_build

compilers=("$cxx")
for compiler in g++ clang++; do
    if ! command -v "$compiler" >/dev/null; then
        echo "skipped: $compiler is not installed"
    elif [ "$(command -v "$compiler")" != "$(command -v "$cxx")" ] &&
        [ "$(basename "$cxx")/$compiler" != "c++/g++" ]; then
        compilers+=("$compiler")
    fi
done
for kind in static shared; do
    for compiler in "${compilers[@]}"; do
        for standard in c++20 gnu++2b; do
            fine "$kind, $compiler, $standard, pkg-config" with $kind "$compiler" "$sphere" "-std=$standard"
        done
        fine "$kind, $compiler, -fno-rtti" with $kind "$compiler" "$sphere" -std=c++20 -fno-rtti
        fine "$kind, $compiler, hidden symbols, exceptions caught" with $kind "$compiler" \
            "$here/refusal.cpp" -std=c++20 -fvisibility=hidden -fvisibility-inlines-hidden
        fine "$kind, $compiler, the program under sanitizers" with $kind "$compiler" "$sphere" \
            -std=c++20 -fsanitize=address,undefined -fno-sanitize-recover=all
    done
    fine "$kind, NDEBUG and LTO in the program alone" with $kind "$cxx" "$sphere" -std=c++20 -O1 -D NDEBUG -flto
    fine "$kind, C by pkg-config" with $kind "$cc" "$c_grid"
    fine "$kind, a project of C alone" in_c $kind
    fine "$kind, two plugins" plugins $kind
    fine "$kind, two plugins of hidden symbols" plugins $kind -fvisibility=hidden
    fine "$kind, found three times, unity, precompiled, Ninja Multi-Config" twice $kind
    refused "$kind, _GLIBCXX_DEBUG" library_was_compiled_with_GLIBCXX_DEBUG \
        with $kind "$cxx" "$sphere" -std=c++20 -D _GLIBCXX_DEBUG
    refused "$kind, _GLIBCXX_USE_CXX11_ABI=0" library_was_compiled_with_GLIBCXX_USE_CXX11_ABI_0 \
        with $kind "$cxx" "$sphere" -std=c++20 -D _GLIBCXX_USE_CXX11_ABI=0
    refused "$kind, _GLIBCXX_SANITIZE_VECTOR" library_was_compiled_with_GLIBCXX_SANITIZE_VECTOR \
        with $kind "$cxx" "$sphere" -std=c++20 -D _GLIBCXX_SANITIZE_VECTOR -D __SANITIZE_ADDRESS__
    refused "$kind, wide keys" library_has_keys_of_128_bits \
        with $kind "$cxx" "$sphere" -std=c++20 -D NESTGRID_WIDE_KEYS
done
refused "C++17" "nestgrid needs C++20" with static "$cxx" "$sphere" -std=c++17
refused "-fno-exceptions" "compile without -fno-exceptions" with static "$cxx" "$sphere" -std=c++20 -fno-exceptions
refused "an unknown component" "without the component 'teapot'" alone teapot

fine "add_subdirectory: C++23, strict warnings are errors, installed with the parent" parent
if "$cxx" -v 2>&1 | grep '^gcc' >/dev/null; then
    fine "link-time optimisation: objects serve other linkers" fat_objects
    fine "link-time optimisation: no weak symbols" no_weak_symbols
fi
for file in "$prefix/$first"/lib*/cmake/nestgrid/nestgrid-*-targets.cmake; do
    name=$(basename "$file" -targets.cmake)
    fine "alone: ${name#nestgrid-}" alone "${name#nestgrid-}"
done
[ "$failed" = 0 ] && echo "all cases passed in $SECONDS s"
