# Compiler settings shared by every target of the project.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(BUILD_SHARED_LIBS)
  include(GNUInstallDirs)
  set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# g++ collects its garbage less often: a tenth of its time, for up to 2 GB per job.
cmake_host_system_information(RESULT memory_mb QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR memory_per_job_mb "${memory_mb} / ${cores}")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND memory_per_job_mb GREATER 3000)
  add_compile_options(--param=ggc-min-heapsize=2000000)
endif()

add_library(radioslam_settings INTERFACE)
target_compile_features(radioslam_settings INTERFACE cxx_std_20)
target_compile_options(radioslam_settings INTERFACE
  # Reproducible results: no contraction of a*b+c, which compilers apply differently.
  -ffp-contract=off)

add_library(radioslam_warnings INTERFACE)
target_compile_options(radioslam_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wold-style-cast -Wcast-align -Wdouble-promotion -Wimplicit-fallthrough
  $<$<BOOL:${RADIOSLAM_WARNINGS_AS_ERRORS}>:-Werror>
  # g++ 12 reports uninitialised members inside Eigen's vectorised kernels (GCC bug 105593 and similar).
  # -Wrestrict has false positives for "literal" + std::string (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-uninitialized -Wno-array-bounds -Wno-stringop-overflow
                                  -Wno-restrict>
  # Grouped sources see each other's names, and g++ warns about lambdas that capture types of anonymous namespaces
  # because no source is the main file.
  $<$<BOOL:${RADIOSLAM_GROUP_SOURCES}>:-Wno-shadow>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${RADIOSLAM_GROUP_SOURCES}>>:-Wno-subobject-linkage>)
