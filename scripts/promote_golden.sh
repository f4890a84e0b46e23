#!/bin/sh
# Makes what the program prints today the expected output of tests/golden/accept: review the diff before you commit it.
#   scripts/promote_golden.sh [MAUP] [NAME...]
set -e
cd "$(dirname "$0")/.."
maup=$(realpath "${1:-build/bin/maup}")
[ $# -gt 0 ] && shift
cd tests/golden/accept
[ $# -gt 0 ] || set -- *.lag
for model; do
  sh compare.sh "$maup" "${model%.lag}" promote
done
git --no-pager diff --stat -- .
