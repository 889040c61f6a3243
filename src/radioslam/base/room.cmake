radioslam_room(base
  SOURCES
    check.cpp
    parallel.cpp
    random.cpp
    scratch_file.cpp
    suggestion.cpp
  LIBRARIES Threads::Threads)
