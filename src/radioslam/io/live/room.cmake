# Apart from io, so that only the program that serves a page loads the library.
radioslam_room(io/live NOT_INSTALLED
  SOURCES
    live_feed.cpp
    live_server.cpp
  ROOMS io
  PRIVATE_LIBRARIES Httplib::Httplib)
