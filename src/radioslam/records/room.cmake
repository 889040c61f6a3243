radioslam_room(records
  SOURCES
    log_builder.cpp
    logs_of_mission.cpp
    mission_of_logs.cpp
    record_codec.cpp
    resumed_log.cpp
    team_log.cpp
  ROOMS mission)
