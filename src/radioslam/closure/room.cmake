radioslam_room(closure SOURCES fingerprint_closures.cpp ROOMS team_frame graph)
