# Thin: each rule calls a script of scripts/, which installs what is missing, configures by a CMake preset and builds.
.PHONY: demo build test test-long bench instructions sanitize fuzz mutants steep-models gallery \
  format site site-quick vscode studio wasm wasm-test arm install package clean

demo:     # check, derive, simulate and report models/double_pendulum.lag
	@scripts/demo
build:    # build/bin/maup
	@scripts/build
test:     # the tests of every change
	@scripts/test
test-long: # the others: the site, LaTeX of every model, public headers alone, reference values, large draws
	@scripts/test long
bench:    # the tables of docs/benchmarks.md, measured here
	@scripts/bench
instructions:  # counts of fixed work under valgrind, against benchmarks/instruction_counts.json
	@scripts/instructions
sanitize: # all unit tests and the fuzzer's corpus under ASan and UBSan
	@scripts/sanitize
fuzz:     # SECONDS=120 of libFuzzer on parse → check → derive, and as long of drawn inputs for every command
	@scripts/fuzz $(SECONDS)
mutants:  # one-line changes of the sources: nine of ten must be seen by the tests
	@scripts/mutants
steep-models:  # COUNT=10000 random steep models against 113 bits; FIRST=1 chooses which
	@scripts/steep_models $(or $(COUNT),10000) $(FIRST)
gallery:  # the pictures of docs/gallery
	@scripts/gallery
format:   # clang-format over the sources
	@scripts/format
site:     # build/site: the static site with the studio in it, for which the core is built with emscripten
	@scripts/site
site-quick:  # the same with the studio that is there already, or without
	@scripts/site --quick
vscode:   # editors/vscode/maupertuis.vsix: the extension for Visual Studio Code
	@scripts/vscode
studio:   # build/studio: the page of `maup studio`; needs npm
	@scripts/studio
wasm:     # build-wasm/bin/maup.wasm: the core for a browser, with emscripten
	@scripts/wasm
wasm-test:  # the module in Node and in Chromium over the whole gallery, against the program of this machine
	@scripts/wasm_test
arm:      # build-arm/bin/maup: the program for 64-bit ARM, and models whose expected lines have to hold there
	@scripts/arm
install:  # PREFIX=/usr/local by default
	@scripts/install
package:  # build/packages/*.deb: the program, the module with LLVM, what other programs are built with
	@scripts/package
clean:
	@rm -rf build build-sanitize build-fuzz build-wasm build-arm
