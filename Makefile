# Thin: each rule calls a script of scripts/, which installs what is missing, configures by a CMake preset and builds.
.PHONY: demo build test bench fuzz format install clean

demo:     # check, derive, simulate and report models/double_pendulum.lag
	@scripts/demo
build:    # build/bin/maup
	@scripts/build
test:     # all tests
	@scripts/test
bench:    # the table of docs/benchmarks.md, measured here
	@scripts/bench
fuzz:     # two minutes of libFuzzer on parse → check → derive
	@scripts/fuzz
format:   # clang-format over the sources
	@scripts/format
install:  # PREFIX=/usr/local by default
	@scripts/install
clean:
	@rm -rf build build-sanitize build-fuzz
