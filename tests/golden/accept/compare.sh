#!/bin/sh
# compare.sh MAUP NAME [promote]: the four outputs for NAME.lag against the expected files, or written to them.
maup=$1 name=$2 action=${3:-compare}
failed=0
for stage in check derive steps hamiltonian; do
  case $stage in
    check) set -- check ;;
    derive) set -- derive --plain ;;
    steps) set -- derive --steps --plain ;;
    hamiltonian) set -- hamiltonian --plain ;;
  esac
  actual=$(mktemp)
  NO_COLOR=1 "$maup" "$@" "$name.lag" >"$actual" 2>&1 || { echo "maup $* $name.lag ended with $?"; failed=1; }
  if [ "$action" = promote ]; then
    cp "$actual" "$name.$stage.txt"
  elif ! diff -u "$name.$stage.txt" "$actual"; then
    failed=1
  fi
  rm -f "$actual"
done
exit $failed
