#include "kernel/workspace/expansion.hpp"

#include "kernel/extended/close_constants.hpp"

#include <algorithm>

namespace maupertuis::workspace {

Expansion::Expansion(const Kernel& k, int p)
    : kernel(k),
      strip(strip_for(k.program())),
      packed(packed::pack(k.program(), {strip.order, strip.whole})),
      program(packed.program),
      order(p),
      orders(p + 2 + (-2 - program.first_stage)),
      memory(program, orders, packed.cells),
      producer(program.slots, nullptr),
      parameters(program.parameters, 0.0),
      sides(program.switches.size(), 1),
      unknowns(program.unknowns) {
  for (const Instruction& i : program.instructions) producer[i.out] = &i;
  reference::set_leaves(memory, 0.0, orders);
  bind();
}

/// The engine's view.
void Expansion::bind() {
  tables.packs = packed.packs.data();
  tables.pack_count = packed.packs.size();
  tables.blocks = packed.blocks.data();
  tables.block_count = packed.blocks.size();
  tables.columns = packed.columns.data();
  tables.products = packed.products.data();
  tables.functions = packed.functions.data();
  tables.runs = packed.runs.data();
  tables.rows = memory.rows.data();
  tables.stride = memory.stride;
  tables.unknowns = unknowns;
  of_orders = packed::orders_of(memory.rows.data(), memory.stride, orders);
  const int before_all = -2 - program.first_stage;  // so that stages without an order of lag 0 find their place
  of_orders.insert(of_orders.begin(), static_cast<std::size_t>(before_all), {});
  tables.orders = of_orders.data() + before_all;
  tables.convolutions = packed.convolutions.data();
  lane_coefficients.resize(packed.coefficients.size());
  tables.coefficients = lane_coefficients.data();
  for (const packed::Pack& pack : packed.packs)
    if (pack.kind == packed::Pack::Scalar)
      edges_of_scalars[pack.instruction] = sparse::tangent_edges(program, program.instructions[pack.instruction]);
  tables.scalar.context = this;
  tables.scalar.value = [](void* self, std::uint32_t instruction, int at) {
    reference::run_instruction(static_cast<Expansion*>(self)->memory, instruction, at);
  };
  tables.scalar.tangent = [](void* self, std::uint32_t instruction, double* values) {
    const Expansion& x = *static_cast<Expansion*>(self);
    const Instruction& i = x.program.instructions[instruction];
    values[i.out] = 0;
    if (i.second != no_slot) values[i.second] = 0;
    reference::tangents<1>(x.memory, values, x.edges_of_scalars.at(instruction));
  };
}

/// A motion that goes to and fro between a few sides has their constants already.
bool Expansion::compute_constants() {
  constexpr std::size_t most_known = 8;
  if (!stale) return false;
  if (const auto known = known_constants.find(sides); known != known_constants.end()) {
    std::copy(known->second.begin(), known->second.end(), memory.constants.begin());
  } else {
    extended::compute_close_constants(program, parameters, sides, memory.constants);
    if (known_constants.size() < most_known)
      known_constants.emplace(sides, std::vector<double>(memory.constants.begin(), memory.constants.end()));
  }
  for (std::size_t i = 0; i < lane_coefficients.size(); ++i)
    lane_coefficients[i] = memory.constants[packed.coefficients[i]];
  stale = false;
  return true;
}

void ExpansionInCode::adopt(ExpansionCode made, Expansion& x) {
  code = std::move(made);
  arguments = {.rows = x.memory.rows.data(), .coefficients = x.lane_coefficients.data()};
  if (!code.stage) return;
  tangent_row.assign(x.memory.stride, 0.0);
  passing_row.assign(x.memory.stride, 0.0);
  sums.assign(x.packed.convolutions.size() * packed::rolled_group * packed::lanes, 0.0);
  arguments.sums = sums.data();
  arguments.tangent_row = tangent_row.data(), arguments.passing_row = passing_row.data();
  arguments.value = x.tables.scalar.value, arguments.tangent = x.tables.scalar.tangent;
  arguments.context = x.tables.scalar.context;
}

}  // namespace maupertuis::workspace
