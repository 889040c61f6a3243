radioslam_room(eval SOURCES association.cpp statistics.cpp metrics.cpp closures.cpp ROOMS results mission)
