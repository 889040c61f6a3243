radioslam_room(geometry
  SOURCES
    alignment.cpp
    cholesky.cpp
    ldlt.cpp
    local_frame.cpp
    matrix_products.cpp
    se2.cpp
    se3.cpp
    so3.cpp
    symmetric_eigen.cpp
  ROOMS base
  LIBRARIES Eigen3::Eigen)
# Large by themselves.
set_source_files_properties(geometry/cholesky.cpp geometry/ldlt.cpp geometry/symmetric_eigen.cpp
                            geometry/matrix_products.cpp
                            PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
