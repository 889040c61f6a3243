# The page is written once as HTML, CSS and JavaScript in report/page and compiled in, together with d3.
radioslam_room(report
  SOURCES
    access_point_data.cpp
    aoa_data.cpp
    closure_data.cpp
    embedded_data.cpp
    map_data.cpp
    report.cpp
    rounding.cpp
    trajectory_data.cpp
  ROOMS mission results eval
  LIBRARIES nlohmann_json::nlohmann_json)
radioslam_page(radioslam_report ${CMAKE_CURRENT_SOURCE_DIR}/report/page radioslam/report/page_parts.hpp radioslam
  data.js format.js colours.js state.js chart.js maps.js map_layers.js map_view.js map_space.js map_panel.js headline.js errors.js
  agents.js stream.js hypotheses.js overlap.js places.js directions.js access_points.js signals.js similarity.js tables.js parameters.js main.js)
