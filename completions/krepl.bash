# bash completion for krepl

_krepl() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local verbs="buffer axis rivers offset profile terrain height free mill simulate route contour section info verify view lab" verb= word
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case " $verbs " in *" $word "*) verb=$word; break ;; esac
  done
  COMPREPLY=()
  if [[ -z $verb ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$verbs --help --version" -- "$current")
    return
  fi
  case $previous in
    --format)
      local formats="gpkg fgb wkt wkb geojson shp svg dxf"
      [[ $verb == contour || $verb == section ]] && formats="csv gpkg fgb wkt geojson shp svg dxf"
      [[ $verb == terrain ]] && formats="json gpkg step tif stl ply glb png"
      [[ $verb == simulate ]] && formats="tif png"
      mapfile -t COMPREPLY < <(compgen -W "$formats" -- "$current"); return ;;
    --engine)
      local engines="auto intervals voronoi sweep"
      [[ $verb == terrain ]] && engines="auto incremental"
      mapfile -t COMPREPLY < <(compgen -W "$engines" -- "$current"); return ;;
    --cap) mapfile -t COMPREPLY < <(compgen -W "round flat square" -- "$current"); return ;;
    --join) mapfile -t COMPREPLY < <(compgen -W "round mitre bevel" -- "$current"); return ;;
    --side) mapfile -t COMPREPLY < <(compgen -W "both left right" -- "$current"); return ;;
    --owner) mapfile -t COMPREPLY < <(compgen -W "nearest" -- "$current"); return ;;
    --radius-field | --dissolve-by)  # the fields of the input
      for word in "${COMP_WORDS[@]:2}"; do
        [[ -f $word ]] || continue
        mapfile -t COMPREPLY < <(compgen -W "$(ogrinfo -q -ro -so -al "$word" 2>/dev/null | sed -nE 's/^([A-Za-z_][A-Za-z0-9_]*): (Integer|Real|String|Date|Time).*/\1/p')" -- "$current")
        return
      done
      return ;;
    --zones) mapfile -t COMPREPLY < <(compgen -W "sub-river stem whole" -- "$current"); return ;;
    --outlet) mapfile -t COMPREPLY < <(compgen -W "guess" -- "$current"); return ;;
    --pattern) mapfile -t COMPREPLY < <(compgen -W "offsets zigzag" -- "$current"); return ;;
    --strategy) mapfile -t COMPREPLY < <(compgen -W "parallel rough waterline pencil scallop rest" -- "$current"); return ;;
    --direction) mapfile -t COMPREPLY < <(compgen -W "zigzag one-way climb conventional" -- "$current"); return ;;
    --post) mapfile -t COMPREPLY < <(compgen -W "linuxcnc grbl" -- "$current"); return ;;
    --control-point) mapfile -t COMPREPLY < <(compgen -W "tip centre" -- "$current"); return ;;
    --after) mapfile -t COMPREPLY < <(compgen -W "ball:" -- "$current"); return ;;
    --tool) mapfile -t COMPREPLY < <(compgen -W "ball: flat: bull: cone: taper:" -- "$current"); return ;;
    --prefer) mapfile -t COMPREPLY < <(compgen -W "length clearance" -- "$current"); return ;;
    --minimise) mapfile -t COMPREPLY < <(compgen -W "length climb" -- "$current"); return ;;
    --ties) mapfile -t COMPREPLY < <(compgen -W "high low" -- "$current"); return ;;
    --unit) mapfile -t COMPREPLY < <(compgen -W "mm cm m km in ft" -- "$current"); return ;;
    --up) mapfile -t COMPREPLY < <(compgen -W "x y z -x -y -z" -- "$current"); return ;;
    --split) mapfile -t COMPREPLY < <(compgen -W "rising falling shorter" -- "$current"); return ;;
    --to-crs) mapfile -t COMPREPLY < <(compgen -W "auto EPSG:" -- "$current"); return ;;
    --crs) mapfile -t COMPREPLY < <(compgen -W "EPSG:" -- "$current"); return ;;
    --layer)  # the layers of the input, which is the first word after the verb that is a file
      for word in "${COMP_WORDS[@]:2}"; do
        [[ -f $word ]] || continue
        mapfile -t COMPREPLY < <(compgen -W "$(ogrinfo -q -ro "$word" 2>/dev/null | sed -E 's/^[0-9]+: //; s/ \(.*//')" -- "$current")
        return
      done
      return ;;
    --radius | --level | --step | --from | --to | --distance | --from | --to | --ceiling | --max-slope | --step | --snap | --grid | --flow-field | --where | --max-error | --arc-error | --max-clearance | --mitre-limit | --threads | --samples | --z-scale | --band | --cell | --stock | --before | --max-rest | --width | --curve-points | --n | --count | --seed | --steps | --restarts | --limit | --step-over | --scallop | --angle | --tolerance | --allowance | --bottom | --feed | --plunge-feed | --spindle | --safe-height | --clearance | --decimals | --tool-number | --step-down | --ramp-angle | --stock-top | --stock-margin) return ;;
  esac
  local command=("$verb")
  if [[ $verb == lab ]]; then
    local names="lower-bound profiles sweep pseudospheres components conjecture search real list" name=
    for word in "${COMP_WORDS[@]:2:COMP_CWORD-2}"; do
      case " $names " in *" $word "*) name=$word; break ;; esac
    done
    if [[ -z $name ]]; then
      mapfile -t COMPREPLY < <(compgen -W "$names --help" -- "$current")
      return
    fi
    command+=("$name")
  fi
  if [[ $current == -* ]]; then
    # The program itself knows its options, so that the two cannot disagree.
    mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" "${command[@]}" --help 2>/dev/null |
      grep -Eo -- '(^|[ ,])--?[a-z][a-z-]*' | tr -d ' ,')" -- "$current")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -f -- "$current")
}

complete -o filenames -o bashdefault -F _krepl krepl
