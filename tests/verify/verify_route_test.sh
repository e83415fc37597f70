#!/bin/sh
# The verb `krepl verify` for routes: exit status and what it says. Usage: verify_route_test.sh KREPL
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
"$krepl" buffer in.wkt zone.wkt --radius 2 --quiet || failed=1
for out in way.gpkg way.wkt way.csv way.geojson; do
  "$krepl" route in.wkt $out --radius 2 --from=-4,3 --to 20,9 --quiet || failed=1
done
for out in way.gpkg way.wkt way.csv; do
  expect 0 '^least clearance 2 ' "$krepl" verify $out --against in.wkt --radius 2
  expect 0 '^sound' "$krepl" verify $out --against in.wkt --radius 2
  expect 1 'is not the free route of radius 2.001: the disk keeps away' "$krepl" verify $out --against in.wkt --radius 2.001
done
expect 0 '^clearance as told' "$krepl" verify way.gpkg --against in.wkt
expect 1 'give --max-error' "$krepl" verify way.geojson --against in.wkt
expect 0 '^sound' "$krepl" verify way.geojson --against in.wkt --max-error 0.002
expect 2 'does not tell its radius' "$krepl" verify way.wkt --against in.wkt
expect 2 'are for routes over a terrain' "$krepl" verify way.wkt --against in.wkt --radius 2 --ceiling 5
expect 2 'belong to routes' "$krepl" verify zone.wkt --against in.wkt --radius 2 --ceiling 5
printf 'LINESTRING (-4 5, 20 5)\n' >through.wkt
expect 1 '^least clearance 0 near 10 5' "$krepl" verify through.wkt --against in.wkt --radius 2

printf 'x,y,z\n1,5,5\n5,5,8\n9,5,5\n' >flight.csv
printf 'OFF 5 4 0\n0 0 0\n10 0 1\n10 10 0\n0 10 2\n5 5 6\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n' >hill.off
expect 0 'proven between the places too' "$krepl" verify flight.csv --against hill.off --radius 1 --ceiling 8 --max-slope 0.75
expect 1 'no steeper than allowed' "$krepl" verify flight.csv --against hill.off --radius 1 --max-slope 0.7
expect 1 'below the ceiling' "$krepl" verify flight.csv --against hill.off --radius 1 --ceiling 7.9
expect 1 'the ball keeps away, near' "$krepl" verify flight.csv --against hill.off --radius 2.1
expect 1 '^least clearance 1.6000' "$krepl" verify flight.csv --against hill.off --radius 2.1
expect 1 'has no heights' "$krepl" verify way.wkt --against hill.off --radius 1

exit $failed
