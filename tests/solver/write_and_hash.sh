# hash_results RESULTS COMMAND...: in the folder RESULTS, what the solver that COMMAND starts settles and runs of a small bed
# by every scheme; in RESULTS.sha256 the hashes of that. To be sourced.
small_bed=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/small_bed.json
hash_results() {
  local results=$1
  shift
  mkdir -p "$results"
  "$@" pack "$small_bed" --seed 1 --output "$results/packing"
  for scheme in paper liggghts yade liggghts_averaged yade_averaged; do
    sed "s/\"schema_version\": 1/&, \"scheme\": {\"name\": \"$scheme\"}/" "$small_bed" >"$results/$scheme.json"
    "$@" resolve "$results/$scheme.json" | grep -q "\"name\":\"$scheme\""
    "$@" run "$results/$scheme.json" --packing "$results/packing/packing.csv" --output "$results/$scheme"
  done
  (cd "$results" && sha256sum packing/* */resistance.csv */ledger.csv) >"$results.sha256"
}
