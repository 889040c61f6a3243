radioslam_room(sim SOURCES lane_grid.cpp drive.cpp wheel_odometry.cpp shadowing.cpp transmitters.cpp phones.cpp
                           carpark.cpp scenarios.cpp ROOMS base geometry mission)
