#include "equations/integrable_part.hpp"

#include "equations/row_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

/// Frobenius. The directions X_j that all forms send to zero are solved for as X_j = ∂_j + Σ_p x_jp ∂_p, with p over
/// the pivot variables; their Lie brackets have pivot components alone. Brackets are added until none is new. What the
/// forms send to zero then is a bundle of surfaces, and a form that is zero on all brackets is a combination of their
/// dF.
namespace maupertuis {
namespace {

using Matrix = Eigen::MatrixXd;
using Index = Eigen::Index;

/// A direction: components for all variables.
struct Field {
  ExprVector components;
  std::vector<ExprVector> gradients;  // of the components by the variables
  std::vector<bool> moves, reads;     // [variables] the component is not 0; some component depends on it
};

class Closure {
 public:
  Closure(const std::vector<OneForm>& forms, const ExprVector& variables, const std::vector<Bindings>& points)
      : forms_(forms),
        variables_(variables),
        points_(points),
        zero_(variables[0].context().number(Rational(0))),
        one_(variables[0].context().number(Rational(1))) {}

  IntegrablePart find() {
    choose_rows(all_forms());
    solve_directions();
    close();
    IntegrablePart out;
    out.rank = rows_.size();
    out.integrable_rank = rows_.size() - brackets_.size();
    for (const OneForm& form : forms_) out.integrable.push_back(vanishes_on_brackets(form));
    combine(out);
    return out;
  }

 private:
  std::vector<std::size_t> all_forms() const {
    std::vector<std::size_t> out(forms_.size());
    std::iota(out.begin(), out.end(), std::size_t{0});
    return out;
  }

  static Matrix scaled_rows(Matrix m) {
    for (Index i = 0; i < m.rows(); ++i)
      if (const double norm = m.row(i).norm(); norm > 0) m.row(i) /= norm;
    return m;
  }

  Matrix values(const ExprVector& entries, std::size_t columns, const Bindings& point) const {
    const std::vector<double> numbers = evaluate(entries, point);
    Matrix out(static_cast<Index>(numbers.size() / columns), static_cast<Index>(columns));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      out(static_cast<Index>(i / columns), static_cast<Index>(i % columns)) = numbers[i];
    return out;
  }

  /// A largest set of independent forms, the earlier ones in `order` first.
  void choose_rows(const std::vector<std::size_t>& order) {
    ExprVector entries;
    for (const std::size_t i : order)
      for (const Expr& a : forms_[i].components) entries.push_back(a);
    rows_.clear();
    for (const Bindings& point : points_) {
      const auto chosen = independent_rows(scaled_rows(values(entries, variables_.size(), point)));
      if (chosen.size() <= rows_.size()) continue;
      rows_.clear();
      for (const std::size_t k : chosen) rows_.push_back(order[k]);
      best_ = &point;
    }
  }

  void solve_directions() {
    const std::size_t count = variables_.size();
    ExprMatrix m{rows_.size(), count, {}};
    for (const std::size_t i : rows_)
      for (const Expr& a : forms_[i].components) m.entries.push_back(a);
    const auto pivots =
        best_ ? reduce_rows(m, count, rows_.size(), *best_) : std::vector<std::pair<std::size_t, std::size_t>>{};
    std::vector<bool> is_pivot(count, false);
    for (const auto& [row, column] : pivots) is_pivot[column] = true, pivots_.push_back(column);
    for (std::size_t j = 0; j < count; ++j) {
      if (is_pivot[j]) continue;
      ExprVector x(count, zero_);
      x[j] = one_;
      for (const auto& [row, column] : pivots) x[column] = -m.at(row, j);
      directions_.push_back(with_gradients(std::move(x)));
    }
  }

  Field field(ExprVector components) const {
    Field out{std::move(components), {}, {}, std::vector<bool>(variables_.size(), false)};
    for (const Expr& c : out.components) out.moves.push_back(!c.is_zero());
    for (const Expr& symbol : symbols_of(out.components))
      if (const auto v = std::find(variables_.begin(), variables_.end(), symbol); v != variables_.end())
        out.reads[static_cast<std::size_t>(v - variables_.begin())] = true;
    return out;
  }

  Field with_gradients(ExprVector components) const {
    Field out = field(std::move(components));
    for (const Expr& c : out.components)
      out.gradients.push_back(c.is_number() ? ExprVector(variables_.size(), zero_) : gradient(c, variables_));
    return out;
  }

  /// Neither moves what the other reads: the bracket is 0.
  static bool commute(const Field& x, const Field& y) {
    for (std::size_t l = 0; l < x.moves.size(); ++l)
      if ((x.moves[l] && y.reads[l]) || (y.moves[l] && x.reads[l])) return false;
    return true;
  }

  /// X(e) = d/dε e(q + ε X) at ε = 0: all of them in one forward sweep, so that brackets of brackets stay small.
  ExprVector along(const ExprVector& x, const ExprVector& e) const {
    const Expr epsilon = zero_.context().symbol("bracket parameter", Role::Auxiliary);
    ExprMap shift;
    for (std::size_t l = 0; l < variables_.size(); ++l)
      if (!x[l].is_zero()) shift.emplace(variables_[l], variables_[l] + epsilon * x[l]);
    ExprVector out = substitute(e, shift);
    for (Expr& value : out) value = differentiate(value, epsilon);
    return substitute(out, {{epsilon, zero_}});
  }

  /// [X, Y] = X(Y) − Y(X). Components that vanish identically become 0.
  ExprVector bracket(const Field& x, const Field& y) const {
    ExprVector out(variables_.size(), zero_);
    if (commute(x, y)) return out;
    const ExprVector forward = along(x.components, y.components);
    for (const std::size_t p : pivots_) {
      ExprVector terms{forward[p]};
      for (std::size_t l = 0; l < variables_.size(); ++l)
        if (y.moves[l] && !x.gradients[p][l].is_zero()) terms.push_back(-(y.components[l] * x.gradients[p][l]));
      const Expr value = sum_of(terms, zero_.context());
      out[p] = value.is_number() || zero_test(value).verdict != Verdict::Zero ? value : zero_;
    }
    return out;
  }

  void close() {
    bracket_numbers_.assign(points_.size(), Matrix(0, static_cast<Index>(pivots_.size())));
    std::vector<Field> newest;
    for (std::size_t i = 0; i < directions_.size(); ++i)
      for (std::size_t j = i + 1; j < directions_.size(); ++j) add(bracket(directions_[i], directions_[j]), newest);
    while (!newest.empty() && brackets_.size() < pivots_.size()) {
      std::vector<Field> next;
      for (const Field& x : directions_)
        for (const Field& y : newest) add(bracket(x, y), next);
      newest = std::move(next);
    }
  }

  /// Keeps a bracket that is new at some point.
  void add(ExprVector candidate, std::vector<Field>& newest) {
    if (brackets_.size() == pivots_.size()) return;
    if (std::all_of(candidate.begin(), candidate.end(), [](Expr e) { return e.is_zero(); })) return;
    const std::vector<Eigen::RowVectorXd> numbers = numbers_of(candidate);
    bool is_new = false;
    for (std::size_t k = 0; k < points_.size() && !is_new; ++k) {
      Matrix m(bracket_numbers_[k].rows() + 1, numbers[k].size());
      m << bracket_numbers_[k], numbers[k];
      is_new = m.allFinite() && numerical_rank(scaled_rows(m)) > brackets_.size();
    }
    if (!is_new) return;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      Matrix m(bracket_numbers_[k].rows() + 1, numbers[k].size());
      m << bracket_numbers_[k], numbers[k];
      bracket_numbers_[k] = std::move(m);
    }
    brackets_.push_back(candidate);
    newest.push_back(field(std::move(candidate)));
  }

  /// The pivot components at each point; one that is rounding of its terms counts as zero.
  std::vector<Eigen::RowVectorXd> numbers_of(const ExprVector& field) const {
    ExprVector terms;
    std::vector<std::size_t> first;  // of each component: its value, then its terms
    for (const std::size_t p : pivots_) {
      first.push_back(terms.size());
      terms.push_back(field[p]);
      for (std::size_t i = 0; field[p].is(Kind::Sum) && i < field[p].size(); ++i) terms.push_back(field[p][i]);
    }
    first.push_back(terms.size());
    std::vector<Eigen::RowVectorXd> out;
    for (const Bindings& point : points_) {
      const std::vector<double> numbers = evaluate(terms, point);
      out.emplace_back(static_cast<Index>(pivots_.size()));
      for (std::size_t k = 0; k < pivots_.size(); ++k) {
        double size = 0;
        for (std::size_t i = first[k] + 1; i < first[k + 1]; ++i) size += std::abs(numbers[i]);
        const double value = numbers[first[k]];
        out.back()[static_cast<Index>(k)] = std::abs(value) <= rank_tolerance * size ? 0 : value;
      }
    }
    return out;
  }

  static double without_rounding(Expr e, const Bindings& point) {
    ExprVector terms{e};
    for (std::size_t i = 0; e.is(Kind::Sum) && i < e.size(); ++i) terms.push_back(e[i]);
    const std::vector<double> numbers = evaluate(terms, point);
    double size = 0;
    for (std::size_t i = 1; i < numbers.size(); ++i) size += std::abs(numbers[i]);
    return std::abs(numbers[0]) <= rank_tolerance * size ? 0 : numbers[0];
  }

  Expr value_on(const OneForm& form, const ExprVector& field) const {
    ExprVector terms;
    for (const std::size_t p : pivots_) terms.push_back(form.components[p] * field[p]);
    return sum_of(terms, zero_.context());
  }

  bool vanishes_on_brackets(const OneForm& form) const {
    for (const ExprVector& field : brackets_) {
      const Expr value = value_on(form, field);
      if (vanishes_identically(value)) continue;
      for (const Bindings& point : points_)
        if (without_rounding(value, point) != 0) return false;
    }
    return true;
  }

  /// The integrable combinations of forms that are not integrable: rows of [form(brackets) | form | 1], the brackets
  /// eliminated.
  void combine(IntegrablePart& out) {
    std::vector<std::size_t> order;
    for (const bool wanted : {true, false})
      for (std::size_t i = 0; i < forms_.size(); ++i)
        if (out.integrable[i] == wanted) order.push_back(i);
    choose_rows(order);
    std::vector<std::size_t> rest;
    for (const std::size_t i : rows_)
      if (!out.integrable[i]) rest.push_back(i);
    const std::size_t b = brackets_.size(), count = variables_.size();
    if (rest.size() <= b) return;
    ExprMatrix m{rest.size(), b + count + rest.size(), {}};
    for (std::size_t k = 0; k < rest.size(); ++k) {
      for (const ExprVector& field : brackets_) m.entries.push_back(value_on(forms_[rest[k]], field));
      for (const Expr& a : forms_[rest[k]].components) m.entries.push_back(a);
      for (std::size_t l = 0; l < rest.size(); ++l) m.entries.push_back(k == l ? one_ : zero_);
    }
    const auto pivots = reduce_rows(m, b, b, *best_);
    for (std::size_t k = 0; k < rest.size(); ++k) {
      if (std::any_of(pivots.begin(), pivots.end(), [&](const auto& p) { return p.first == k; })) continue;
      IntegrablePart::Combination found;
      for (std::size_t j = 0; j < count; ++j) found.form.components.push_back(m.at(k, b + j));
      for (std::size_t l = 0; l < rest.size(); ++l)
        if (!m.at(k, b + count + l).is_zero()) found.forms.push_back(rest[l]);
      out.combinations.push_back(std::move(found));
    }
  }

  const std::vector<OneForm>& forms_;
  const ExprVector& variables_;
  const std::vector<Bindings>& points_;
  Expr zero_, one_;
  const Bindings* best_ = nullptr;   // a point where the forms have their full rank
  std::vector<std::size_t> rows_;    // independent forms
  std::vector<std::size_t> pivots_;  // variables that are solved for
  std::vector<Field> directions_;
  std::vector<ExprVector> brackets_;     // independent, beyond the directions
  std::vector<Matrix> bracket_numbers_;  // [points] their pivot components, a row each
};

/// Forms and variables that have to do with each other.
struct Group {
  std::vector<std::size_t> forms, variables;
};

/// Forms that share no variable, neither as a component nor in one, leave directions that commute: each group is looked
/// at alone.
std::vector<Group> independent_groups(const std::vector<OneForm>& forms, const ExprVector& variables) {
  std::vector<std::size_t> leader(variables.size());
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto find = [&](std::size_t v) {
    while (leader[v] != v) v = leader[v] = leader[leader[v]];
    return v;
  };
  std::unordered_map<Expr, std::size_t, ExprHash> index;
  for (std::size_t v = 0; v < variables.size(); ++v) index.emplace(variables[v], v);
  std::vector<std::size_t> first(forms.size(), 0);  // a form without variables goes to the first one
  for (std::size_t i = 0; i < forms.size(); ++i) {
    std::vector<std::size_t> touched;
    for (std::size_t v = 0; v < variables.size(); ++v)
      if (!forms[i].components[v].is_zero()) touched.push_back(v);
    for (const Expr& symbol : symbols_of(forms[i].components))
      if (const auto v = index.find(symbol); v != index.end()) touched.push_back(v->second);
    for (const std::size_t v : touched) leader[find(v)] = find(touched.front());
    if (!touched.empty()) first[i] = touched.front();
  }
  std::vector<Group> out;
  std::unordered_map<std::size_t, std::size_t> place;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const auto [at, is_new] = place.try_emplace(find(first[i]), out.size());
    if (is_new) out.emplace_back();
    out[at->second].forms.push_back(i);
  }
  for (std::size_t v = 0; v < variables.size(); ++v)
    if (const auto at = place.find(find(v)); at != place.end()) out[at->second].variables.push_back(v);
  return out;
}

/// What was found for a group, in terms of all forms and variables.
void put_back(const IntegrablePart& part, const Group& group, const ExprVector& variables, IntegrablePart& out) {
  out.rank += part.rank;
  out.integrable_rank += part.integrable_rank;
  for (std::size_t i = 0; i < group.forms.size(); ++i) out.integrable[group.forms[i]] = part.integrable[i];
  const Expr zero = variables[0].context().number(Rational(0));
  for (const IntegrablePart::Combination& found : part.combinations) {
    IntegrablePart::Combination whole;
    for (const std::size_t i : found.forms) whole.forms.push_back(group.forms[i]);
    whole.form.components.assign(variables.size(), zero);
    for (std::size_t v = 0; v < group.variables.size(); ++v)
      whole.form.components[group.variables[v]] = found.form.components[v];
    out.combinations.push_back(std::move(whole));
  }
}

}  // namespace

IntegrablePart integrable_part(const std::vector<OneForm>& forms, const ExprVector& variables,
                               const std::vector<Bindings>& points) {
  IntegrablePart out;
  out.integrable.assign(forms.size(), false);
  for (const Group& group : independent_groups(forms, variables)) {
    std::vector<OneForm> own(group.forms.size());
    ExprVector among;
    for (const std::size_t v : group.variables) among.push_back(variables[v]);
    for (std::size_t i = 0; i < own.size(); ++i)
      for (const std::size_t v : group.variables) own[i].components.push_back(forms[group.forms[i]].components[v]);
    put_back(Closure(own, among, points).find(), group, variables, out);
  }
  return out;
}

}  // namespace maupertuis
