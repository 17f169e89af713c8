#!/usr/bin/env bash
# Instructions of generated laws, counted by callgrind: benches/instructions/run.sh [--accept]
#
# Fails if a count is 5 % above `baseline.tsv`, or is not in it; `--accept` writes a new baseline, if nothing is changed that is not
# committed. A count depends on the
# instruction set asked for and on the compiler, not on the processor and what else it does. Valgrind knows no AVX-512.
# Where there is no valgrind and it cannot be installed, nothing is counted.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
baseline=$here/baseline.tsv
allowed=5

if [[ $(uname -m) != x86_64 ]]; then
    echo "no counts: the baseline is of x86-64, this is $(uname -m)"
    exit 0
fi

# A baseline has to be that of a commit.
if [[ ${1:-} == --accept ]]; then
    changed=$(git -C "$here" status --porcelain --untracked-files=normal "$(git -C "$here" rev-parse --show-toplevel)")
    changed=$(grep -v ' benches/instructions/baseline.tsv$' <<<"$changed" || true)
    if [[ -n $changed ]]; then
        echo "no baseline is written: commit or put aside what is changed first" >&2
        echo "$changed" >&2
        exit 1
    fi
fi

if ! command -v valgrind >/dev/null && command -v apt-get >/dev/null; then
    as_root=()
    [[ $EUID -eq 0 ]] || as_root=(sudo -n)
    echo 'installing valgrind'
    { "${as_root[@]}" apt-get -qq update && "${as_root[@]}" apt-get -qq install -y valgrind; } >/dev/null 2>&1 || true
fi
if ! command -v valgrind >/dev/null; then
    echo 'no counts: valgrind is not installed, and cannot be installed here'
    exit 0
fi

# With the features that the programs of the workspace ask for, so that the runtime is built once for all of them.
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$here/../../target}
(cd "$here/../.." && cargo build --quiet --release --workspace --bin hertzian-instructions)

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# The C library chooses its functions by the processor too, unless it is told to take those that every one can run.
export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-AVX_Fast_Unaligned_Load,-ERMS

kinds=(baseline)
if grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo; then
    kinds+=(avx2)
else
    echo 'this processor has no AVX2: its counts are not checked'
fi

# One line for each call: instruction set, law, batch, call, count.
for kind in "${kinds[@]}"; do
    mkdir "$folder/$kind"
    HERTZIAN_INSTRUCTIONS=$kind valgrind --tool=callgrind \
        --toggle-collect=measured --dump-after=measured --callgrind-out-file="$folder/$kind/counts" \
        "$CARGO_TARGET_DIR/release/hertzian-instructions" >"$folder/$kind/names" 2>"$folder/$kind/log" || {
        cat "$folder/$kind/log" >&2
        exit 1
    }
    call=0
    while IFS= read -r name; do
        call=$((call + 1))
        count=$(awk '$1 == "totals:" { print $2 }' "$folder/$kind/counts.$call")
        if [[ ! $count =~ ^[1-9][0-9]*$ ]]; then
            echo "nothing was counted of call $call, $name" >&2
            exit 1
        fi
        printf '%s\t%s\t%s\n' "$kind" "$name" "$count"
    done <"$folder/$kind/names"
done >"$folder/found"

# If the program did not heed the instruction set, all of them would have the counts of one.
if ! awk -F '\t' '$2 ~ /alpha/ && seen[$2, $3, $4, $5]++ { print "as many instructions on two sets: " $2; failed = 1 } END { exit failed }' \
    "$folder/found"; then
    exit 1
fi

if [[ ${1:-} == --accept ]]; then
    {
        echo "# Instructions of each call, $(rustc --version)"
        cat "$folder/found"
    } >"$baseline"
    echo "written: $(wc -l <"$folder/found") counts"
    exit 0
fi

if awk -F '\t' -v allowed=$allowed '
    /^#/ { next }
    { name = $1 ": " $2 ", " $3 ", " $4 }
    NR == FNR { expected[name] = $5; kind[name] = $1; next }
    { measured[$1] }
    !(name in expected) { print "not in the baseline: " name; failed = 1; next }
    { checked++; found[name]; change = 100 * ($5 / expected[name] - 1) }
    change > allowed { printf "%+.1f %%, %d to %d instructions: %s\n", change, expected[name], $5, name; failed = 1 }
    change < -allowed { fewer++ }
    END {
        for (name in expected) {
            if (kind[name] in measured && !(name in found)) { print "not counted: " name; failed = 1 }
        }
        if (!checked) { failed = 1 }
        printf "%d counts compared, %d of them more than %d %% below the baseline\n", checked, fewer, allowed
        exit failed
    }
' "$baseline" "$folder/found"; then
    exit 0
fi
head -n 1 "$baseline"
echo "# Now: $(rustc --version)"
echo 'If the change is worth it, accept a new baseline and commit it: benches/instructions/run.sh --accept'
exit 1
