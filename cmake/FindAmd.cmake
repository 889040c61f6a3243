# Finds SuiteSparse's AMD (BSD-3-Clause; none of SuiteSparse's GPL parts) and defines Amd::Amd.
find_path(AMD_INCLUDE_DIR amd.h PATH_SUFFIXES suitesparse)
find_library(AMD_LIBRARY amd)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Amd DEFAULT_MSG AMD_LIBRARY AMD_INCLUDE_DIR)
if(Amd_FOUND AND NOT TARGET Amd::Amd)
  add_library(Amd::Amd UNKNOWN IMPORTED)
  set_target_properties(Amd::Amd PROPERTIES IMPORTED_LOCATION ${AMD_LIBRARY}
                        INTERFACE_INCLUDE_DIRECTORIES ${AMD_INCLUDE_DIR})
endif()
mark_as_advanced(AMD_INCLUDE_DIR AMD_LIBRARY)
