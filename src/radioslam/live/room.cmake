radioslam_room(live
  SOURCES
    scans_so_far.cpp
    stream_effort.cpp
    team_stream.cpp
  ROOMS front_end pipeline eval)
