radioslam_room(eval SOURCES association.cpp statistics.cpp metrics.cpp closures.cpp team_estimate.cpp ROOMS results mission)
