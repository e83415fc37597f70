#!/bin/sh
# The verb `krepl verify`: exit status and what it says. Usage: verify_verb_test.sh KREPL
krepl=$1
dir=$(mktemp -d) || exit 1
trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1
failed=0

# expect STATUS PATTERN COMMAND...: the exit status, and a line of either output that matches
expect() {
  status=$1 pattern=$2
  shift 2
  "$@" >out 2>&1
  got=$?
  if [ "$got" != "$status" ] || ! grep -q -e "$pattern" out; then
    echo "FAILED: $* gave $got (expected $status and '$pattern'):"
    cat out
    failed=1
  fi
}

printf 'LINESTRING (0 0, 10 0, 10 10)\nPOINT (30 5)\n' >in.wkt
printf 'LINESTRING (0 0, 10 0, 10 10)\n' >less.wkt
"$krepl" buffer in.wkt zone.wkt --radius 2 --quiet || failed=1
"$krepl" buffer in.wkt zone.gpkg --radius 1,2 --quiet || failed=1
"$krepl" buffer in.wkt zone.geojson --radius 2 --max-error 0.01 --quiet || failed=1

expect 0 '^sound' "$krepl" verify zone.wkt --against in.wkt --radius 2
expect 0 'area by strips' "$krepl" verify zone.wkt --against in.wkt --radius 2 --samples 1000
expect 0 'zone of radius 1:' "$krepl" verify zone.gpkg --against in.wkt
expect 0 'zone of radius 2:' "$krepl" verify zone.gpkg --against in.wkt
expect 0 '^sound' "$krepl" verify zone.gpkg --against in.wkt --radius 1,2
expect 0 '^sound' "$krepl" verify zone.geojson --against in.wkt --radius 2 --max-error 0.01
expect 1 'give --max-error' "$krepl" verify zone.geojson --against in.wkt --radius 2
expect 1 'is not the zone of radius 2.001' "$krepl" verify zone.wkt --against in.wkt --radius 2.001
expect 1 'is not the zone of radius 2' "$krepl" verify zone.wkt --against less.wkt --radius 2
"$krepl" buffer less.wkt less_zone.wkt --radius 2 --quiet || failed=1
expect 1 "input's sides on the boundary" "$krepl" verify less_zone.wkt --against in.wkt --radius 2
expect 1 'holds no zone of radius 3' "$krepl" verify zone.gpkg --against in.wkt --radius 1,2,3
expect 1 'which --radius does not name' "$krepl" verify zone.gpkg --against in.wkt --radius 2
expect 1 'nowhere.wkt' "$krepl" verify nowhere.wkt --against in.wkt --radius 2
expect 1 'nowhere.wkt' "$krepl" verify zone.wkt --against nowhere.wkt --radius 2
expect 2 'does not tell its radius' "$krepl" verify zone.wkt --against in.wkt
expect 2 'radius' "$krepl" verify zone.wkt --against in.wkt --radius 0
expect 2 'max-error' "$krepl" verify zone.wkt --against in.wkt --radius 2 --max-error -1
expect 2 'against' "$krepl" verify zone.wkt --radius 2

printf 'x,z\n0,0\n10,3\n20,-4\n' >terrain.csv
if "$krepl" profile --help >/dev/null 2>&1; then
  "$krepl" profile terrain.csv profile.csv --radius 2 --quiet || failed=1
  expect 0 '^sound' "$krepl" verify profile.csv --against terrain.csv --radius 2
  expect 1 'is not the profile of radius 3' "$krepl" verify profile.csv --against terrain.csv --radius 3
  expect 2 'does not tell its radius' "$krepl" verify profile.csv --against terrain.csv
fi

if "$krepl" terrain --help >/dev/null 2>&1; then
  printf 'OFF 5 4 0\n0 0 0\n10 0 1\n10 10 0\n0 10 2\n5 5 6\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n' >part.off
  printf 'OFF 5 4 0\n0 0 0\n10 0 1\n10 10 0\n0 10 2\n5 5 6.001\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n' >other.off
  printf 'ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 1 3\n0 4 1 1\n2 2 0 1\n' >grid.asc
  "$krepl" terrain part.off part.json --radius 1 --quiet || failed=1
  "$krepl" terrain grid.asc grid.json --radius 0.7 --split falling --z-scale 0.5 --quiet || failed=1
  expect 0 '^sound' "$krepl" verify part.json --against part.off --radius 1
  expect 0 'surface of radius 1: 4 triangles' "$krepl" verify part.json --against part.off --samples 1000
  expect 0 'outline at distance R' "$krepl" verify part.json --against part.off --threads 1
  expect 0 '^sound' "$krepl" verify grid.json --against grid.asc --split falling --z-scale 0.5
  expect 1 'is not the surface' "$krepl" verify grid.json --against grid.asc --z-scale 0.5
  expect 1 'is not the surface of radius 1.001: radius' "$krepl" verify part.json --against part.off --radius 1.001
  expect 1 'is not the surface of radius 1: features and labels' "$krepl" verify part.json --against other.off
  expect 1 'nowhere.off' "$krepl" verify part.json --against nowhere.off
  expect 2 'split' "$krepl" verify part.json --against part.off --split up
  expect 2 'belongs to subdivisions' "$krepl" verify zone.wkt --against in.wkt --radius 2 --split falling
  sed 's/"radius":1/"radius":/' part.json >broken.json
  expect 1 'broken.json: a number expected, line' "$krepl" verify broken.json --against part.off
  head -c 3000 part.json >short.json
  expect 1 'short.json: the file ends early' "$krepl" verify short.json --against part.off
fi
exit $failed
