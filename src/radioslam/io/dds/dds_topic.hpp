// Writers and readers of one topic, whose samples are bytes in CDR: those that a recording has.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/dds/dds_domain.hpp"

struct ddsi_sertype;

namespace radioslam {

/// Of a topic's writer or reader; as ROS 2 has them by default.
struct DdsQos {
  DdsReliability reliability = DdsReliability::kReliable;
  DdsDurability durability = DdsDurability::kVolatile;
  std::int32_t depth = 10;      ///< the last samples are kept, so many
  double longest_wait_s = 0.1;  ///< of a reliable writer whose readers do not keep up
};

/// Topics and types have their names in DDS (dds_names.hpp). A writer or reader must not outlive its domain.
class DdsWriter {
 public:
  DdsWriter(DdsDomain& domain, const std::string& topic, const std::string& type, const DdsQos& qos = {});
  ~DdsWriter();
  DdsWriter(const DdsWriter&) = delete;
  DdsWriter& operator=(const DdsWriter&) = delete;

  /// False if readers that asked for reliability did not keep up; the sample is then lost to them.
  /// May be called by any thread. `cdr` begins with its encapsulation: 0 1 0 0 for little endian.
  [[nodiscard]] bool write(std::string_view cdr);
  /// Readers of others that match.
  std::size_t matched() const;
  /// Whether all that was written has arrived at the readers that asked for reliability.
  bool is_acknowledged() const;

 private:
  DdsEntity topic_ = 0, writer_ = 0;
  ddsi_sertype* type_ = nullptr;
};

class DdsReader {
 public:
  struct Sample {
    std::string_view cdr;  ///< up to three bytes of padding may follow the message
    Stamp sent;            ///< by the clock of whoever sent it
    std::uint64_t writer = 0;
  };
  using Take = std::function<void(const Sample&)>;

  /// With `take`, samples are passed to it by a thread of Cyclone's, one at a time; it should be quick and
  /// must not throw. Without, they wait for take(). Samples of this robot's own writers are not read.
  DdsReader(DdsDomain& domain, const std::string& topic, const std::string& type, const DdsQos& qos = {},
            Take take = {});
  /// When it returns, nothing is passed on any more.
  ~DdsReader();
  DdsReader(const DdsReader&) = delete;
  DdsReader& operator=(const DdsReader&) = delete;

  /// Passes on what has arrived; the number of samples.
  std::size_t take(const Take& take);
  /// Samples that were lost on the way or by the reader's depth.
  std::uint64_t lost() const;
  std::size_t matched() const;

 private:
  static std::size_t take_from(DdsEntity reader, const Take& take);

  DdsEntity topic_ = 0, reader_ = 0;
  Take take_;
};

}  // namespace radioslam
