radioslam_room(base
  SOURCES
    check.cpp
    parallel.cpp
    random.cpp
  LIBRARIES Threads::Threads)
