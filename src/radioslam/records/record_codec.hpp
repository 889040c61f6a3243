// Records as bytes (docs/formats.md, "Logs of robots"): poses and covariances as 32-bit numbers, of poses in
// the plane and their covariances three and six of them; stamps and counts in base 128.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/records/record.hpp"

namespace radioslam {

inline constexpr std::size_t kMaxRecordBytes = 8192;
inline constexpr std::size_t kMaxReadings = 255;  ///< of a fingerprint

/// Whether the text can be a name of a robot, anchor, antenna or access point: docs/formats.md,
/// "Conventions".
bool is_record_name(std::string_view text);

/// Whether names, counts and numbers are within what a record may have.
bool is_valid(const Record& record);

/// Needs a valid record.
std::string encode(const Record& record);

/// The record, or nothing unless these are all the bytes of a valid one. Never reads beyond them; cost linear
/// in their number.
std::optional<Record> decode_record(std::string_view bytes);

}  // namespace radioslam
