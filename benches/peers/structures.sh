#!/usr/bin/env bash
# Curves of structures with a stop by hertzian, AUTO-07p and pyHarm: benches/peers/structures.sh [--repeats N] [--patience SECONDS]
#
# Packages go into a virtual environment outside of the repository, PEERS_VENV; results into `out`. HERTZIAN is a program that is built
# already, AUTO_DIR the folder of AUTO-07p, by default that of Debian's package. Where there is none, AUTO is left out.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
venv=${PEERS_VENV:-${XDG_CACHE_HOME:-$HOME/.cache}/hertzian-peer-structures}

if [[ ! -x $venv/bin/python ]]; then
    python3 -m venv "$venv"
fi
"$venv/bin/pip" install --quiet --disable-pip-version-check --requirement "$here/requirements-structures.txt"
if [[ -z ${HERTZIAN:-} ]]; then
    # What cargo does is not to be timed.
    export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$here/../../target}
    cargo build --quiet --release --manifest-path "$here/../../Cargo.toml" -p hertzian-cli
    HERTZIAN=$(cd "$CARGO_TARGET_DIR" && pwd)/release/hertzian
    export HERTZIAN
fi
"$venv/bin/python" "$here/structures.py" --out "$here/out" "$@"
