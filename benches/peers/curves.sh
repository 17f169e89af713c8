#!/usr/bin/env bash
# Curves of other programs for harmonic balance, for the charts of `hertzian work-precision`: benches/peers/curves.sh [--repeats N]
#
# Packages go into a virtual environment outside of the repository, PEERS_VENV; results into the table that the program reads.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
venv=${PEERS_VENV:-${XDG_CACHE_HOME:-$HOME/.cache}/hertzian-peer-curves}

if [[ ! -x $venv/bin/python ]]; then
    python3 -m venv "$venv"
fi
"$venv/bin/pip" install --quiet --disable-pip-version-check pyHarm-os==1.2.2 harmonicbalance==0.2.0 mousai==0.3.1
"$venv/bin/python" "$here/curves.py" "$here/../../cli/src/work_precision/peers.csv" "$@"
