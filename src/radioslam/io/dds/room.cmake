# Apart from io, so that only programs that join a domain load the library, which takes 7 ms.
radioslam_room(io/dds
  SOURCES
    dds_config.cpp
    dds_domain.cpp
    dds_endpoint.cpp
    dds_names.cpp
    dds_topic.cpp
    raw_type.cpp
    team_channel.cpp
  ROOMS io
  PRIVATE_LIBRARIES CycloneDDS::ddsc)
