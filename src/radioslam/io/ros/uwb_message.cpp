#include "radioslam/io/ros/uwb_message.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

constexpr std::array kRangeNames{"range", "distance", "dis", "dist"};
constexpr std::array kToNames{"toid",       "responderid", "destinationid", "destid",     "dstid",
                              "anchorid",   "id2",         "uwbid2",        "receiverid", "rxid",
                              "neighborid", "remoteid",    "targetid",      "to"};
constexpr std::array kFromNames{"fromid", "requesterid", "sourceid", "srcid",  "tagid", "initiatorid",
                                "id1",    "uwbid1",      "txid",     "selfid", "from",  "id"};
constexpr std::array kSigmaNames{"sigma", "std", "stddev"};
constexpr std::array kVarianceNames{"covariance", "variance"};

/// to_id, toId and TO_ID are the same name.
std::string plain_name(const std::string& name) {
  std::string plain = lower_case(name);
  std::erase(plain, '_');
  return plain;
}

/// The values of one scope, by plain name.
using Values = std::map<std::string, RosValue>;

template <std::size_t kCount>
const RosValue* first_of(const Values& values, const std::array<const char*, kCount>& names) {
  for (const char* name : names)
    if (const auto found = values.find(name); found != values.end()) return &found->second;
  return nullptr;
}

/// An identifier as text: "7", or the text itself.
std::string id_of(const RosValue& value) {
  return value.text.empty() ? std::to_string(std::llround(value.number)) : value.text;
}

/// The other end of a range in a scope: in a list, id is that.
const RosValue* other_end(const Values& values, bool is_element) {
  if (const RosValue* to = first_of(values, kToNames)) return to;
  return is_element ? first_of(values, std::array{"id"}) : nullptr;
}

std::optional<double> sigma_of(const Values& values) {
  const RosValue* sigma = first_of(values, kSigmaNames);
  const RosValue* variance = first_of(values, kVarianceNames);
  const double number = sigma != nullptr      ? sigma->number
                        : variance != nullptr ? std::sqrt(std::max(variance->number, 0.0))
                                              : 0;
  return number > 0 && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

/// The range of a scope, if it has one; `message` has the values of the message itself.
std::optional<UwbRange> range_of(const Values& values, const Values& message, bool is_element) {
  const RosValue* range = first_of(values, kRangeNames);
  const RosValue* to = other_end(values, is_element);
  if (range == nullptr || to == nullptr) return std::nullopt;
  const RosValue* from =
      first_of(is_element && first_of(values, kToNames) == nullptr ? message : values, kFromNames);
  if (from == nullptr) from = first_of(message, kFromNames);
  const double unit_m = range->is_integer ? kMetresPerMillimetre : 1;
  return UwbRange{from == nullptr ? "" : id_of(*from), id_of(*to), range->number * unit_m, sigma_of(values)};
}

}  // namespace

bool has_uwb_ranges(const RosDefinition& definition) {
  std::map<std::string, Values> scopes;
  for (const std::string& name : definition.names()) {
    const std::size_t point = name.rfind('.');
    const std::string scope = point == std::string::npos ? "" : name.substr(0, point);
    scopes[scope][plain_name(point == std::string::npos ? name : name.substr(point + 1))];
  }
  return std::any_of(scopes.begin(), scopes.end(), [](const auto& scope) {
    return range_of(scope.second, scope.second, !scope.first.empty()).has_value();
  });
}

UwbMessage read_uwb_message(const RosDefinition& definition, const RosMessage& message) {
  UwbMessage read;
  std::map<std::string, Values> scopes;
  std::vector<std::string> order;
  definition.read(message, [&](const RosValue& value) {
    if (value.stamp && value.name == "stamp" && read.stamp == Stamp{}) read.stamp = *value.stamp;
    const auto [scope, is_new] = scopes.try_emplace(value.scope);
    if (is_new) order.push_back(value.scope);
    scope->second.emplace(plain_name(value.name), value);
  });
  for (const std::string& scope : order)
    if (const auto range = range_of(scopes[scope], scopes[""], !scope.empty())) read.ranges.push_back(*range);
  return read;
}

}  // namespace radioslam
