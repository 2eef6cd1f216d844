# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# declarations.py <module.f90> <out.c> <out.f90> <header.h>...: compares what the headers declare with
# what the Fortran module does, by name, order and kind, and writes a program in two parts that
# compares sizes, offsets and numbers as the compilers have them.
import re
import sys


def read_header(text):
    """Members of structs, arguments of functions (name, by value) and names of numbers."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    structs, functions = {}, {}
    for name, body in re.findall(r"typedef struct (\w+) \{(.*?)\} \1;", text, re.S):
        members = [" ".join(m.split()) for m in body.split(";") if m.strip()]
        structs[name] = [
            (re.search(r"\(\*(\w+)\)\(", m) or re.search(r"(\w+)(?:\[\w+\])*$", m))[1] for m in members
        ]
    for name, arguments in re.findall(r"^(?:int|void) (\w+)\(([^;{]*?)\);", text, re.S | re.M):
        functions[name] = [
            (re.search(r"(\w+)(?:\[\w+\])*$", a.strip())[1], "*" not in a and "[" not in a)
            for a in arguments.split(",")
        ]
    numbers = []
    for body in re.findall(r"enum \{(.*?)\};", text, re.S):
        numbers += [n.split("=")[0].strip() for n in body.split(",") if n.strip()]
    numbers += re.findall(r"#define (NESTGRID_\w+) +\S", text)
    return structs, functions, numbers


def read_module(text):
    text = re.sub(r"!.*", "", text)
    text = re.sub(r"&\s*\n\s*", "", text)
    structs, functions = {}, {}
    for name, body in re.findall(r"type, bind\(c\) :: (\w+)\n(.*?)end type", text, re.S):
        structs[name] = re.findall(r":: (\w+)", body)
    declared = r"(?:function|subroutine) (\w+)\(([^)]*)\) *bind\(c, name=\"(\w+)\"\)(.*?)end (?:function|subroutine)"
    for name, arguments, bound, body in re.findall(declared, text, re.S):
        by_value = set(re.findall(r"^(?!.*c_ptr).*, value :: (\w+)", body, re.M))
        functions[bound] = [(a.strip(), a.strip() in by_value) for a in arguments.split(",")]
        if name != bound:
            sys.exit(f"the function {name} of the module is bound to {bound}")
    return structs, functions, re.findall(r"parameter :: (NESTGRID_\w+)", text)


def compare(what, in_c, in_fortran):
    """Ends where two dictionaries of lists differ, with a sentence."""
    for name in in_c:
        if name not in in_fortran:
            sys.exit(f"the module lacks the {what} {name}")
        if in_c[name] != in_fortran[name]:
            sys.exit(f"the {what} {name} is {in_c[name]} in C and {in_fortran[name]} in Fortran")
    for name in in_fortran:
        if name not in in_c:
            sys.exit(f"the headers lack the {what} {name}")


def main():
    module, c_file, fortran_file, *headers = sys.argv[1:]
    structs, functions, numbers = {}, {}, []
    for header in headers:
        more_structs, more_functions, more_numbers = read_header(open(header).read())
        structs |= more_structs
        functions |= more_functions
        numbers += more_numbers
    in_fortran = read_module(open(module).read())
    compare("type", structs, in_fortran[0])
    compare("function", functions, in_fortran[1])
    compare("set", {"of numbers": numbers}, {"of numbers": in_fortran[2]})
    if len(structs) < 10 or len(functions) < 10 or len(numbers) < 15:
        sys.exit("the headers were not understood")

    rows, fortran = [], []
    for name, members in structs.items():
        rows.append((f"the size of {name}", f"sizeof({name})"))
        fortran.append(("c_sizeof(%s_)" % name))
        for member in members:
            rows.append((f"the place of {member} in {name}", f"offsetof({name}, {member})"))
            fortran.append(f"place(c_loc({name}_%{member}), c_loc({name}_))")
    for number in numbers:
        rows.append((number, f"(uint64_t){number}"))
        fortran.append(f"int({number}, c_int64_t)")
    with open(c_file, "w") as out:
        for header in headers:
            out.write(f"#include <nestgrid/{header.split('/nestgrid/')[-1]}>\n")
        out.write("#include <stdio.h>\n\nvoid in_fortran(int64_t* out);\n\n")
        out.write("static const struct { const char* name; uint64_t value; } in_c[] = {\n")
        out.writelines(f'    {{"{name}", {value}}},\n' for name, value in rows)
        out.write("};\n\nint main(void) {\n    static int64_t other[%d];\n    int failures = 0;\n" % len(rows))
        out.write("    in_fortran(other);\n    for (int i = 0; i < %d; ++i) {\n" % len(rows))
        out.write("        const uint64_t c = in_c[i].value;\n        const uint64_t f = (uint64_t)other[i];\n")
        # Fortran has no unsigned numbers: 32 bits of ones are -1 there.
        out.write("        if (c == f || (c == UINT32_MAX && f == UINT64_MAX)) continue;\n        ++failures;\n")
        out.write('        printf("%s is %llu in C and %llu in Fortran\\n", in_c[i].name,\n')
        out.write("               (unsigned long long)c, (unsigned long long)f);\n    }\n")
        out.write("    return failures > 0;\n}\n")
    with open(fortran_file, "w") as out:
        out.write("subroutine in_fortran(out) bind(c)\n    use, intrinsic :: iso_c_binding\n    use nestgrid\n")
        out.write(f"    implicit none\n    integer(c_int64_t), intent(out) :: out({len(rows)})\n")
        out.writelines(f"    type({name}), target :: {name}_\n" for name in structs)
        out.writelines(f"    out({i + 1}) = {value}\n" for i, value in enumerate(fortran))
        out.write("contains\n    integer(c_int64_t) function place(member, whole)\n")
        out.write("        type(c_ptr), intent(in) :: member, whole\n")
        out.write("        place = transfer(member, 0_c_intptr_t) - transfer(whole, 0_c_intptr_t)\n")
        out.write("    end function place\nend subroutine in_fortran\n")


main()
