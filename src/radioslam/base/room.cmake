radioslam_room(base
  SOURCES
    base64.cpp
    check.cpp
    parallel.cpp
    random.cpp
    scratch_file.cpp
    suggestion.cpp
  LIBRARIES Threads::Threads)
