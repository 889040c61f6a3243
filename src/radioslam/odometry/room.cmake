radioslam_room(odometry
  SOURCES
    imu_gate.cpp
    imu_motion_prior.cpp
    lidar_inertial_smoothing.cpp
    map_drift.cpp
    motion_distortion.cpp
    scan_front_end.cpp
    scan_stage.cpp
    scan_tracker.cpp
    scan_tracking.cpp
    scans_on_odometry.cpp
    sensor_history.cpp
  ROOMS lidar places inertial mission)
