radioslam_room(study
  SOURCES oracle.cpp judged_run.cpp study_table.cpp wi_closure_kitti.cpp wi_closure_kitti_table.cpp
          robustness_map.cpp overlap_town.cpp overlap_growth.cpp robustness_summary.cpp aoa_links.cpp aoa_table.cpp aoa_paths.cpp sequence_table.cpp
          fingerprint_tables.cpp fingerprint_tables_table.cpp threshold_sweep.cpp fingerprint_json.cpp study_json.cpp study_page.cpp
  ROOMS radio pipeline eval sim io report LIBRARIES nlohmann_json::nlohmann_json)
radioslam_page(radioslam_study ${CMAKE_CURRENT_SOURCE_DIR}/study/page radioslam/study/page_parts.hpp
  radioslam::study_page ../../report/page/format.js data.js scheme.js heat_map.js growth.js directions.js table.js main.js)
