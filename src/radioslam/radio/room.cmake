radioslam_room(radio SOURCES fingerprint.cpp similarity.cpp distance_model.cpp decay_model.cpp measurements.cpp ROOMS mission)
