#pragma once
// Paths of rotations. A rotation matrix of the four numbers of a quaternion is one only where their squares add up to
// 1, and so d'Alembert's principle for a body holds along such paths alone, in tangent directions.
#include <array>
#include <cstddef>
#include <vector>

namespace maupertuis::certification {

/// p p / |p|²: the square of a quaternion has the square of its norm. Components (w, x, y, z), truncated power series
/// in t.
template <class Numbers>
class UnitQuaternion {
 public:
  using Scalar = typename Numbers::Value;
  using Series = std::vector<Scalar>;
  using Quaternion = std::array<Series, 4>;

  explicit UnitQuaternion(const Numbers& numbers) : numbers_(numbers) {}

  Quaternion from(const Quaternion& p) const {
    std::array<Series, 4> squares;
    for (std::size_t k = 0; k < 4; ++k) squares[k] = product(p[k], p[k]);
    const Series vector = sum(sum(squares[1], squares[2]), squares[3]), scale = inverse(sum(squares[0], vector));
    Quaternion out{product(sum(squares[0], negative(vector)), scale), {}, {}, {}};
    for (std::size_t k = 1; k < 4; ++k) {
      const Series half = product(product(p[0], p[k]), scale);
      out[k] = sum(half, half);
    }
    return out;
  }

  /// c − (c·q) q
  std::array<Scalar, 4> tangent(const std::array<Scalar, 4>& c, const Quaternion& q) const {
    Scalar along = numbers_.number(0);
    for (std::size_t k = 0; k < 4; ++k) along = numbers_.add(along, numbers_.multiply(c[k], q[k][0]));
    std::array<Scalar, 4> out;
    for (std::size_t k = 0; k < 4; ++k) out[k] = numbers_.add(c[k], numbers_.negate(numbers_.multiply(along, q[k][0])));
    return out;
  }

 private:
  Series sum(const Series& a, const Series& b) const {
    Series out;
    for (std::size_t k = 0; k < a.size(); ++k) out.push_back(numbers_.add(a[k], b[k]));
    return out;
  }
  Series negative(const Series& a) const {
    Series out;
    for (const Scalar& x : a) out.push_back(numbers_.negate(x));
    return out;
  }
  Scalar convolution(const Series& a, const Series& b, std::size_t first, std::size_t k) const {
    Scalar total = numbers_.number(0);
    for (std::size_t j = first; j <= k; ++j) total = numbers_.add(total, numbers_.multiply(a[j], b[k - j]));
    return total;
  }
  Series product(const Series& a, const Series& b) const {
    Series out;
    for (std::size_t k = 0; k < a.size(); ++k) out.push_back(convolution(a, b, 0, k));
    return out;
  }
  Series inverse(const Series& a) const {
    const Scalar first = numbers_.inverse(a[0]);
    Series out{first};
    for (std::size_t k = 1; k < a.size(); ++k)
      out.push_back(numbers_.negate(numbers_.multiply(first, convolution(a, out, 1, k))));
    return out;
  }

  const Numbers& numbers_;
};

}  // namespace maupertuis::certification
