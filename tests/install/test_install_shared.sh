#!/usr/bin/env bash
# Builds the core as a shared library, without the tools, and tests that installation like the ordinary one.
#
# usage: test_install_shared.sh SOURCE_DIRECTORY COMPILER
set -euo pipefail
source_dir=$1 compiler=$2
here=$(cd "$(dirname "$0")" && pwd)
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
cmake -S "$source_dir" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON -DKREPL_BUILD_TOOLS=OFF \
  -DKREPL_BUILD_TESTS=OFF -DCMAKE_CXX_COMPILER="$compiler" >"$build/log" || { cat "$build/log"; exit 1; }
cmake --build "$build" -j1 >"$build/log" || { cat "$build/log"; exit 1; }
"$here/test_install.sh" "$build" "$compiler"
