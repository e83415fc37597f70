#!/usr/bin/env bash
# The installed package, seen by its users: installs a build into a temporary prefix, moves the prefix, then builds and
# runs a consumer through find_package and through pkg-config, and one in C, compiles every public header alone, and
# checks what the library and the program depend on.
#
# usage: test_install.sh BUILD_DIRECTORY COMPILER [COMPILER_FLAG...]
set -euo pipefail
build=$1 compiler=$2
shift 2
flags=("$@")
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
prefix=$scratch/moved

fail() { echo "FAILED: $*" >&2; exit 1; }

cmake --install "$build" --prefix "$scratch/installed" >/dev/null
mv "$scratch/installed" "$prefix"
library=$(find "$prefix" -name 'libkrepl.so' -o -name 'libkrepl.a')
[ "$(wc -w <<<"$library")" = 1 ] || fail "expected one library, found: $library"
library_dir=$(dirname "$library")
export LD_LIBRARY_PATH=$library_dir PKG_CONFIG_PATH=$library_dir/pkgconfig
echo "library: ${library#"$prefix"/}"

echo "consumer through find_package"
cmake -S "$here/consumer" -B "$scratch/consumer" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_CXX_FLAGS="${flags[*]}" -DCMAKE_PREFIX_PATH="$prefix" >"$scratch/log" || { cat "$scratch/log"; fail configure; }
cmake --build "$scratch/consumer" >"$scratch/log" || { cat "$scratch/log"; fail "build of the consumer"; }
"$scratch/consumer/consumer"

echo "consumer through pkg-config"
read -ra package < <(pkg-config --cflags --libs krepl)
"$compiler" -std=c++20 "${flags[@]}" "$here/consumer/consumer.cpp" -o "$scratch/by_pkg_config" "${package[@]}"
"$scratch/by_pkg_config"

echo "example in C through pkg-config"
"${CC:-cc}" -std=c99 -Wall -Wextra -Werror -pedantic-errors -c "$here/../../examples/05_zone_from_c.c" \
  -I"$prefix/include" -o "$scratch/from_c.o"
linker=${CC:-cc}  # a static library needs the C++ runtime, which the C++ compiler brings
[ "${library##*.}" = so ] || linker=("$compiler" "${flags[@]}")
"${linker[@]}" "$scratch/from_c.o" -o "$scratch/from_c" "${package[@]}" -lm
"$scratch/from_c" | grep -qF "area 61780.972, boundary 1371.239" || fail "example in C"

echo "public headers compile alone"
for header in "$prefix"/include/krepl/*.hpp; do
  "$compiler" -std=c++20 -Wall -Wextra -Werror -fsyntax-only -I"$prefix/include" -x c++ - \
    <<<"#include <krepl/$(basename "$header")>" || fail "$header"
done
for standard in c89 c99; do
  "${CC:-cc}" -std=$standard -Wall -Wextra -Werror -pedantic-errors -fsyntax-only -I"$prefix/include" -x c - \
    <<<"#include <krepl/krepl.h>" || fail "krepl.h as $standard"
done
headers() { (cd "$1" && printf "%s\n" ./*); }
[ "$(headers "$prefix/include/krepl")" = "$(headers "$here/../../include/krepl")" ] || fail "a header is missing"

echo "dependencies of the core"
object=$library
[ "${library##*.}" = so ] || object=$scratch/by_pkg_config
needed=$(readelf -d "$object" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
[ -n "$needed" ] || fail "no dynamic section in $object"
for name in $needed; do
  case $name in
    libtbb.so.* | libstdc++.so.* | libgcc_s.so.* | libquadmath.so.* | libm.so.* | libc.so.* | ld-linux*) ;;
    libkrepl.so.* | libasan.so.* | libubsan.so.* | libtsan.so.*) ;;
    *) fail "$(basename "$object") needs $name: the core may need oneTBB and the C++ runtime only" ;;
  esac
done
echo "$needed" | tr '\n' ' '; echo
grep -RlE '(gdal|ogr|geos|CGAL|boost)[^ ]*\.(h|hpp)[>"]' "$prefix/include" && fail "a public header needs another library"

program=$prefix/bin/krepl
if grep -qx 'KREPL_BUILD_TOOLS:BOOL=ON' "$build/CMakeCache.txt"; then
  echo "program, manual page, completion"
  version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
  "$program" --version | grep -F "$version" || fail "krepl --version does not say $version"
  "$program" --help >/dev/null
  gpl=$(ldd "$program" | grep -iE 'libCGAL|libgmt' || true)
  [ -z "$gpl" ] || fail "the program links to software under the GPL: $gpl"
  [ -s "$prefix/share/man/man1/krepl.1" ] || fail "no manual page"
  bash -c "source '$prefix/share/bash-completion/completions/krepl' && complete -p krepl" || fail "no completion"
fi
echo "passed"
