radioslam_room(doctor
  SOURCES
    check_mission.cpp
    corrections.cpp
    fingerprint_clock.cpp
    inertial_checks.cpp
    link_checks.cpp
    link_fit.cpp
    moving_access_points.cpp
    odometry_checks.cpp
    odometry_noise.cpp
    recording_checks.cpp
    scan_checks.cpp
    stale_scans.cpp
    team_links.cpp
    wifi_checks.cpp
  ROOMS team_frame mission)
