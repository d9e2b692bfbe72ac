# CHOLMOD (SuiteSparse) and sequential MUMPS come from Debian without CMake packages, and CVODE is found the same way:
# imported targets for all.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
if(NOT TARGET tenon_dep::cholmod)
  add_library(tenon_dep::cholmod INTERFACE IMPORTED)
  target_include_directories(tenon_dep::cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
  target_link_libraries(tenon_dep::cholmod INTERFACE ${CHOLMOD_LIBRARY})
endif()

find_path(MUMPS_INCLUDE_DIR dmumps_c.h PATH_SUFFIXES mumps_seq mumps REQUIRED)
find_library(MUMPS_LIBRARY dmumps_seq REQUIRED)
if(NOT TARGET tenon_dep::mumps)
  add_library(tenon_dep::mumps INTERFACE IMPORTED)
  target_include_directories(tenon_dep::mumps SYSTEM INTERFACE ${MUMPS_INCLUDE_DIR})
  target_link_libraries(tenon_dep::mumps INTERFACE ${MUMPS_LIBRARY})
endif()

find_library(OPENBLAS_LIBRARY openblas REQUIRED)
if(NOT TARGET tenon_dep::blas)
  add_library(tenon_dep::blas INTERFACE IMPORTED)
  target_link_libraries(tenon_dep::blas INTERFACE ${OPENBLAS_LIBRARY})
endif()

# CVODE (SUNDIALS), the reference integrator.
find_path(CVODE_INCLUDE_DIR cvode/cvode.h REQUIRED)
find_library(CVODE_LIBRARY sundials_cvode REQUIRED)
find_library(NVECSERIAL_LIBRARY sundials_nvecserial REQUIRED)
if(NOT TARGET tenon_dep::cvode)
  add_library(tenon_dep::cvode INTERFACE IMPORTED)
  target_include_directories(tenon_dep::cvode SYSTEM INTERFACE ${CVODE_INCLUDE_DIR})
  target_link_libraries(tenon_dep::cvode INTERFACE ${CVODE_LIBRARY} ${NVECSERIAL_LIBRARY})
endif()
