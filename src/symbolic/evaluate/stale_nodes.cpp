#include "symbolic/evaluate/stale_nodes.hpp"

#include <algorithm>
#include <utility>

namespace maupertuis::evaluation {

void StaleNodes::all() {
  for (Position at = 0; at < tape_.size(); ++at)
    if (tape_.kind(at) != Kind::Number) stale_[at] = 1;
  last_ = reached_ = 0;
}

bool StaleNodes::mend(FieldNumbers& numbers, const Redraw& redraw) {
  const Expr symbol = numbers.mend(redraw);
  if (!symbol) return false;
  stale_[last_] = 1;
  for (Position at = 0; at < reached_; ++at) {  // the rest is stale as it is
    if (tape_.kind(at) == Kind::Symbol && tape_.expression(at).name() == symbol.name()) stale_[at] = 1;
    for (const Position argument : tape_.arguments(at)) stale_[at] |= stale_[argument];
  }
  return true;
}

bool StaleNodes::operator()(Position at) {
  last_ = at;
  reached_ = std::max(reached_, at + 1);
  return std::exchange(stale_[at], 0);
}

}  // namespace maupertuis::evaluation
