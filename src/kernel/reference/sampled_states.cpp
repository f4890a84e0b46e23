#include "kernel/reference/sampled_states.hpp"

#include "kernel/reference/reference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace maupertuis::reference {
namespace {

constexpr int generic_states = 3, special_states = 12;

void set_state(Memory& memory, double t, std::span<const double> q, std::span<const double> v, int state) {
  const Program& program = memory.program;
  std::mt19937 random(static_cast<unsigned>(20 + state));
  const auto uniform = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  set_leaves(memory, t, 1 - program.first_stage);
  for (int k = 0; k < 3; ++k) {
    std::fill_n(memory.row(k), program.unknowns, 0.0);
    for (std::size_t i = 0; k < 2 && i < program.freedoms; ++i) {
      const double now = k == 0 ? q[i] : v[i];
      const double generic = now * (1 + 0.5 * uniform()) + (now == 0 || state > 0 ? 3 * uniform() : 0);
      const double special = std::floor(2 * uniform()) * (std::numbers::pi / 2);
      memory.row(k)[i] = k == 0 && state >= generic_states && uniform() < 0.5 ? special : generic;
    }
  }
  for (int stage = program.first_stage; stage <= 0; ++stage) run_section(memory, Dynamics, stage);
}

}  // namespace

bool is_finite(std::span<const double> values) {
  double check = 0;
  for (const double x : values) check += x * 0;
  return check == 0;
}

std::vector<std::vector<double>> sampled_entries(const Program& program, const sparse::LiftedSystem& system,
                                                 std::span<const double> constants, double t, std::span<const double> q,
                                                 std::span<const double> v) {
  std::vector<std::vector<double>> samples;
  Memory memory(program, 1 - program.first_stage, program.slots);
  std::copy_n(constants.begin(), memory.constants.size(), memory.constants.begin());
  std::vector<Slot> same(program.slots);
  std::iota(same.begin(), same.end(), Slot{0});
  sparse::Assembly assembly(system, program, same);
  std::vector<double> entries(system.entries.size());
  assembly.set_constants(memory.constants.data(), entries);
  for (int state = 0; state < generic_states + special_states; ++state) {
    set_state(memory, t, q, v, state);
    assembly(memory.row(0), entries);
    if (is_finite(entries)) samples.push_back(entries);
  }
  return samples;
}

}  // namespace maupertuis::reference
