"""Which suites judge which module, the quick ones first. A suite is a program of the build and the command that
runs it."""
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Suite:
    name: str
    target: str
    command: tuple


def unit(target, *arguments):
    return Suite(target, target, ("{program}", "--abort-after=1", *arguments))


def golden(models):
    """Printed outputs of the models of tests/golden/accept, all stages."""
    script = f'cd tests/golden/accept && for m in {" ".join(models)}; do sh compare.sh {{program}} $m || exit 1; done'
    return Suite("golden_accept", "maup", ("sh", "-c", script))


def problems(models):
    return Suite("problems", "maup", ("{program}", "test", *models))


PRINTED = golden(["bead_on_hoop", "cart_pendulum", "double_pendulum", "heavy_top", "planetary_gear",
                  "brachistochrone", "ion"])
REJECTED = unit("golden_reject")

PROVEN = problems([f"models/{m}.lag" for m in (
    "pendulum", "double_pendulum", "kepler", "lagrange_top", "balanced_cart", "coupled_pendulums", "spherical_pendulum",
    "bead_on_hoop", "rolling_disk", "brachistochrone")])

# Every reference problem that takes less than half a second.
SLOW = {"bicycle", "ivp_fekete", "nonhol_rolling_disc", "oscillator_long"}
REFERENCE = Suite("reference", "maup", ("{program}", "test", *sorted(
    str(p.relative_to(ROOT)) for p in (ROOT / "tests/problems").glob("*.lag") if p.stem not in SLOW)))

SUITES = {
    "equations": [unit("unit_equations"), unit("unit_certificate"), PRINTED, REJECTED,
                  unit("unit_simulation"), REFERENCE],
    "certificate": [unit("unit_certificate"), unit("property"), REJECTED, PRINTED],
    "symbolic/expression": [unit("unit_symbolic"), unit("unit_symbolic_evaluate"),
                            unit("unit_symbolic_readable"), unit("unit_symbolic_print"), PRINTED],
    "symbolic/transform": [unit("unit_symbolic"), unit("unit_symbolic_readable"), unit("unit_equations"), PRINTED],
    "symbolic/evaluate": [unit("unit_symbolic_evaluate"), unit("unit_certificate"), unit("unit_equations"),
                          unit("property")],
    "symbolic/print": [unit("unit_symbolic_print"), unit("unit_symbolic_readable"), PRINTED],
    "system": [unit("unit_system"), REJECTED, unit("unit_equations"), PRINTED, unit("unit_verification"), REFERENCE],
    "simulation": [unit("unit_simulation"), unit("unit_extended"), unit("unit_verification"), REJECTED, REFERENCE],
    "verification": [unit("unit_verification"), PROVEN, REFERENCE],
    "integrator/taylor": [unit("unit_taylor"), unit("integrator_methods"), unit("unit_simulation"),
                          unit("unit_ensemble"), REFERENCE],
}


def suites_of(path):
    folder = path.removeprefix("src/").rsplit("/", 1)[0]
    return SUITES[folder]
