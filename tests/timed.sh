#!/usr/bin/env bash
# Runs a part of the tests and notes its time; `--report` prints the times of all parts.
set -euo pipefail
times=target/test-times.txt
if [ "$1" = --report ]; then
  echo "--- times"
  cat "$times"
  rm -f "$times"
  exit 0
fi
name=$1
shift
[ "$name" = lint ] && : >"$times"
echo "--- $name"
start=$SECONDS
"$@"
printf '%-8s %4d s\n' "$name" $((SECONDS - start)) | tee -a "$times"
