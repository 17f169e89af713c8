#!/usr/bin/env bash
# Time to compile a crate of 100 declared models, against a crate that holds the printed expansion of the same
# declarations: benches/compile_time.sh [REPEATS]
#
# Both crates are members of one workspace in a temporary folder, so they share their dependencies, which are built
# before. Incremental compilation is off, otherwise a repeat would find its own results. Each repeat times both crates
# in turns, and cargo with nothing to do, which is part of each of the other times.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
repeats=${1:-7}
models=100

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
crates=(by_hand by_macro)

for crate in "${crates[@]}"; do
    mkdir -p "$folder/$crate/src"
    cat >"$folder/$crate/Cargo.toml" <<END
[package]
name = "$crate"
version = "0.0.0"
edition = "2024"

[dependencies]
hertzian = { path = "$root/core" }
END
done
printf '[workspace]\nresolver = "3"\nmembers = ["by_hand", "by_macro"]\n' >"$folder/Cargo.toml"
cp "$root/Cargo.lock" "$folder"

(cd "$root" && cargo run --quiet -p hertzian-compiler --example variants -- \
    "$models" "$folder/by_macro/src/lib.rs" "$folder/by_hand/src/lib.rs")

cd "$folder"
export CARGO_INCREMENTAL=0 CARGO_TARGET_DIR=$folder/target

# Runs cargo and says how many milliseconds it took.
milliseconds() {
    local start end
    start=$(date +%s%N)
    cargo "$1" --quiet --offline -p "$2"
    end=$(date +%s%N)
    echo $(((end - start) / 1000000))
}

median() {
    sort -n "$1" | awk '{ value[NR] = $1 } END { print (value[int((NR + 1) / 2)] + value[int(NR / 2) + 1]) / 2 }'
}

echo "$models models, lines: declared $(wc -l <by_macro/src/lib.rs), expanded $(wc -l <by_hand/src/lib.rs)"
echo "$(rustc --version), dev profile, median of $repeats repeats, seconds"
for command in check build; do
    for crate in "${crates[@]}"; do
        cargo "$command" --quiet --offline -p "$crate"
    done
    for ((i = 0; i < repeats; i++)); do
        for crate in "${crates[@]}"; do
            touch "$crate/src/lib.rs"
            milliseconds "$command" "$crate" >>"$command.$crate"
        done
        milliseconds "$command" by_hand >>"$command.nothing"
    done
    echo "$(median "$command.by_hand") $(median "$command.by_macro") $(median "$command.nothing")" |
        awk -v command="$command" '{
            printf "cargo %s: by hand %.2f, macro %.2f, nothing to do %.2f; macro/by hand %.2f\n",
                command, $1 / 1e3, $2 / 1e3, $3 / 1e3, $2 / $1
        }'
done
