#!/usr/bin/env bash
# The power law of hertzian beside those of CasADi, SymPy, SymForce and of a person: benches/peers/run.sh [--turns N]
#
# Packages go into a virtual environment outside of the repository, PEERS_VENV; programs and results into `out`.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
venv=${PEERS_VENV:-${XDG_CACHE_HOME:-$HOME/.cache}/hertzian-peers}

if [[ ! -x $venv/bin/python ]]; then
    python3 -m venv "$venv"
fi
"$venv/bin/pip" install --quiet --disable-pip-version-check --requirement "$here/requirements.txt"

export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$here/ours/target}
cargo build --quiet --release --manifest-path "$here/ours/Cargo.toml"
"$venv/bin/python" "$here/peers.py" "$CARGO_TARGET_DIR/release/libhertzian_peers.so" --out "$here/out" "$@"
