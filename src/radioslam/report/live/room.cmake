# The page of an agent while it runs: its state as data, and the report's own style and scripts.
radioslam_room(report/live NOT_INSTALLED
  SOURCES
    live_changes.cpp
    live_page.cpp
  ROOMS report
  LIBRARIES nlohmann_json::nlohmann_json)
radioslam_page(radioslam_report_live ${CMAKE_CURRENT_SOURCE_DIR}/report/live/page radioslam/report/live/live_page_parts.hpp
  radioslam::live_page
  ../../page/data.js ../../page/format.js ../../page/colours.js ../../page/state.js ../../page/chart.js ../../page/maps.js
  ../../page/map_layers.js ../../page/map_view.js ../../page/map_space.js ../../page/map_panel.js ../../page/headline.js
  ../../page/overlap.js live_state.js live_map.js live_tables.js live_charts.js live_main.js)
