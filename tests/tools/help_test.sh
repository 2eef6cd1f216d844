#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# What the program says about itself: help, examples, what was probably meant, the manual page and
# completion. Arguments: the program, the maker of volumes.
. "$(dirname "$0")/functions.sh"

commands=$("$program" --help | awk '/^Commands:/ { inside = 1; next } !NF { inside = 0 } inside && /^  [a-z]/ { print $1 }')
[ "$(wc -w <<<"$commands")" -ge 12 ] || fail "commands: $commands"

# names FILE: the options that it names.
names() { grep -oE -e '--[a-z][a-z-]*' "$1" | sort -u; }
longest() { awk '{ if (length > most) most = length } END { print most }' "$1"; }
for command in "" $commands; do
    # A command that was left out of the build only says so.
    "$program" $command --help | grep -q NESTGRID_VIEW && continue
    "$program" $command --help >short || fail "$command --help"
    "$program" $command --help-all >all || fail "$command --help-all"
    [ "$(wc -l <short)" -le 45 ] || fail "$command --help has $(wc -l <short) lines"
    for file in short all; do
        [ "$(longest $file)" -le 80 ] || fail "$command, $file help: $(longest $file) columns"
    done
    [ "$(names short)" = "$(names all)" ] || fail "$command --help does not name all options"
    grep -qx 'Examples:' short && grep -q "^  nestgrid $command" short || fail "$command has no example"
    case $command in
    isosurface | band | slice | isolines | height | surface | boundary)
        [ "$(grep -c 'error_bound' short)" = 1 ] || fail "$command --help does not explain error_bound"
        ;;
    esac
    script -qc "stty cols 60; '$program' $command --help" terminal >typescript
    tr -d '\r' <typescript | grep -v '^  nestgrid\|^           ' >narrow
    [ "$(longest narrow)" -le 60 ] || fail "$command --help in 60 columns: $(longest narrow)"
done
rm -f short all narrow typescript terminal

# Every example runs.
cp v.nii.gz head.nii.gz && cp v.raw ct.raw && cp "$cube" part.poly
{
    printf 'P5\n65 65\n255\n'
    LC_ALL=C awk 'BEGIN { for (i = 0; i < 65 * 65; ++i) printf "%c", 64 + 50 * sin(i % 65 / 9) * cos(int(i / 65) / 7) }'
} >hills.pgm
for name in first second; do run mesh part.poly --family bisection --field x --refine 3 -o $name.nestgrid; done
for command in mesh pack "" $commands; do
    "$program" $command --help | awk '/^Examples:/ { inside = 1; next } !NF { inside = 0 }
        inside { if (sub(/\\$/, "")) printf "%s", $0; else print }'
done | sed 's/hills\.png/hills.pgm/; s/^ *nestgrid //' | grep -v '^view ' | awk '!seen[$0]++' >examples
[ "$(wc -l <examples)" -gt 12 ] || fail "examples: $(cat examples)"
while read -r example; do
    command -v Xvfb >/dev/null || example=$(sed 's/ --image [^ ]*//' <<<"$example")
    eval "words=($example)"
    "$program" "${words[@]}" >out 2>err || fail "example $example: $(cat err)"
    case "$example" in
    *" -o "* | *" --image "*) grep -q '^wrote ' out || fail "example $example wrote nothing: $(cat out)" ;;
    esac
done <examples

# What was probably meant.
meant() {
    local word=$1
    shift
    refused 2 "did you mean '$word'\?" "$@"
}
meant isosurface isosurfce v.vti
meant slice slcie v.vti
meant --value isosurface v.vti --vlaue 3
meant --max-triangles isosurface v.vti --value 3 --max-triangle 3
meant --indicator slice v.vti --axis z --at 1 --indicater visual
meant visual isosurface v.vti --value 3 --threshold 1 --indicator vizual
meant bisection mesh part.poly --family bisektion -o x.nestgrid
meant float32 info v.raw --dims 20,24,18 --type float
meant float64 info v.raw --dims 20,24,18 --type double
meant uint16 info v.raw --dims 20,24,18 --type unit16
meant little info v.raw --dims 20,24,18 --type uint8 --endian litle
refused 1 "no point data array 'ImageScalar', only 'ImageScalars': did you mean 'ImageScalars'\?" info v.vti --array ImageScalar
run mesh part.poly --family bisection --field x --field front -o two.nestgrid
refused 1 "only 'x', 'front': did you mean 'front'\?" isosurface two.nestgrid --array frnt --value 0
refused 1 "'head.nii.zg' does not exist: did you mean 'head.nii.gz'\?" info head.nii.zg
refused 1 "names no known format, which is .*: did you mean '.vtp'\?" isosurface v.vti --value 130 -o x.vpt
refused 2 "'v.vti' is no command but a file" v.vti
refused 2 'a command is missing'
refused 2 "has no option --qqqqqq \(" isosurface v.vti --qqqqqq
refused 2 "takes V,V,..., not 'abc'" isosurface v.vti --value abc
refused 2 'takes V,V,..., but nothing follows' isosurface v.vti --value
for list in 1,,2 ,1 1,; do
    for word in --value=$list "--value $list"; do
        refused 2 "--value: nothing is between two commas, or beside one, in '$list'" isosurface v.vti $word
    done
done
refused 2 "--times: nothing is between" isosurface v.vti v.vti --value 95 --times 0,,1
refused 2 '--at is given twice' slice v.vti --axis z --at 1 --at 2
refused 2 'takes X,Y,Z,NX,NY,NZ' slice v.vti --plane 1,2,3
refused 2 "value is required: the values of 'v.vti' are from [0-9.]+ to [0-9.]+, try --value [0-9]+ \(" isosurface v.vti
run isosurface v.vti --value "$("$program" isosurface v.vti 2>&1 | sed 's/.*--value \([0-9.]*\).*/\1/')"
[ "$(value triangles)" -gt 1000 ] || fail "the value that is advised shows $(value triangles) triangles"
refused 1 "'none.vti' does not exist" isosurface none.vti
refused 1 'has no place: give its coordinate, --at' slice v.vti --axis z

# Files that are none.
mkdir folder.vti && refused 1 "'folder.vti' is a folder" info folder.vti
for command in "info" "isosurface --value 1" "boundary" "probe --line 0,0,0,1,1,1"; do
    for name in none.vti none.nestgrid none.png; do
        refused 1 "'$name' does not exist" ${command%% *} $name $([ "${command#* }" = "$command" ] || echo ${command#* })
    done
done
for name in empty.vti empty.nestgrid empty.pgm empty.off; do
    : >$name
    if [ $name = empty.off ]; then
        refused 1 "'$name' is empty" mesh $name --family bisection -o x.nestgrid
    else
        refused 1 "'$name' is empty" info $name
    fi
done
if [ "$(id -u)" = 0 ] && command -v setpriv >/dev/null; then
    cp v.vti secret.vti && chmod 000 secret.vti && chmod 777 .
    prefix=(setpriv --reuid=65534 --clear-groups)
    refused 1 "'secret.vti' cannot be opened: Permission denied" info secret.vti
    prefix=(env)
fi
refused 1 "is a mesh without data: 'nestgrid mesh'" isosurface part.poly --value 1

# Endings in any case.
for name in v.vti v.mha v.nii v.nii.gz v.nrrd; do
    upper=$(tr a-z A-Z <<<"$name")
    cp $name "UPPER-$upper" && run info "UPPER-$upper"
done
cp hills.pgm HILLS.PGM && run info HILLS.PGM
cp first.nestgrid FIRST.NESTGRID && run info FIRST.NESTGRID && run isosurface FIRST.NESTGRID --value 0.5
for name in X.VTP X.STL X.PLY X.OBJ X.GLTF; do
    run isosurface v.vti --value 130 -o $name && [ -s $name ] || fail "$name was not written"
done
cp part.poly PART.POLY && run mesh PART.POLY --family bisection --field x -o Y.NESTGRID && run info Y.NESTGRID
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n' >PLANE.OFF
run mesh PLANE.OFF --family bisection --field x -o z.nestgrid

"$program" --version >out || fail "--version"
for word in '^nestgrid [0-9]' VTK TBB TetGen CGAL muParser GNU page:; do
    grep -q "$word" out || fail "--version does not say '$word': $(cat out)"
done

# The manual page names every command and option.
"$program" manual >nestgrid.1 || fail "manual"
sed 's/\\-/-/g' nestgrid.1 >plain
for command in $commands; do
    grep -q "^.SS $command\$" plain || fail "the manual has no section on $command"
    for name in $("$program" $command --help-all | grep -oE -e '^  (-.,)?--[a-z-]+' | grep -oE -e '--[a-z-]+'); do
        grep -qE -e "^.B (-.,)?$name" plain || fail "the manual does not describe $name"
    done
done
if command -v mandoc >/dev/null; then
    mandoc -T lint -W warning nestgrid.1 >lint 2>&1 || fail "mandoc: $(cat lint)"
fi

# Completion, by the function that bash itself calls.
complete_words() {
    bash -c 'source "$1" && read -ra made < <(complete -p nestgrid) && function=${made[-2]}
        COMP_WORDS=("${@:2}") COMP_CWORD=$(($# - 2)) && $function && echo "${COMPREPLY[@]}"' \
        bash nestgrid.bash "$@"
}
"$program" bash-completion >nestgrid.bash || fail "bash-completion"
completes() {
    local expected=$1
    shift
    [ "$(complete_words "$@")" = "$expected" ] || fail "'$*' is completed by '$(complete_words "$@")'"
}
completes "isosurface isolines" nestgrid iso
completes "--indicator" nestgrid isosurface v.vti --ind
completes "visual" nestgrid isosurface v.vti --indicator v
completes "visual" nestgrid isosurface v.vti --indicator = v
completes "red-green bisection octree prism" nestgrid mesh part.poly --family ""
rm -f head.vtp
completes "head.nii.gz" nestgrid isosurface head
completes "head.nii.gz" nestgrid isosurface -o head
completes "" nestgrid isosurface --value ""
if command -v zsh >/dev/null; then
    "$program" zsh-completion >_nestgrid && zsh -n _nestgrid || fail "zsh-completion"
    cat >try.zsh <<'END'
zmodload zsh/zpty
zpty shell 'zsh -f -i'
zpty -w shell "PROMPT=; fpath=($PWD \$fpath); autoload -Uz compinit; compinit -u -D; cd $PWD"
sleep 1
zpty -w -n shell $'nestgrid isosurface --indicator vis\t > completed; print done > finished\n'
for i in {1..50}; do [[ -e finished ]] && break; sleep 0.1; done
zpty -d shell
END
    printf 'echo "$*"\n' >nestgrid && chmod +x nestgrid
    PATH=$PWD:$PATH zsh -f try.zsh
    grep -q 'indicator visual' completed || fail "zsh completes: $(cat completed)"
fi

[ $failures = 0 ] && echo "all as it should be"
exit $((failures > 0))
