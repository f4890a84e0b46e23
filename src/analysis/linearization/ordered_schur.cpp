#include "analysis/linearization/ordered_schur.hpp"

#include <vector>

#ifdef MAUPERTUIS_LAPACK

// LAPACK's own interface; the last two arguments are the lengths of the two strings, as gfortran passes them.
extern "C" void dgees_(const char* vectors, const char* sort, int (*select)(const double*, const double*), const int* n,
                       double* a, const int* rows, int* selected, double* real, double* imaginary, double* basis,
                       const int* basis_rows, double* work, const int* work_size, int* flags, int* info, std::size_t,
                       std::size_t);

namespace maupertuis {
namespace {
int in_left_half_plane(const double* real, const double*) { return *real < 0; }
}  // namespace

std::optional<Matrix> stable_subspace(const Matrix& matrix) {
  Matrix a = matrix;
  const int n = static_cast<int>(a.rows());
  Matrix basis(n, n);
  std::vector<double> real(static_cast<std::size_t>(n)), imaginary(static_cast<std::size_t>(n));
  std::vector<int> flags(static_cast<std::size_t>(n));
  int selected = 0, info = 0, work_size = -1;
  double wanted = 0;
  const auto call = [&](double* work) {
    dgees_("V", "S", in_left_half_plane, &n, a.data(), &n, &selected, real.data(), imaginary.data(), basis.data(), &n,
           work, &work_size, flags.data(), &info, 1, 1);
  };
  call(&wanted);  // asks for the size of the workspace
  work_size = static_cast<int>(wanted);
  std::vector<double> work(static_cast<std::size_t>(work_size));
  call(work.data());
  // info = n + 2: reordering moved an eigenvalue across the axis by rounding; then `selected` tells.
  if ((info != 0 && info != n + 2) || 2 * selected != n) return std::nullopt;
  return Matrix(basis.leftCols(selected));
}

}  // namespace maupertuis

#else

namespace maupertuis {
std::optional<Matrix> stable_subspace(const Matrix&) { return std::nullopt; }
}  // namespace maupertuis

#endif
