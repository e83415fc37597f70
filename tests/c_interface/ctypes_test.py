#!/usr/bin/env python3
"""krepl.h from Python's ctypes: structs and functions are read from the header itself, results come from a formula.

usage: ctypes_test.py LIBRARY HEADER
"""
import ctypes
import math
import re
import subprocess
import sys

TYPES = {"double": ctypes.c_double, "size_t": ctypes.c_size_t, "int32_t": ctypes.c_int32, "uint32_t": ctypes.c_uint32,
         "int64_t": ctypes.c_int64, "krepl_status": ctypes.c_int32, "void": None, "const char*": ctypes.c_char_p,
         "krepl_progress": ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_double, ctypes.c_void_p)}


def read_header(path):
    text = re.sub(r"/\*.*?\*/", "", open(path).read(), flags=re.S)
    structs = {}
    for body, name in re.findall(r"typedef struct \w+ \{(.*?)\} (\w+);", text, re.S):
        fields = [(member.strip(), TYPES[kind]) for kind, members in re.findall(r"(\w+)\s+([^;]+);", body)
                  for member in members.split(",")]
        structs[name] = type(name, (ctypes.Structure,), {"_fields_": fields})
    functions = {}
    for returned, name, arguments in re.findall(r"KREPL_API ([\w ]+?\*?)\s+(\w+)\((.*?)\);", text, re.S):
        functions[name] = (returned.strip(), [a.strip() for a in arguments.split(",") if a.strip() != "void"])
    return structs, functions


def type_of(declaration):
    """An argument's or result's type; every handle, array and place for a result is an address."""
    if declaration in TYPES:
        return TYPES[declaration]
    if "*" in declaration:
        return ctypes.c_void_p
    return TYPES[declaration.rsplit(" ", 1)[0]]


def load(library_path, header):
    library = ctypes.CDLL(library_path)
    structs, functions = read_header(header)
    assert len(functions) > 30 and len(structs) == 4, (len(functions), sorted(structs))
    for name, (returned, arguments) in functions.items():
        function = getattr(library, name)  # AttributeError: declared and not exported
        function.restype = type_of(returned)
        function.argtypes = [type_of(a) for a in arguments]
    return library, structs, set(functions)


def exported(library_path):
    text = subprocess.run(["nm", "-D", "--defined-only", library_path], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1] for line in text.splitlines() if line.split()[-1].startswith("krepl_")}


def main():
    library, structs, declared = load(sys.argv[1], sys.argv[2])
    assert exported(sys.argv[1]) == declared, exported(sys.argv[1]) ^ declared
    context = library.krepl_context_create()
    builder, network, zone = library.krepl_builder_create(), ctypes.c_void_p(), ctypes.c_void_p()
    line = (ctypes.c_double * 4)(0, 0, 3, 4)
    assert library.krepl_builder_add_line(context, builder, line, 2, 2**40) == 0
    assert library.krepl_network_build(context, builder, ctypes.byref(network)) == 0
    library.krepl_builder_destroy(builder)

    fractions = []
    progress = TYPES["krepl_progress"](lambda fraction, user: fractions.append(fraction) or 0)
    assert library.krepl_context_set_progress(context, progress, None) == 0
    options = structs["krepl_zone_options"](ctypes.sizeof(structs["krepl_zone_options"]), 2)
    assert library.krepl_zone_compute(context, network, ctypes.byref(options), ctypes.byref(zone)) == 0
    assert all(0 <= f <= 1 for f in fractions)
    assert math.isclose(library.krepl_zone_area(zone), 20 + 4 * math.pi, rel_tol=1e-12)
    count = library.krepl_zone_piece_count(zone)
    pieces = (structs["krepl_piece"] * count)()
    assert library.krepl_zone_pieces(context, zone, 0, count, pieces, ctypes.sizeof(structs["krepl_piece"])) == 0
    assert sorted(p.kind for p in pieces) == [0, 0, 1, 1] and all(p.feature == 2**40 for p in pieces)
    assert {(p.center_x, p.center_y) for p in pieces if p.kind == 1} == {(0, 0), (3, 4)}
    library.krepl_zone_destroy(zone)

    options.radius = -1
    assert library.krepl_zone_compute(context, network, ctypes.byref(options), ctypes.byref(zone)) == 1 and not zone.value
    assert b"radius" in library.krepl_context_message(context)
    assert library.krepl_zone_compute(context, None, ctypes.byref(options), ctypes.byref(zone)) == 1

    profile = ctypes.c_void_p()
    assert library.krepl_profile_compute(context, line, 2, 1, ctypes.byref(profile)) == 0
    assert library.krepl_profile_piece_count(profile) == 5
    library.krepl_profile_destroy(profile)
    library.krepl_network_destroy(network)
    library.krepl_context_destroy(context)
    print("passed:", library.krepl_version().decode(), len(declared), "functions")


if __name__ == "__main__":
    main()
