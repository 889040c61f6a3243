radioslam_room(results ROOMS mission)
