# lapack_libraries: what the regulator links (LAPACK and BLAS, BSD licence), or nothing where they are not installed.
set(lapack_libraries "")
find_library(LAPACK_LIBRARY lapack)
find_library(BLAS_LIBRARY blas)
if(LAPACK_LIBRARY AND BLAS_LIBRARY)
  set(lapack_libraries ${LAPACK_LIBRARY} ${BLAS_LIBRARY})
else()
  message(STATUS "LAPACK is not here: maup is built without the linear-quadratic regulator")
endif()
