// One robot's place in a DDS domain: whom it finds there, and what does not fit.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "radioslam/io/dds/dds_config.hpp"
#include "radioslam/io/dds/dds_endpoint.hpp"

namespace radioslam {

using DdsEntity = std::int32_t;  ///< Cyclone's handle

/// Not to be used by several threads at once, but for its writers and readers.
class DdsDomain {
 public:
  /// Refuses (InputError) what Cyclone refuses, with its reasons.
  explicit DdsDomain(const DdsConfig& config);
  ~DdsDomain();
  DdsDomain(const DdsDomain&) = delete;
  DdsDomain& operator=(const DdsDomain&) = delete;

  /// What the user should know, a line each, no line twice: publishers and subscribers of the robot's own
  /// topics whose type or QoS does not match, what Cyclone reports, whose settings are in force, and buffers
  /// of the kernel that are too small. To be called now and then.
  std::vector<std::string> take_notes();

  /// All that are announced, own ones included.
  std::vector<DdsEndpoint> writers();
  std::vector<DdsEndpoint> readers();
  /// Participants besides this one.
  std::size_t others();

  DdsEntity participant() const { return participant_; }

 private:
  void note_settings(const DdsConfig& config, bool has_uri);

  DdsEntity domain_ = 0, participant_ = 0;
  DdsEntity all_participants_ = 0, all_writers_ = 0, all_readers_ = 0;  ///< readers of what is announced
  std::array<std::uint8_t, 16> guid_{};
  std::map<std::uint64_t, DdsEndpoint> known_writers_, known_readers_;  ///< by Cyclone's handles
  std::set<std::uint64_t> others_;
  std::vector<std::string> pending_;
  std::set<std::string> known_;  ///< all notes given
};

}  // namespace radioslam
