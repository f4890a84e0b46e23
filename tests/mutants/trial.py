"""One mutant: compiled outside the tree, linked before the archive that holds the original, and run."""
import json
import os
import re
import resource
import shlex
import shutil
import signal
import subprocess
from pathlib import Path

# Indices beyond the end of a vector end the test; optimizing more would take longer than the tests.
EXTRA_FLAGS = ["-O1", "-w", "-D_GLIBCXX_ASSERTIONS"]
MEMORY = 6 << 30


class Build:
    """The build of the unchanged tree: how its files are compiled and its programs linked. Read, never written."""

    def __init__(self, root, build):
        self.root, self.build = Path(root), Path(build)
        self._links = {}
        entries = json.loads((self.build / "compile_commands.json").read_text())
        self.compile_of = {e["file"]: e for e in entries}
        self._file_of = {self.object_of(file): file for file in self.compile_of}
        self._readers = None

    def object_of(self, file):
        words = shlex.split(self.compile_of[file]["command"])
        return words[words.index("-o") + 1]

    def readers(self, header):
        """The compiled files that read a header, as the last build found it."""
        if self._readers is None:
            self._readers = {}
            text = subprocess.run(["ninja", "-C", self.build, "-t", "deps"], capture_output=True, text=True,
                                  check=True).stdout
            target = None
            for line in text.split("\n"):
                if line and not line.startswith(" "):
                    target = line.split(":")[0]
                elif line.strip():
                    path = os.path.normpath(os.path.join(self.build, line.strip()))
                    self._readers.setdefault(path, set()).add(self._file_of.get(target))
        return sorted(f for f in self._readers.get(str(self.root / header), ()) if f)

    def link_of(self, target):
        if target not in self._links:
            lines = subprocess.run(["ninja", "-C", self.build, "-t", "commands", target],
                                   capture_output=True, text=True, check=True).stdout.strip().split("\n")
            found = next(line for line in reversed(lines) if re.search(rf" -o bin/{target}(?= |$)", line))
            self._links[target] = [w for w in shlex.split(found) if w not in (":", "&&")]
        return self._links[target]


def compile_files(build, files, overlay, folder, flags=EXTRA_FLAGS):
    """The objects of `files`, each read from `overlay` where it holds one; None where one does not compile."""
    objects = {}
    for i, file in enumerate(files):
        entry = build.compile_of[file]
        words = shlex.split(entry["command"])
        if Path(words[0]).name == "ccache":
            words = words[1:]
        out = folder / f"{i}.o"
        inside = os.path.relpath(file, build.root)
        changed = overlay / inside
        original = words[words.index("-o") + 1]
        words[words.index("-o") + 1] = str(out)
        words[words.index(file)] = str(changed if changed.exists() else file)
        words[1:1] = [f"-I{overlay / 'src'}", f"-I{overlay / 'include'}"]
        words += [*flags, f"-iquote{Path(file).parent}"]
        if subprocess.run(words, cwd=entry["directory"], capture_output=True).returncode != 0:
            return None
        objects[original] = str(out)
    return objects


def link(build, target, objects, folder):
    """`target` with these objects in the place of its own; None where it does not link. An object of a library stands
    before the archives, so that the archive's own is never asked for."""
    words = list(build.link_of(target))
    words[words.index(f"bin/{target}")] = str(folder / target)
    first = next(i for i, w in enumerate(words) if w.endswith(".a"))
    words = words[:first] + [o for name, o in objects.items() if name.startswith("src/")] + words[first:]
    words = [objects.get(w, w) for w in words] + ["-Wl,--allow-multiple-definition"]  # the first: the mutant's
    done = subprocess.run(words, cwd=build.build, capture_output=True)
    return folder / target if done.returncode == 0 else None


def run(build, suite, program, seconds):
    """(word, detail): "passed", or "failed", "crashed", "time". Processor time is bounded, so that other work does not
    count."""
    def bounded():
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    module = build.build / "lib/maupertuis/libmaup_machine_code_llvm.so"
    environment = {**os.environ, "RC_PARAMS": "seed=1744", "MAUPERTUIS_LLVM_MODULE": str(module)}
    words = [w.replace("{program}", str(program)) for w in suite.command]
    try:
        done = subprocess.run(words, cwd=build.root, env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True,
                              errors="replace", preexec_fn=bounded, timeout=20 * seconds + 60)
    except subprocess.TimeoutExpired:
        return "time", ""
    if done.returncode == 0:
        return "passed", ""
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL, 128 + signal.SIGXCPU, 128 + signal.SIGKILL):
        return "time", ""
    return ("crashed" if done.returncode < 0 else "failed"), first_failure(done.stdout + done.stderr)


def first_failure(text):
    found = re.search(r"TEST CASE:\s*(.*)", text)
    return found[1].strip() if found else text.strip().split("\n")[0][:100]


class Trial:
    """Tries mutants of one build in a folder of its own, which is gone afterwards."""

    def __init__(self, build, folder):
        self.build, self.folder = build, Path(folder)

    def files_of(self, path, suites):
        """What has to be compiled: the file, or the readers of a header in the library and in these suites."""
        if path.endswith(".cpp"):
            return [str(self.build.root / path)]
        linked = {str(w) for suite in suites for w in self.build.link_of(suite.target)}
        own = f"{self.build.root}/src/"
        return [f for f in self.build.readers(path) if f.startswith(own) or self.build.object_of(f) in linked]

    def objects(self, path, text, files):
        shutil.rmtree(self.folder, ignore_errors=True)
        overlay = self.folder / "tree"
        (overlay / path).parent.mkdir(parents=True)
        (overlay / path).write_text(text)
        return compile_files(self.build, files, overlay, self.folder)

    def judge(self, mutant, text, suites, limits):
        """(verdict, suite, detail). Verdicts: killed, survived, same code, does not compile."""
        files = self.files_of(mutant.path, suites)
        try:
            objects = self.objects(mutant.path, mutant.apply(text), files)
            if objects is None:
                return "does not compile", "", ""
            for suite in suites:
                program = link(self.build, suite.target, objects, self.folder)
                if program is None:
                    raise RuntimeError(f"{suite.name} cannot judge {mutant.path}: they do not link (suites.py)")
                word, detail = run(self.build, suite, program, limits[suite.name])
                program.unlink()
                if word != "passed":
                    return "killed", suite.name, detail if word == "failed" else word
            code = [Path(o).read_bytes() for o in objects.values()]
            unchanged = self.objects(mutant.path, text, files)
            same = [Path(o).read_bytes() for o in unchanged.values()] == code
            return "same code" if same else "survived", "", ""
        finally:
            shutil.rmtree(self.folder, ignore_errors=True)
