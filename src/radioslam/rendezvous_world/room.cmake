radioslam_room(rendezvous_world
  SOURCES
    rendezvous_run.cpp
    run_json.cpp
    run_record.cpp
    simulated_team.cpp
  ROOMS rendezvous sim
  LIBRARIES nlohmann_json::nlohmann_json)
