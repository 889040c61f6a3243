# The page is written once as HTML, CSS and JavaScript in report/page and compiled in, together with d3.
find_package(D3 5...<6 REQUIRED)
set(page_dir ${CMAKE_CURRENT_SOURCE_DIR}/report/page)
set(page_scripts)
# In the order in which they build on one another.
foreach(name IN ITEMS data format colours state chart map_layers map_view map_panel headline errors similarity
                      tables parameters main)
  list(APPEND page_scripts ${page_dir}/${name}.js)
endforeach()
string(REPLACE ";" "|" page_scripts_argument "${page_scripts}")
set(page_source ${PROJECT_BINARY_DIR}/report_page.cpp)
add_custom_command(OUTPUT ${page_source}
  COMMAND ${CMAKE_COMMAND} -DPAGE=${page_dir}/page.html -DSTYLE=${page_dir}/style.css
          "-DSCRIPTS=${page_scripts_argument}" -DD3=${D3_JS} -DLICENCE=${page_dir}/d3-licence.txt
          -DOUTPUT=${page_source} -P ${PROJECT_SOURCE_DIR}/cmake/EmbedPage.cmake
  DEPENDS ${page_dir}/page.html ${page_dir}/style.css ${page_dir}/d3-licence.txt ${page_scripts} ${D3_JS}
          ${PROJECT_SOURCE_DIR}/cmake/EmbedPage.cmake
  COMMENT "Embedding the report's page" VERBATIM)

radioslam_room(report
  SOURCES report.cpp page_data.cpp trajectory_data.cpp closure_data.cpp thinning.cpp
  ROOMS mission results eval LIBRARIES nlohmann_json::nlohmann_json)
target_sources(radioslam_report PRIVATE ${page_source})
