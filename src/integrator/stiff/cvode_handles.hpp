#pragma once
#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <cvode/cvode_proj.h>
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

/// What CVODE allocates, freed in the right order.
class CvodeHandles {
 public:
  explicit CvodeHandles(std::size_t size) {
    require_success(SUNContext_Create(nullptr, &context));
    state = N_VNew_Serial(static_cast<sunindextype>(size), context);
    matrix = SUNDenseMatrix(static_cast<sunindextype>(size), static_cast<sunindextype>(size), context);
    solver = SUNLinSol_Dense(state, matrix, context);
    memory = CVodeCreate(CV_BDF, context);
    if (!state || !matrix || !solver || !memory) throw std::logic_error("the stiff method could not be set up; please report");
  }
  ~CvodeHandles() {
    CVodeFree(&memory);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(state);
    SUNContext_Free(&context);
  }
  CvodeHandles(const CvodeHandles&) = delete;
  CvodeHandles& operator=(const CvodeHandles&) = delete;

  SUNContext context = nullptr;
  N_Vector state = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;
  void* memory = nullptr;
};

inline std::span<double> values(N_Vector vector) {
  return {N_VGetArrayPointer(vector), static_cast<std::size_t>(N_VGetLength(vector))};
}

}  // namespace maupertuis::stiff
