radioslam_room(base
  SOURCES
    check.cpp
    parallel.cpp
    random.cpp
    suggestion.cpp
  LIBRARIES Threads::Threads)
