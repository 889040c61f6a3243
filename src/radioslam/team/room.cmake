radioslam_room(team
  SOURCES
    agent.cpp
    agent_estimate.cpp
    known_logs.cpp
    messages.cpp
    peers.cpp
    scripted_robots.cpp
    virtual_team.cpp
  ROOMS live)
