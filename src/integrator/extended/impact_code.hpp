#pragma once
#include "integrator/extended/contact_point.hpp"
#include "integrator/extended/space_impulse.hpp"
#include "linear_algebra/combinations.hpp"
#include "linear_algebra/plane_impulse.hpp"

namespace maupertuis::extended {

/// What contacts that are hit do to the velocities (impact.cpp of simulation/contact, over T): one after the other, the
/// one whose |ġ|/√(G M⁻¹ Gᵀ) is largest first, with Newton's restitution or with Stronge's energetic one where there is
/// friction; or all at once by complementarity.
template <class T>
class Impact {
 public:
  struct Blow {
    std::size_t contact;
    T impulse, speed;  // Λ; −ġ before
  };

  /// `here`: evaluated at the point. `contacts`: those that touch; `plastic`: e = 0 for all of them.
  Impact(const ContactPoint<T>& point, const Workspace<T>& here, std::span<const std::size_t> contacts,
         const ExtendedContacts& all, bool plastic)
      : n_(here.program().freedoms), contacts_(contacts.begin(), contacts.end()) {
    const Responses<T> responses(here);
    for (const std::size_t c : contacts_) {
      Row row;
      row.drive = point.drive[c], row.restitution = plastic ? T(0) : point.restitution[c];
      row.normal = point.normal[c], row.response = responses.of(point.normal[c]);
      const auto& friction = all.frictions[c];
      row.rubs = friction.present && (friction.sticking || point.friction[c] > 0 || point.fixed[c] > 0);
      if (row.rubs) {
        row.tangent = point.tangent[c], row.tangent_response = responses.of(point.tangent[c]);
        row.slip_drive = point.slip_drive[c], row.sticking = friction.sticking;
        row.friction = point.friction[c], row.fixed = point.fixed[c];
      }
      if (row.rubs && friction.in_space) {
        row.second_tangent = point.second_tangent[c], row.second_response = responses.of(point.second_tangent[c]);
        row.second_drive = point.second_drive[c];
      }
      rows_.push_back(std::move(row));
    }
  }

  T rate(std::size_t k, std::span<const T> v) const { return rows_[k].drive + along<T>(rows_[k].normal, v); }

  /// Rates below `rest` [contacts] are 0. Nothing where the impulses do not come to an end.
  std::optional<std::vector<Blow>> one_after_the_other(std::vector<T>& v, std::span<const T> rest) const {
    constexpr std::size_t most = 1000;  // a contact
    std::vector<Blow> out;
    for (;;) {
      std::optional<std::size_t> next;
      T fastest = T(0);
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        const T closing = -rate(k, v);
        if (!(closing > rest[k])) continue;
        const T speed = closing / sqrt(along<T>(rows_[k].normal, rows_[k].response));
        if (!next || speed > fastest * (1 + T(1e-12))) next = k, fastest = speed;
      }
      if (!next) return out;
      if (out.size() >= most * rows_.size()) return std::nullopt;
      const auto blow = strike(*next, v);
      if (!blow) return std::nullopt;
      out.push_back(*blow);
    }
  }

  /// 0 ≤ Λ ⟂ ġ⁺ + e ġ⁻ ≥ 0, without friction: the contacts that press are looked for among all sets of them. Nothing
  /// where none is found.
  std::optional<std::vector<Blow>> all_at_once(std::vector<T>& v) const {
    constexpr std::size_t most = 4096;  // sets
    const std::size_t count = rows_.size();
    std::vector<T> matrix(count * count), wanted(count);
    for (std::size_t a = 0; a < count; ++a) {
      const T before = rate(a, v);
      wanted[a] = -(1 + (before > 0 ? T(0) : rows_[a].restitution)) * before;
      for (std::size_t b = 0; b < count; ++b) matrix[a * count + b] = along<T>(rows_[a].normal, rows_[b].response);
    }
    Combinations sets(std::vector<std::size_t>(count, 2), most);
    for (std::size_t turn = 0; const std::vector<std::size_t>* set = sets.number(turn); ++turn) {
      const auto impulses = pressing(matrix, wanted, *set);
      if (!impulses) continue;
      std::vector<Blow> out;
      for (std::size_t a = 0; a < count; ++a)
        if ((*impulses)[a] > 0) out.push_back({contacts_[a], (*impulses)[a], T(-rate(a, v))});
      for (std::size_t a = 0; a < count; ++a)
        for (std::size_t i = 0; i < n_; ++i) v[i] += (*impulses)[a] * rows_[a].response[i];
      return out;
    }
    return std::nullopt;
  }

 private:
  struct Row {
    T drive = T(0), restitution = T(0), slip_drive = T(0), friction = T(0), fixed = T(0);
    std::vector<T> normal, response;                 // ∂g/∂q; what a unit of impulse changes in q̇
    std::vector<T> tangent, tangent_response;        // the same for ∂v_t/∂q̇, where it rubs
    std::vector<T> second_tangent, second_response;  // of the second component, in space
    T second_drive = T(0);
    bool rubs = false, sticking = false;
  };

  /// Normal impulse, and those along the two directions in the plane of contact.
  static std::optional<std::array<T, 3>> impulses_in_space(const Row& row, std::span<const T> v) {
    const std::vector<T>* const rows[] = {&row.normal, &row.tangent, &row.second_tangent};
    const std::vector<T>* const responses[] = {&row.response, &row.tangent_response, &row.second_response};
    const T drives[] = {row.drive, row.slip_drive, row.second_drive};
    std::array<std::array<T, 3>, 3> w;
    std::array<T, 3> before;
    for (std::size_t i = 0; i < 3; ++i) {
      before[i] = drives[i] + along<T>(*rows[i], v);
      for (std::size_t j = 0; j < 3; ++j) w[i][j] = along<T>(*rows[i], *responses[j]);
    }
    if (!row.sticking) return SpaceImpact<T>(w, before, row.friction, row.fixed, row.restitution).follow();
    // What never slides takes the slip at once.
    std::vector<T> matrix, wanted{T(-(1 + row.restitution) * before[0]), T(-before[1]), T(-before[2])};
    for (const auto& line : w) matrix.insert(matrix.end(), line.begin(), line.end());
    LinearSolver<T> solver;
    solver.factor(matrix, 3, epsilon_to<T>(0.9));
    solver.solve(wanted);
    return std::array<T, 3>{wanted[0], wanted[1], wanted[2]};
  }

  std::optional<Blow> strike_in_space(std::size_t k, std::vector<T>& v) const {
    const Row& row = rows_[k];
    const T before = rate(k, v);
    const auto found = impulses_in_space(row, v);
    if (!found) return std::nullopt;
    for (std::size_t i = 0; i < n_; ++i)
      v[i] +=
          (*found)[0] * row.response[i] + (*found)[1] * row.tangent_response[i] + (*found)[2] * row.second_response[i];
    return Blow{contacts_[k], (*found)[0], T(-before)};
  }

  std::optional<Blow> strike(std::size_t k, std::vector<T>& v) const {
    const Row& row = rows_[k];
    if (!row.second_tangent.empty()) return strike_in_space(k, v);
    const T before = rate(k, v), w_nn = along<T>(row.normal, row.response);
    ImpulseOf<T> found{(1 + row.restitution) * -before / w_nn, T(0)};
    if (row.rubs) {
      ImpulseCourse<T> course;
      course.w_nn = w_nn, course.w_nt = along<T>(row.normal, row.tangent_response);
      course.w_tt = along<T>(row.tangent, row.tangent_response);
      course.friction = row.friction, course.static_friction = row.fixed, course.sticking = row.sticking;
      course.v_n = before, course.v_t = row.slip_drive + along<T>(row.tangent, v);
      found = impulse_in_plane<T>(course, row.restitution);
    }
    for (std::size_t i = 0; i < n_; ++i) {
      v[i] += found.normal * row.response[i];
      if (row.rubs) v[i] += found.tangential * row.tangent_response[i];
    }
    return Blow{contacts_[k], found.normal, T(-before)};
  }

  /// The impulses of a set (0: in it), and whether they press and no other contact closes more than it may.
  std::optional<std::vector<T>> pressing(const std::vector<T>& matrix, const std::vector<T>& wanted,
                                         const std::vector<std::size_t>& set) const {
    const std::size_t count = wanted.size();
    std::vector<std::size_t> in;
    for (std::size_t a = 0; a < count; ++a)
      if (set[a] == 0) in.push_back(a);
    std::vector<T> part, right, out(count, T(0));
    T largest = T(0);
    for (const std::size_t a : in) {
      right.push_back(wanted[a]);
      for (const std::size_t b : in) part.push_back(matrix[a * count + b]);
    }
    for (const T& x : wanted) largest = std::max(largest, T(abs(x)));
    LinearSolver<T> solver;
    solver.factor(part, in.size(), epsilon_to<T>(0.9));
    solver.solve(right);
    const T rounding = 1024 * epsilon<T>();
    for (std::size_t k = 0; k < in.size(); ++k) {
      const T size = largest / matrix[in[k] * count + in[k]];
      if (right[k] < -rounding * size) return std::nullopt;
      out[in[k]] = right[k] > rounding * size ? right[k] : T(0);
    }
    for (std::size_t a = 0; a < count; ++a) {
      T changed = -wanted[a];
      for (const std::size_t b : in) changed += matrix[a * count + b] * out[b];
      if (changed < -rounding * largest) return std::nullopt;
    }
    return out;
  }

  std::size_t n_;
  std::vector<std::size_t> contacts_;
  std::vector<Row> rows_;
};

}  // namespace maupertuis::extended
