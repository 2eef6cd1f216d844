#!/bin/bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The recipes for Debian and Spack agree with what is built: the packages of tools/packages.sh, all
# optional components, and the version.
#     recipes_test.sh <source folder>
set -euo pipefail
cd "$1"
failures=0
fail() {
    echo "$*"
    failures=$((failures + 1))
}

. tools/packages.sh
# Debian's own tools, and what every build has or nobody but developers needs.
only_in_recipe=" debhelper-compat dh-python "
not_in_recipe=" g++ python3-pip python3-venv "
known=" ${build_packages[*]} ${test_packages[*]} ${python_packages[*]} "
recipe=" $(sed -n '/^Build-Depends:/,/^[A-Z]/ s/^ \([^ ,]*\).*/\1/p' debian/control | tr '\n' ' ')"
for package in $recipe; do
    [[ $known$only_in_recipe == *" $package "* ]] ||
        fail "debian/control needs $package, which tools/packages.sh does not install"
done
for package in "${build_packages[@]}" "${python_packages[@]}"; do
    [[ $recipe$not_in_recipe == *" $package "* ]] ||
        fail "tools/packages.sh installs $package, which debian/control does not need"
done

# Components that a recipe does not name would depend on what else is installed.
spack=tools/spack/packages/nestgrid/package.py
components=$(sed -n 's/^nestgrid_optional(\([a-z0-9]*\) .*/\1/p' adapters/*/CMakeLists.txt)
[ "$(wc -w <<<"$components")" -ge 9 ] || fail "few components: $components"
debian=" $(sed -n 's/^components = //p' debian/rules) "
for component in $components python; do
    [[ $debian == *" ${component^^} "* ]] || fail "debian/rules does not name ${component^^}"
    sed -n '/def cmake_args/,$p' $spack | grep -q "\"$component\"" || fail "$spack does not name $component"
done

version=$(sed -n 's/^  VERSION //p' CMakeLists.txt)
grep -q "^nestgrid ($version-" debian/changelog || fail "debian/changelog does not begin with $version"
grep -q "version(\"$version\")" $spack || fail "$spack has not the version $version"
grep -q "nestgrid@$version " $spack || fail "$spack does not tell how to build $version"

[ -x debian/rules ] || fail "debian/rules is no program"
python3 -B -c 'import ast, sys; ast.parse(open(sys.argv[1]).read())' $spack || fail "$spack is no Python"
[ $failures = 0 ]
