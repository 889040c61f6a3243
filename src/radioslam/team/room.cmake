radioslam_room(team
  SOURCES
    agent.cpp
    agent_estimate.cpp
    agent_scans.cpp
    known_logs.cpp
    messages.cpp
    peers.cpp
    scripted_robots.cpp
    virtual_network.cpp
    virtual_team.cpp
  ROOMS live)
