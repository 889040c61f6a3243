radioslam_room(study NOT_INSTALLED
  SOURCES
    aoa/aoa_paths.cpp
    aoa/aoa_table.cpp
    distributed_optimization/distributed_study.cpp
    distributed_optimization/simulated_teams.cpp
    evaluated_run.cpp
    fingerprints/fingerprint_tables.cpp
    fingerprints/sequence_table.cpp
    fingerprints/study_missions.cpp
    fingerprints/threshold_sweep.cpp
    oracle.cpp
    overlap_growth/overlap_growth.cpp
    rendezvous/rendezvous_json.cpp
    rendezvous/rendezvous_study.cpp
    robustness_map/robustness_map.cpp
    study_json.cpp
    study_page.cpp
    study_table.cpp
    team/team_study.cpp
    verification_budget/budget_study.cpp
    wi_closure/angle_paths.cpp
    wi_closure/place_settings.cpp
    wi_closure/place_study.cpp
    wi_closure/place_table.cpp
    wi_closure/place_truth.cpp
    wi_closure_hall/hall_tables.cpp
    wi_closure_hall/wi_closure_hall.cpp
    wi_closure_kitti/wi_closure_kitti.cpp
    wi_closure_table1/wi_closure_table1.cpp
  ROOMS radio rendezvous_world pipeline eval sim io report team
  LIBRARIES nlohmann_json::nlohmann_json)
radioslam_page(radioslam_study ${CMAKE_CURRENT_SOURCE_DIR}/study/page radioslam/study/page_parts.hpp
  radioslam::study_page ../../report/page/format.js data.js scheme.js heat_map.js growth.js budget.js distributed.js team.js rendezvous_charts.js rendezvous_map.js
  rendezvous.js ways.js directions.js table.js main.js)
