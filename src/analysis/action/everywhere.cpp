#include "analysis/action/everywhere.hpp"

#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/size_of_terms.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::action {
namespace {

constexpr double disk_ratios[] = {16, 8, 5, 3.5, 2.5};  // of a disk about a piece to half of it
constexpr double shortest_piece = 0x1p-200;             // of the whole
constexpr std::size_t most_pieces = 100'000, most_gaps = 5'000;
constexpr double enough = 1e-16;  // of the size of the integral: all bounds together
constexpr double no_rest = 1e-6;  // of it: what a gap counts in an integral that converges

bool can_be_cut(const Piece& piece, const Piece& whole) {
  return !piece.is_point() && piece.width() > shortest_piece * whole.width();
}

FunctionKernel kernel_of_time(const MechanicalSystem& system, const ExprVector& functions) {
  FunctionSource source;
  source.inputs = {system.context->time()};
  for (const Parameter& p : system.parameters) source.parameters.push_back(p.symbol);
  source.outputs = functions;
  return build_function(source);
}

/// A piece of an integral.
struct Part {
  Piece piece;
  double value = 0, size = 0, bound = 0;
  /// Which is cut first: the largest bound; where nothing is known the shortest, so that a place is followed to its
  /// end.
  bool operator<(const Part& other) const {
    return bound != other.bound ? bound < other.bound : piece.width() > other.piece.width();
  }
};

class Summation {
 public:
  Summation(const MechanicalSystem& system, Expr f, const Piece& whole, const Vector& points, const Vector& weights)
      : function_(system, {f, size_of_terms(f)}), whole_(whole), points_(points), weights_(weights) {}

  Integral run(const StopFlag* interrupt) {
    push(whole_);
    while (!is_enough()) {
      if (interrupt && interrupt->load()) break;
      if (open_.size() > most_pieces) return told(Integral::Told::TooRough, open_.front().piece);
      std::pop_heap(open_.begin(), open_.end());
      const Part part = open_.back();
      open_.pop_back();
      if (!can_be_cut(part.piece, whole_)) {
        if (!std::isfinite(part.value)) return told(Integral::Told::NotFinite, part.piece);
        gaps_.push_back(part);
        continue;
      }
      push({part.piece.from, part.piece.middle()});
      push({part.piece.middle(), part.piece.to});
    }
    return sum();
  }

 private:
  void push(const Piece& piece) {
    Part part{piece};
    for (Index g = 0; g < points_.size(); ++g) {
      const auto f = function_.at(piece.from + piece.width() * (1 + points_[g]) / 2);
      part.value += piece.width() / 2 * weights_[g] * f[0];
      part.size += piece.width() / 2 * weights_[g] * f[1];
    }
    // Gauss's rule is exact for these polynomials, and weighs what they leave out as the integral does.
    const double left_out = function_.left_out(piece, static_cast<int>(2 * points_.size() - 1))[0];
    part.bound = std::isfinite(part.value) ? 2 * piece.width() * left_out : HUGE_VAL;
    if (!std::isfinite(part.size)) part.size = std::abs(part.value);
    open_.push_back(part);
    std::push_heap(open_.begin(), open_.end());
  }

  /// Looked at now and then: the size of the whole is a sum over all pieces.
  bool is_enough() {
    if (open_.empty()) return true;
    const double bound = open_.front().bound;
    if (!std::isfinite(bound)) return false;
    if (open_.size() >= next_look_ || bound * static_cast<double>(open_.size()) <= enough * size_) {
      size_ = 0;
      for (const auto* parts : {&open_, &gaps_})
        for (const Part& p : *parts) size_ += p.size;
      next_look_ = open_.size() + open_.size() / 4 + 1;
    }
    return bound * static_cast<double>(open_.size()) <= enough * size_;
  }

  Integral told(Integral::Told what, const Piece& piece) const {
    Integral out;
    out.told = what;
    out.at = piece.middle();
    return out;
  }

  /// The end of the whole, where the gap lies there.
  double place_of_gap(const Piece& gap) const {
    return gap.from == whole_.from ? gap.from : gap.to == whole_.to ? gap.to : gap.middle();
  }

  Integral sum() {
    Integral out;
    double rest = 0, largest = -1;
    for (const Part& gap : gaps_) {
      rest += gap.size;
      if (gap.size > largest) largest = gap.size, out.at = place_of_gap(gap.piece);
    }
    std::vector<Part> all = open_;
    all.insert(all.end(), gaps_.begin(), gaps_.end());
    std::sort(all.begin(), all.end(), [](const Part& a, const Part& b) { return a.piece.from < b.piece.from; });
    ExactSum value;
    for (const Part& p : all) {
      value.add(p.value);
      out.size += p.size;
      out.pieces.push_back(p.piece);
    }
    for (const Part& p : open_) out.left_out += p.bound;
    out.left_out += rest;
    out.value = value.value();
    if (rest > no_rest * out.size) out.told = Integral::Told::Diverges;
    return out;
  }

  Everywhere function_;
  Piece whole_;
  const Vector &points_, &weights_;
  std::vector<Part> open_, gaps_;  // the first a heap
  double size_ = 0;
  std::size_t next_look_ = 0;
};

}  // namespace

Everywhere::Everywhere(const MechanicalSystem& system, const ExprVector& functions)
    : kernel_(kernel_of_time(system, functions)),
      work_(kernel_),
      disks_(kernel_, parameter_values(system)),
      out_(functions.size()),
      left_out_(functions.size()) {
  work_.set_parameters(parameter_values(system));
}

std::span<const double> Everywhere::at(double t) {
  work_.evaluate({&t, 1}, out_);
  return out_;
}

std::span<const double> Everywhere::left_out(const Piece& piece, int degree) {
  std::fill(left_out_.begin(), left_out_.end(), HUGE_VAL);
  const double centre = piece.middle(), half = std::max(piece.to - centre, centre - piece.from);
  disks_.set_centre({&centre, 1});
  for (const double ratio : disk_ratios) {
    const double reach = ratio * half, share = std::pow(ratio, -(degree + 1)) / (1 - 1 / ratio);
    disks_.evaluate({&reach, 1});
    for (std::size_t k = 0; k < left_out_.size(); ++k) left_out_[k] = std::min(left_out_[k], share * disks_.tail(k));
  }
  return left_out_;
}

Integral integrate(const MechanicalSystem& system, Expr f, const Piece& whole, const Vector& points,
                   const Vector& weights, const StopFlag* interrupt) {
  return Summation(system, f, whole, points, weights).run(interrupt);
}

Visit visit(Everywhere& functions, const Piece& whole, int degree,
            const std::function<bool(const Piece&, std::span<const double>)>& small, const StopFlag* interrupt) {
  Visit out;
  std::vector<Piece> open{whole};
  while (!open.empty()) {
    if (out.pieces.size() > most_pieces || out.gaps.size() > most_gaps || (interrupt && interrupt->load()))
      return out.whole = false, out;
    const Piece piece = open.back();
    open.pop_back();
    if (small(piece, functions.left_out(piece, degree))) {
      out.pieces.push_back(piece);
    } else if (can_be_cut(piece, whole)) {
      open.push_back({piece.middle(), piece.to});
      open.push_back({piece.from, piece.middle()});
    } else {
      out.gaps.push_back(piece);
    }
  }
  return out;
}

}  // namespace maupertuis::action
