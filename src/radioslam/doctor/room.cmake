radioslam_room(doctor
  SOURCES
    check_mission.cpp
    corrections.cpp
    fingerprint_clock.cpp
    frame_checks.cpp
    inertial_checks.cpp
    link_checks.cpp
    link_fit.cpp
    moving_access_points.cpp
    odometry_checks.cpp
    recording_checks.cpp
    scan_checks.cpp
    team_links.cpp
    wifi_checks.cpp
    window_team.cpp
  ROOMS team_frame mission)
