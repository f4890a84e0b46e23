#include <maupertuis/field_system.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <numeric>

/// Derivatives of fields as symbols, and the chain rule through them.
namespace maupertuis {

int FieldJet::order() const { return std::accumulate(space.begin(), space.end(), time); }

namespace {

/// "xxy" of two by x and one by y.
std::string letters(const FieldSystem& s, const FieldJet& jet) {
  std::string out;
  for (std::size_t i = 0; i < s.space.size(); ++i)
    for (int k = 0; k < jet.space[i]; ++k) out += s.space[i].name;
  return out;
}

/// Reads "xxy" or "tx" into the counts of a jet; false where it is something else.
bool read_letters(const FieldSystem& s, std::string_view text, FieldJet& jet) {
  while (!text.empty()) {
    bool found = false;
    for (std::size_t i = 0; i < s.space.size() && !found; ++i) {
      if (text.substr(0, s.space[i].name.size()) != s.space[i].name) continue;
      ++jet.space[i];
      text.remove_prefix(s.space[i].name.size());
      found = true;
    }
    if (!found && text.front() == 't') {
      ++jet.time;
      text.remove_prefix(1);
      found = true;
    }
    if (!found) return false;
  }
  return true;
}

}  // namespace

bool FieldSystem::periodic() const {
  return !around.empty() && std::find(around.begin(), around.end(), false) == around.end();
}

Expr FieldSystem::jet_symbol(const FieldJet& jet) const {
  const Field& f = fields[jet.field];
  const std::string suffix = letters(*this, jet);
  return context->symbol(suffix.empty() ? f.name : f.name + "_" + suffix, f.given ? Role::Input : Role::Coordinate,
                         jet.time);
}

std::optional<FieldJet> FieldSystem::jet_of_name(std::string_view name) const {
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const std::string& own = fields[f].name;
    if (name.substr(0, own.size()) != own) continue;
    FieldJet jet{f, std::vector<int>(space.size(), 0), 0};
    if (name.size() == own.size()) return jet;
    if (name[own.size()] == '_' && name.size() > own.size() + 1 &&
        read_letters(*this, name.substr(own.size() + 1), jet))
      return jet;
  }
  return std::nullopt;
}

std::optional<FieldJet> FieldSystem::jet_of(Expr symbol) const {
  if (!symbol.is_symbol() || (symbol.role() != Role::Coordinate && symbol.role() != Role::Input)) return std::nullopt;
  std::optional<FieldJet> jet = jet_of_name(symbol.name());
  if (jet) jet->time += symbol.order();
  return jet;
}

Dimension FieldSystem::dimension_of(const FieldJet& jet) const {
  Dimension out = fields[jet.field].dimension;
  for (std::size_t i = 0; i < space.size(); ++i) out = out / pow(space[i].dimension, jet.space[i]);
  return out / pow(time_dimension, jet.time);
}

std::vector<Expr> FieldSystem::jets_in(Expr e) const {
  const Expr roots[] = {e};
  std::vector<Expr> out;
  for (const Expr& s : symbols_of(roots))
    if (jet_of(s)) out.push_back(s);
  return out;
}

Expr FieldSystem::total_derivative(Expr e, std::size_t variable) const {
  const bool by_time = variable == space.size();
  std::vector<Expr> symbols = jets_in(e);
  const std::size_t jets = symbols.size();
  symbols.push_back(by_time ? context->time() : space[variable].symbol);
  const std::vector<Expr> slopes = gradient(e, symbols);
  std::vector<Expr> terms{slopes[jets]};
  for (std::size_t i = 0; i < jets; ++i) {
    if (slopes[i].is_zero()) continue;
    FieldJet jet = *jet_of(symbols[i]);
    ++(by_time ? jet.time : jet.space[variable]);
    terms.push_back(slopes[i] * jet_symbol(jet));
  }
  return context->sum(terms);
}

Expr FieldSystem::expanded(Expr e) const { return definitions.empty() ? e : substitute(e, definitions); }

std::string FieldSystem::jet_name(const FieldJet& jet) const {
  const std::string suffix = letters(*this, jet);
  if (suffix.empty()) return fields[jet.field].name + std::string(static_cast<std::size_t>(jet.time), '\'');
  return fields[jet.field].name + "_" + std::string(static_cast<std::size_t>(jet.time), 't') + suffix;
}

}  // namespace maupertuis
