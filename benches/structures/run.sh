#!/usr/bin/env bash
# How long a point of a branch takes on structures, as a table: benches/structures/run.sh [REPETITIONS [SECONDS]]
#
# Medians of so many runs, each a process of its own on one core, of which none begins another point after so many seconds. "Spread" is the
# longest time of a point over the shortest. Where a run ends before it has two points it says
# `none`. CASES is a pattern of the cases that are run, CORE the core. The solid has 100800 coordinates.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
repetitions=${1:-5}
seconds=${2:-60}
core=${CORE:-0}

export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$here/../../target}
(cd "$here/../.." && cargo build --quiet --release -p hertzian-structure-times)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

program=$CARGO_TARGET_DIR/release/hertzian-structure-times
pinned=()
if command -v taskset >/dev/null; then pinned=(taskset -c "$core"); fi

cases=()
for modes in 2 20 200 2000; do
    for law in bar bar-hertz cantilever cantilever-hertz; do cases+=("$law $modes"); done
done
cases+=('bar-reduced 200' 'bar-reduced 2000' 'bar-hertz-reduced 200' 'cantilever-reduced 200')
cases+=('chain-one 16' 'rotor 0' 'rotor-modes 25' 'chain 64')
if python3 "$here/../../examples/structures/plate.py" 400 125 "$folder/solid"; then
    cases+=("file $folder/solid/plate.toml:700:1400" "file $folder/solid/plate.toml:700:1400:16")
fi
if [[ -n ${CASES:-} ]]; then
    mapfile -t cases < <(printf '%s\n' "${cases[@]}" | grep -E "$CASES")
fi

printf 'case\tsize\tverdicts\tcoordinates\tpoints\tevents\tdecided\tus a point\tspread\ts before the first\ts in all\ts of the reduction\terror, median\terror, largest\tJacobians a point\tresiduals a point\tMB\tended\n'
for case in "${cases[@]}"; do
    read -r kind size <<<"$case"
    for verdicts in without with; do
        : >"$folder/lines"
        for ((run = 0; run < repetitions; run++)); do
            if ! (
                ulimit -t $((2 * seconds))
                exec "${pinned[@]}" "$program" "$kind" "$size" "$verdicts" "$seconds"
            ) >>"$folder/lines" 2>"$folder/why"; then
                why=$(tail -n 1 "$folder/why")
                printf '%s\t%s\t%s\t%s\n' "$kind" "${size##*/}" "$verdicts" "no end after $((2 * seconds)) s of the processor: ${why:-no point}"
                continue 2
            fi
        done
        # The line in the middle by its time a point, and how far the others are from it.
        sort -t $'\t' -k 7,7g "$folder/lines" | awk -F '\t' -v OFS='\t' -v size="${size##*/}" '
            { line[NR] = $0; time[NR] = $7 }
            END {
                split(line[int((NR + 1) / 2)], f, FS)
                spread = sprintf("%.2f", time[NR] / time[1])
                if (f[4] < 2) { f[7] = "none"; spread = "" }
                $0 = ""
                print f[1], size, f[2], f[3], f[4], f[5], f[6], f[7], spread, f[8], f[9], f[10], f[11], f[12], f[13], f[14], f[15], f[16]
            }'
    done
done
