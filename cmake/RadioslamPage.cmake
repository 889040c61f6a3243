# radioslam_page(TARGET FOLDER HEADER NAMESPACE SCRIPTS...)
#
# Compiles a page into a room: FOLDER/page.html with its style, the scripts in the order of their dependencies, and d3.
# HEADER declares page_head() and page_tail() in NAMESPACE. Style and licence are shared with the report's page.
find_package(D3 5...<6 REQUIRED)
set(RADIOSLAM_REPORT_PAGE ${PROJECT_SOURCE_DIR}/src/radioslam/report/page)

function(radioslam_page TARGET FOLDER HEADER NAMESPACE)
  set(scripts ${ARGN})
  list(TRANSFORM scripts PREPEND ${FOLDER}/)
  string(REPLACE ";" "|" scripts_argument "${scripts}")
  set(style ${RADIOSLAM_REPORT_PAGE}/style.css)
  set(licence ${RADIOSLAM_REPORT_PAGE}/d3-licence.txt)
  set(embed ${PROJECT_SOURCE_DIR}/cmake/EmbedPage.cmake)
  set(source ${PROJECT_BINARY_DIR}/${TARGET}_page.cpp)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DPAGE=${FOLDER}/page.html -DSTYLE=${style} "-DSCRIPTS=${scripts_argument}"
            -DD3=${D3_JS} -DLICENCE=${licence} -DHEADER=${HEADER} -DNAMESPACE=${NAMESPACE} -DOUTPUT=${source}
            -P ${embed}
    DEPENDS ${FOLDER}/page.html ${style} ${licence} ${scripts} ${D3_JS} ${embed}
    COMMENT "Embedding the page of ${TARGET}" VERBATIM)
  target_sources(${TARGET} PRIVATE ${source})
endfunction()
