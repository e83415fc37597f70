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
exit $failed
