# radioslam_room(FOLDER [NOT_INSTALLED] SOURCES a.cpp ... ROOMS base ... LIBRARIES Eigen3::Eigen ...)
#
# Each room is one target and can include only the rooms it links, so that the compiler enforces the order of the rooms
# in docs/architecture.md: the include directory of a target contains a symbolic link to that room only. The target of
# io/dds is radioslam_io_dds.
# BUILD_SHARED_LIBS decides the kind of library. A shared room calls its own copies of inline functions, so that the
# sanitizer build checks them even where a program brings copies that were compiled without.
function(radioslam_room FOLDER)
  cmake_parse_arguments(ROOM "NOT_INSTALLED" "" "SOURCES;ROOMS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  string(REPLACE "/" "_" NAME ${FOLDER})
  set(room_include ${PROJECT_BINARY_DIR}/rooms/${NAME})
  get_filename_component(parent radioslam/${FOLDER} DIRECTORY)
  file(MAKE_DIRECTORY ${room_include}/${parent})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${FOLDER} ${room_include}/radioslam/${FOLDER} SYMBOLIC)

  list(TRANSFORM ROOM_ROOMS PREPEND radioslam_)
  list(TRANSFORM ROOM_SOURCES PREPEND ${FOLDER}/)
  set(kind "")
  set(scope PUBLIC)
  if(NOT ROOM_SOURCES)
    set(kind INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(radioslam_${NAME} ${kind} ${ROOM_SOURCES})
  add_library(radioslam::${NAME} ALIAS radioslam_${NAME})
  set_target_properties(radioslam_${NAME} PROPERTIES EXPORT_NAME ${NAME})
  target_include_directories(radioslam_${NAME} ${scope}
    $<BUILD_INTERFACE:${room_include}> $<INSTALL_INTERFACE:include>)
  target_link_libraries(radioslam_${NAME} ${scope} radioslam_settings ${ROOM_ROOMS} ${ROOM_LIBRARIES})
  if(ROOM_SOURCES)
    if(BUILD_SHARED_LIBS)
      target_link_options(radioslam_${NAME} PRIVATE LINKER:-Bsymbolic-functions)
    endif()
    target_link_libraries(radioslam_${NAME} PRIVATE $<BUILD_INTERFACE:radioslam_warnings>
                                                    ${ROOM_PRIVATE_LIBRARIES})
    radioslam_group_sources(radioslam_${NAME})
    if(NOT NAME STREQUAL base)  # which is small, and without Eigen
      radioslam_precompile(radioslam_${NAME} ${PROJECT_SOURCE_DIR}/cmake/precompiled.hpp)
    endif()
  endif()
  if(NOT ROOM_NOT_INSTALLED)
    set_property(GLOBAL APPEND PROPERTY RADIOSLAM_ROOMS radioslam_${NAME})
  endif()
endfunction()
