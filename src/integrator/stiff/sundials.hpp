#pragma once
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cstddef>
#include <span>
#include <stdexcept>

namespace maupertuis::stiff {

inline void require_success(int flag) {
  if (flag < 0) throw std::logic_error("the stiff method could not be set up; please report");
}

template <class Pointer>
Pointer require_memory(Pointer pointer) {
  if (!pointer) throw std::logic_error("the stiff method could not be set up; please report");
  return pointer;
}

/// The errors of SUNDIALS are told by their codes, not on the terminal.
inline void say_nothing(int, const char*, const char*, char*, void*) {}

class Context {
 public:
  Context() { require_success(SUNContext_Create(nullptr, &context_)); }
  ~Context() { SUNContext_Free(&context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  operator SUNContext() const { return context_; }

 private:
  SUNContext context_ = nullptr;
};

/// A vector of SUNDIALS, with its own numbers or over those of somebody else.
class Vector {
 public:
  Vector(std::size_t size, SUNContext context)
      : vector_(require_memory(N_VNew_Serial(static_cast<sunindextype>(size), context))) {
    N_VConst(0, vector_);
  }
  Vector(std::span<double> over, SUNContext context)
      : vector_(require_memory(N_VMake_Serial(static_cast<sunindextype>(over.size()), over.data(), context))) {}
  ~Vector() { N_VDestroy(vector_); }
  Vector(const Vector&) = delete;
  Vector& operator=(const Vector&) = delete;
  operator N_Vector() const { return vector_; }

 private:
  N_Vector vector_;
};

inline std::span<double> values(N_Vector vector) {
  return {N_VGetArrayPointer(vector), static_cast<std::size_t>(N_VGetLength(vector))};
}

/// A dense matrix, by columns, and the solver that factors it.
class DenseSolver {
 public:
  DenseSolver(N_Vector like, SUNContext context) {
    const sunindextype size = N_VGetLength(like);
    matrix = require_memory(SUNDenseMatrix(size, size, context));
    solver = require_memory(SUNLinSol_Dense(like, matrix, context));
  }
  ~DenseSolver() {
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
  }
  DenseSolver(const DenseSolver&) = delete;
  DenseSolver& operator=(const DenseSolver&) = delete;

  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;
};

}  // namespace maupertuis::stiff
