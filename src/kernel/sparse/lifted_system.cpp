#include "kernel/sparse/lifted_system.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace maupertuis::sparse {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

class Lift {
 public:
  Lift(const Program& program, const std::vector<bool>& stored)
      : program_(program),
        stored_(stored),
        edges_(tangent_edges(program)),
        row_(program.slots, none),
        column_(program.slots, none),
        moves_(program.slots, false),
        needed_(program.slots, false) {}

  std::optional<LiftedSystem> run() {
    drop_constant_edges();
    for (const Slot slot : program_.residual)
      if (!moves_[slot] || program_.tangent_lags[slot] != 2 || slot < program_.unknowns) return std::nullopt;
    find_needed();
    number();
    enter();
    return std::move(system_);
  }

 private:
  bool is_coordinate(Slot slot) const { return slot < program_.unknowns; }
  bool is_stored(Slot slot) const { return stored_[slot]; }

  /// A slot that q moves at a lower lag alone has no tangent: so have edges from it.
  void drop_constant_edges() {
    std::fill_n(moves_.begin(), program_.unknowns, true);
    std::erase_if(edges_, [&](const Edge& edge) {
      if (!moves_[edge.operand]) return true;
      moves_[edge.out] = true;
      return false;
    });
  }

  void find_needed() {
    for (const Slot slot : program_.residual) needed_[slot] = true;
    for (Slot slot = 0; slot < program_.slots; ++slot)
      needed_[slot] = needed_[slot] || (moves_[slot] && (is_coordinate(slot) || is_stored(slot)));
    for (auto edge = edges_.rbegin(); edge != edges_.rend(); ++edge)
      if (needed_[edge->out]) needed_[edge->operand] = true;
    std::erase_if(edges_, [&](const Edge& edge) { return !needed_[edge.out]; });
  }

  std::uint32_t new_column(Slot slot) {
    system_.slot_of_column.push_back(slot);
    system_.wanted.push_back(is_coordinate(slot) || is_stored(slot));
    return column_[slot] = static_cast<std::uint32_t>(system_.slot_of_column.size() - 1);
  }

  /// A residual that nothing else reads is no unknown: its row is that of b.
  void number() {
    std::vector<int> uses(program_.slots, 0);
    for (const Edge& edge : edges_) ++uses[edge.operand];
    for (const Slot slot : program_.residual) uses[slot] += is_stored(slot) ? 1 : 0;
    std::vector<int> residuals(program_.slots, 0);
    for (const Slot slot : program_.residual) ++residuals[slot];
    for (Slot slot = 0; slot < program_.slots; ++slot) {
      if (!needed_[slot]) continue;
      const bool is_free = residuals[slot] == 1 && uses[slot] == 0;
      if (!is_free) new_column(slot);
      if (!is_coordinate(slot)) row_[slot] = rows_++;
      if (!is_free && !is_coordinate(slot)) system_.minus_one.push_back(entry(row_[slot], column_[slot]));
    }
    for (const Slot slot : program_.residual) {
      if (column_[slot] == none) {
        system_.row_of_residual.push_back(row_[slot]);
        continue;
      }
      system_.row_of_residual.push_back(rows_);
      system_.plus_one.push_back(entry(rows_++, column_[slot]));
    }
    system_.size = system_.slot_of_column.size();
    system_.own_column.assign(system_.size, none);
    for (Slot slot = 0; slot < program_.slots; ++slot)
      if (row_[slot] != none && column_[slot] != none) system_.own_column[row_[slot]] = column_[slot];
    for (std::uint32_t i = 0; i < program_.unknowns; ++i) system_.own_column[system_.row_of_residual[i]] = i;
  }

  std::uint32_t entry(std::uint32_t row, std::uint32_t column) {
    const auto [place, fresh] = places_.try_emplace({row, column}, static_cast<std::uint32_t>(system_.entries.size()));
    if (fresh) system_.entries.push_back({row, column});
    return place->second;
  }

  void enter() {
    std::vector<bool> seen(rows_, false);
    for (const Edge& edge : edges_)
      if (!seen[row_[edge.out]]) {
        seen[row_[edge.out]] = true;
        system_.rows_of_slots.push_back(row_[edge.out]);
      }
    std::stable_sort(edges_.begin(), edges_.end(), [](const Edge& x, const Edge& y) { return x.rule < y.rule; });
    for (const Edge& edge : edges_) system_.entry_of_edge.push_back(entry(row_[edge.out], column_[edge.operand]));
    system_.edges = std::move(edges_);
    find_literals();
  }

  void find_literals() {
    system_.literal.assign(system_.entries.size(), 0.0);
    for (const std::uint32_t e : system_.minus_one) system_.literal[e] -= 1;
    for (const std::uint32_t e : system_.plus_one) system_.literal[e] += 1;
    for (std::size_t i = 0; i < system_.edges.size(); ++i) {
      const Edge& edge = system_.edges[i];
      const bool is_number = edge.rule == Rule::Coefficient && program_.constants[edge.index].kind == Kind::Number;
      const double other = std::numeric_limits<double>::quiet_NaN();
      system_.literal[system_.entry_of_edge[i]] += edge.rule == Rule::One ? 1
                                                   : is_number            ? program_.constants[edge.index].value
                                                                          : other;
    }
  }

  const Program& program_;
  const std::vector<bool>& stored_;  // [slots]
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> row_, column_;  // [slots]
  std::vector<bool> moves_, needed_;         // [slots]
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> places_;
  std::uint32_t rows_ = 0;
  LiftedSystem system_;
};

}  // namespace

std::optional<LiftedSystem> lift(const Program& program, const std::vector<bool>& stored) {
  return Lift(program, stored).run();
}

Assembly::Assembly(const LiftedSystem& system, const Program& program, std::span<const Slot> number)
    : program_(program), minus_and_plus_(system.entries.size(), 0.0), base_(system.entries.size()) {
  for (const std::uint32_t entry : system.minus_one) minus_and_plus_[entry] = -1;
  for (const std::uint32_t entry : system.plus_one) minus_and_plus_[entry] = 1;
  std::vector<bool> has_multiple(system.entries.size(), false), has_other(system.entries.size(), false);
  for (std::size_t e = 0; e < system.edges.size(); ++e) {
    Edge edge = system.edges[e];
    const std::uint32_t entry = system.entry_of_edge[e];
    if (is_constant(edge.rule)) {
      constant_.push_back(edge);
      entry_of_constant_.push_back(entry);
      continue;
    }
    edge.x = number[edge.x];
    if (edge.y != no_slot) edge.y = number[edge.y];
    const bool is_multiple = edge.rule == Rule::Scaled || edge.rule == Rule::Value || edge.rule == Rule::Negative ||
                             edge.rule == Rule::Double;
    if (is_multiple) {
      (has_multiple[entry] ? more_ : first_).push_back({edge.x, entry, 0, 0});
      (has_multiple[entry] ? edges_of_more_ : edges_of_first_).push_back(edge);
      has_multiple[entry] = true;
    } else {
      others_.push_back(edge);
      entry_of_other_.push_back(entry);
      has_other[entry] = true;
    }
  }
  for (std::uint32_t entry = 0; entry < system.entries.size(); ++entry)
    if (has_other[entry] && !has_multiple[entry]) of_others_alone_.push_back(entry);
}

void Assembly::set_constants(const double* constants, std::span<double> values) {
  constants_ = constants;
  base_ = minus_and_plus_;
  for (std::size_t i = 0; i < constant_.size(); ++i)
    base_[entry_of_constant_[i]] += constant_factor(constant_[i], program_.terms.data(), constants);
  std::copy(base_.begin(), base_.end(), values.begin());
  const auto factor = [&](const Edge& edge) {
    return edge.rule == Rule::Scaled     ? constants[edge.index]
           : edge.rule == Rule::Double   ? 2.0
           : edge.rule == Rule::Negative ? -1.0
                                         : 1.0;
  };
  for (std::size_t i = 0; i < first_.size(); ++i)
    first_[i].factor = factor(edges_of_first_[i]), first_[i].base = base_[first_[i].entry];
  for (std::size_t i = 0; i < more_.size(); ++i) more_[i].factor = factor(edges_of_more_[i]);
}

/// What changes along a motion alone.
void Assembly::operator()(const double* now, std::span<double> values) const {
  for (const Multiple& m : first_) values[m.entry] = m.base + m.factor * now[m.slot];
  for (const Multiple& m : more_) values[m.entry] += m.factor * now[m.slot];
  for (const std::uint32_t entry : of_others_alone_) values[entry] = base_[entry];
  for (std::size_t i = 0; i < others_.size(); ++i)
    values[entry_of_other_[i]] += factor_at(others_[i], program_.terms.data(), constants_, now);
}

}  // namespace maupertuis::sparse
