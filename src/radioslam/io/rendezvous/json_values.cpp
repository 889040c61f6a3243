#include "radioslam/io/rendezvous/json_values.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/suggestion.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kQuotedBytes = 40;
constexpr double kExactWhole = 9007199254740992;  ///< 2^53: larger doubles skip whole numbers

std::string in_quotes(std::string_view text) { return "'" + std::string(text.substr(0, kQuotedBytes)) + "'"; }

/// Whether a name differs from a member's by one letter in three, or by capitals.
bool is_misspelt(std::string_view name, std::string_view member) {
  constexpr std::size_t kLettersPerError = 3;
  const std::size_t allowed = std::max<std::size_t>(1, member.size() / kLettersPerError);
  if (name.size() > member.size() + allowed) return false;  // also bounds the cost
  return edit_distance(lower_case(name), lower_case(member)) <= allowed;
}

std::optional<double> number_of(const Json& json, const NumberKind& kind) {
  if (!json.is_number()) return std::nullopt;
  const auto value = json.get<double>();
  if (!(value >= kind.least && value <= kind.largest)) return std::nullopt;
  return value;
}

/// A program between two robots may have written it with a decimal point.
std::optional<std::uint64_t> whole_number_of(const Json& json, std::uint64_t largest) {
  std::uint64_t value = 0;
  if (json.is_number_unsigned()) {
    value = json.get<std::uint64_t>();
  } else if (json.is_number_float()) {
    const auto number = json.get<double>();
    if (!(number >= 0 && number <= kExactWhole) || number != std::floor(number)) return std::nullopt;
    value = static_cast<std::uint64_t>(number);
  } else {
    return std::nullopt;
  }
  if (value > largest) return std::nullopt;
  return value;
}

/// Bytes of memory that a value, a member's name and a list or object take at most while lists grow.
constexpr std::size_t kValueBytes = 64, kNameBytes = 96, kContainerBytes = 128;
/// A line may take so many times its bytes, and so much in any case.
constexpr std::size_t kJsonGrowth = 6, kFreeJsonBytes = 800'000;

/// Refuses JSON of very many very short values before it is read.
void refuse_many_values(std::string_view text) {
  std::size_t bytes = 0;
  bool in_string = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '"') in_string = !in_string;
    if (in_string) {
      k += c == '\\' ? 1 : 0;
      continue;
    }
    if (c == ',') bytes += kValueBytes;
    if (c == ':') bytes += kNameBytes;
    if (c == '[' || c == '{') bytes += kContainerBytes;
  }
  if (bytes > kJsonGrowth * text.size() + kFreeJsonBytes) refuse_json("too many values");
}

std::string whole_number_up_to(std::uint64_t largest) {
  return "a whole number from 0 to " + std::to_string(largest);
}

}  // namespace

bool is_robot_name(std::string_view name) {
  return is_record_name(name) && name.size() <= kLongestName && name != "*";
}

void refuse_json(const std::string& reason) { throw InputError("line", 0, reason); }

Json parse_json(std::string_view text) {
  refuse_many_values(text);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    refuse_json("not valid JSON at byte " + std::to_string(error.byte));
  } catch (const Json::out_of_range&) {
    refuse_json("a number is too large for a double");
  }
}

JsonObject::JsonObject(const Json& json, std::string name) : json_(json), name_(std::move(name)) {
  if (!json.is_object()) refuse_json(name_ + " is not an object");
}

void JsonObject::fail(std::string_view member, std::string_view what) const {
  refuse_json(in_quotes(member) + " of " + name_ + " is not " + std::string(what));
}

bool JsonObject::has(std::string_view member) const {
  asked_.push_back(member);
  const auto at = json_.find(member);
  return at != json_.end() && !at->is_null();
}

const Json& JsonObject::at(std::string_view member) const {
  asked_.push_back(member);
  const auto at = json_.find(member);
  if (at == json_.end()) refuse_json(name_ + " has no " + in_quotes(member));
  return *at;
}

void JsonObject::refuse_misspelt() const {
  constexpr std::size_t kMostMembers = 64;  // a line of more is no driver's, and would take long
  if (json_.size() > kMostMembers) return;
  for (const auto& entry : json_.items()) {
    if (std::find(asked_.begin(), asked_.end(), entry.key()) != asked_.end()) continue;
    for (const std::string_view member : asked_)
      if (is_misspelt(entry.key(), member))
        refuse_json(in_quotes(entry.key()) + " of " + name_ + " is not known; did you mean " +
                    std::string(member) + "?");
  }
}

double JsonObject::number(std::string_view member, const NumberKind& kind) const {
  const auto value = number_of(at(member), kind);
  if (!value) fail(member, kind.name);
  return *value;
}

std::uint64_t JsonObject::whole_number(std::string_view member, std::uint64_t largest) const {
  const auto value = whole_number_of(at(member), largest);
  if (!value) fail(member, whole_number_up_to(largest));
  return *value;
}

bool JsonObject::flag(std::string_view member) const {
  const Json& value = at(member);
  if (!value.is_boolean()) fail(member, "true or false");
  return value.get<bool>();
}

std::string JsonObject::robot(std::string_view member) const {
  const Json& value = at(member);
  if (!value.is_string() || !is_robot_name(value.get_ref<const std::string&>()))
    fail(member, "the name of a robot");
  return value.get<std::string>();
}

std::string JsonObject::robot_or_none(std::string_view member) const {
  const Json& value = at(member);
  return value.is_string() && value.get_ref<const std::string&>().empty() ? "" : robot(member);
}

const Json& JsonObject::list(std::string_view member) const {
  const Json& value = at(member);
  if (!value.is_array()) fail(member, "a list");
  return value;
}

SE2 JsonObject::pose(std::string_view member) const {
  const std::string name = in_quotes(member) + " of " + name_;
  return JsonRow(at(member), name, 3).pose();
}

JsonRow::JsonRow(const Json& json, std::string_view name, std::size_t length) : json_(json), name_(name) {
  if (!json.is_array() || json.size() != length)
    refuse_json(std::string(name_) + " is not a list of " + std::to_string(length));
}

void JsonRow::fail(std::string_view what) const {
  refuse_json("value " + std::to_string(place_) + " of " + std::string(name_) + " is not " +
              std::string(what));
}

double JsonRow::number(const NumberKind& kind) {
  const auto value = number_of(next(), kind);
  if (!value) fail(kind.name);
  return *value;
}

std::uint64_t JsonRow::whole_number(std::uint64_t largest) {
  const auto value = whole_number_of(next(), largest);
  if (!value) fail(whole_number_up_to(largest));
  return *value;
}

SE2 JsonRow::pose() {
  const double x = number(kMetres), y = number(kMetres);
  return {SE2::Point(x, y), number()};
}

}  // namespace radioslam
