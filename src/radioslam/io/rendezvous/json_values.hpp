// Values of JSON that another program wrote. Each is there, of its type and plausible; otherwise InputError
// names the value.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/geometry/se2.hpp"

namespace radioslam {

/// What a number may be.
struct NumberKind {
  double least, largest;
  const char* name;
};
inline constexpr NumberKind kAnyNumber{-1e9, 1e9, "a number from -1e9 to 1e9"};
inline constexpr NumberKind kNotNegative{0, 1e9, "a number from 0 to 1e9"};
inline constexpr NumberKind kPositive{std::numeric_limits<double>::denorm_min(), 1e9,
                                      "a positive number up to 1e9"};
inline constexpr NumberKind kDecibels{-1000, 1000, "a number from -1000 to 1000"};
/// What records have room for.
inline constexpr NumberKind kMetres{-9e6, 9e6, "a number from -9e6 to 9e6"};
/// Also of a clock that counts from 1970.
inline constexpr NumberKind kSeconds{-2e9, 2e9, "a time in seconds"};

/// Longest name of a robot in bytes.
inline constexpr std::size_t kLongestName = 100;
/// Whether the name can be a robot's: one of a record, not too long, and not "*", which means all robots.
bool is_robot_name(std::string_view name);

[[noreturn]] void refuse_json(const std::string& reason);

/// Refuses (InputError) what is not one JSON value, and what would take far more memory than the text.
nlohmann::json parse_json(std::string_view text);

/// An object; `name` is for error messages.
class JsonObject {
 public:
  using Json = nlohmann::json;

  /// Refuses other values than objects. Members of drivers' own may be there, unless their names are
  /// almost those of members that are read (refuse_misspelt).
  JsonObject(const Json& json, std::string name);

  /// Whether the member is there and not null.
  bool has(std::string_view member) const;
  /// Each of these refuses a missing member, and one of another kind.
  const Json& at(std::string_view member) const;
  double number(std::string_view member, const NumberKind& kind = kAnyNumber) const;
  std::uint64_t whole_number(std::string_view member, std::uint64_t largest) const;
  bool flag(std::string_view member) const;
  std::string robot(std::string_view member) const;
  /// A robot's name, or "" for none.
  std::string robot_or_none(std::string_view member) const;
  const Json& list(std::string_view member) const;
  /// [x, y, yaw]
  SE2 pose(std::string_view member) const;

  /// Refuses a member that was not asked for and is spelt almost like one that was. To be called last.
  void refuse_misspelt() const;

  [[noreturn]] void fail(std::string_view member, std::string_view what) const;

 private:
  const Json& json_;
  std::string name_;
  mutable std::vector<std::string_view> asked_;  ///< members, literals of the callers
};

/// A list of so many values, read from left to right; `name` is for error messages.
class JsonRow {
 public:
  JsonRow(const nlohmann::json& json, std::string_view name, std::size_t length);

  double number(const NumberKind& kind = kAnyNumber);
  std::uint64_t whole_number(std::uint64_t largest);
  /// x, y, yaw
  SE2 pose();

 private:
  const nlohmann::json& next() { return json_[place_++]; }
  [[noreturn]] void fail(std::string_view what) const;

  const nlohmann::json& json_;
  std::string_view name_;
  std::size_t place_ = 0;
};

}  // namespace radioslam
