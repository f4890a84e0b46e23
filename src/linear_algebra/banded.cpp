#include "linear_algebra/banded.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

double product(double a, double b) { return a * b; }
/// Without the care for infinities of C++, which costs a call.
std::complex<double> product(std::complex<double> a, std::complex<double> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
double inverse_of(double a) { return 1 / a; }
std::complex<double> inverse_of(std::complex<double> a) {
  const double square = a.real() * a.real() + a.imag() * a.imag();
  return {a.real() / square, -a.imag() / square};
}
double size_of(double a) { return std::abs(a); }
double size_of(std::complex<double> a) { return std::abs(a.real()) + std::abs(a.imag()); }

}  // namespace

template <typename T>
BandedMatrix<T>::BandedMatrix(std::size_t n, std::size_t below, std::size_t above)
    : n_(n),
      below_(below),
      above_(above),
      lift_(below + above),
      rows_(2 * below + above + 1),
      data_(n * rows_),
      pivots_(n) {}

template <typename T>
void BandedMatrix<T>::clear() {
  std::fill(data_.begin(), data_.end(), T(0));
}

template <typename T>
void BandedMatrix<T>::add_product(const T* x, T* y) const {
  for (std::size_t j = 0; j < n_; ++j)
    for (std::size_t i = first_row(j); i < end_row(j); ++i) y[i] += product(at(i, j), x[j]);
}

template <typename T>
bool BandedMatrix<T>::factor() {
  constexpr double rounding = 1e-14;
  std::vector<double> sizes(n_, 0);
  for (std::size_t j = 0; j < n_; ++j)
    for (std::size_t i = 0; i < rows_; ++i) sizes[j] = std::max(sizes[j], size_of(data_[j * rows_ + i]));
  std::size_t last = 0;  // the last column that pivoting so far has reached
  for (std::size_t k = 0; k < n_; ++k) {
    const std::size_t rows = std::min(below_, n_ - 1 - k);
    T* column = &at(k, k);
    std::size_t pivot = 0;
    for (std::size_t i = 1; i <= rows; ++i)
      if (size_of(column[i]) > size_of(column[pivot])) pivot = i;
    pivots_[k] = k + pivot;
    if (!(size_of(column[pivot]) > rounding * sizes[k])) return false;
    last = std::max(last, std::min(k + pivot + above_, n_ - 1));
    if (pivot != 0)
      for (std::size_t j = k; j <= last; ++j) std::swap(at(k, j), at(k + pivot, j));
    const T inverse = inverse_of(column[0]);
    for (std::size_t i = 1; i <= rows; ++i) column[i] = product(column[i], inverse);
    for (std::size_t j = k + 1; j <= last; ++j) {
      T* other = &at(k, j);
      const T factor = other[0];
      if (factor == T(0)) continue;
      for (std::size_t i = 1; i <= rows; ++i) other[i] -= product(column[i], factor);
    }
  }
  return true;
}

template <typename T>
void BandedMatrix<T>::solve(T* x) const {
  for (std::size_t k = 0; k < n_; ++k) {
    std::swap(x[k], x[pivots_[k]]);
    const T value = x[k];
    if (value == T(0)) continue;
    const T* column = &data_[k * rows_ + lift_];
    const std::size_t rows = std::min(below_, n_ - 1 - k);
    for (std::size_t i = 1; i <= rows; ++i) x[k + i] -= product(column[i], value);
  }
  for (std::size_t k = n_; k-- > 0;) {
    const T* column = &data_[k * rows_ + lift_];
    x[k] = product(x[k], inverse_of(column[0]));
    const T value = x[k];
    const std::size_t rows = std::min(lift_, k);
    for (std::size_t i = 1; i <= rows; ++i) x[k - i] -= product(column[-static_cast<std::ptrdiff_t>(i)], value);
  }
}

template class BandedMatrix<double>;
template class BandedMatrix<std::complex<double>>;

}  // namespace maupertuis
