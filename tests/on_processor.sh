#!/bin/sh
# on_processor.sh avx2|none PROGRAM [ARGUMENTS]: a test with these vector instructions and no wider ones. The processor
# is held back where it has them, and emulated where it lacks them; without an emulator the test is skipped (77) with a
# word.
set=$1
shift
export MAUPERTUIS_INSTRUCTIONS="$set"
if [ "$set" = none ] || grep -qw avx2 /proc/cpuinfo 2>/dev/null; then
  exec "$@"
elif command -v qemu-x86_64 >/dev/null; then
  exec qemu-x86_64 -cpu Haswell "$@"
fi
echo "skipped: this processor has no AVX2, and qemu-user, which has, is not installed"
exit 77
