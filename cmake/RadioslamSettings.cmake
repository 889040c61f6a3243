# Compiler settings shared by every target of the project.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_library(radioslam_settings INTERFACE)
target_compile_features(radioslam_settings INTERFACE cxx_std_20)
target_compile_options(radioslam_settings INTERFACE
  # The same bytes on every run: no contraction of a*b+c, which compilers choose differently.
  -ffp-contract=off)

add_library(radioslam_warnings INTERFACE)
target_compile_options(radioslam_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wold-style-cast -Wcast-align -Wdouble-promotion -Wimplicit-fallthrough
  $<$<BOOL:${RADIOSLAM_WARNINGS_AS_ERRORS}>:-Werror>
  # g++ 12 reports uninitialised members inside Eigen's own vectorised kernels (GCC bug 105593 and kin).
  # -Wrestrict is wrong about "literal" + std::string (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-uninitialized -Wno-array-bounds -Wno-stringop-overflow
                                  -Wno-restrict>
  # In a unity build sources see each other's names, and none is the main file, where g++ lets lambdas capture
  # types of anonymous namespaces.
  $<$<BOOL:${CMAKE_UNITY_BUILD}>:-Wno-shadow>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>)
