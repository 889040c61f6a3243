#include "radioslam/io/ros/ros_definition.hpp"

#include <sstream>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr int kMaxDepth = 8;
constexpr std::size_t kMaxCount = 1 << 16;

bool is_time(const std::string& type) {
  return type == "time" || type == "duration" || type == "builtin_interfaces/Time" ||
         type == "builtin_interfaces/Duration";
}

bool is_text(const std::string& type) { return type == "string"; }

using ReadNumber = double (*)(RosMessageReader&);

/// The reader of a type of numbers; null for another type.
ReadNumber number_reader(const std::string& type) {
  static const std::map<std::string, ReadNumber> kReaders{
      {"bool", [](RosMessageReader& r) { return static_cast<double>(r.u8()); }},
      {"byte", [](RosMessageReader& r) { return static_cast<double>(r.u8()); }},
      {"char", [](RosMessageReader& r) { return static_cast<double>(r.u8()); }},
      {"uint8", [](RosMessageReader& r) { return static_cast<double>(r.u8()); }},
      {"int8", [](RosMessageReader& r) { return static_cast<double>(static_cast<std::int8_t>(r.u8())); }},
      {"uint16", [](RosMessageReader& r) { return static_cast<double>(r.u16()); }},
      {"int16", [](RosMessageReader& r) { return static_cast<double>(static_cast<std::int16_t>(r.u16())); }},
      {"uint32", [](RosMessageReader& r) { return static_cast<double>(r.u32()); }},
      {"int32", [](RosMessageReader& r) { return static_cast<double>(r.i32()); }},
      {"uint64", [](RosMessageReader& r) { return static_cast<double>(r.u64()); }},
      {"int64", [](RosMessageReader& r) { return static_cast<double>(static_cast<std::int64_t>(r.u64())); }},
      {"float32", [](RosMessageReader& r) { return static_cast<double>(r.f32()); }},
      {"float64", [](RosMessageReader& r) { return r.f64(); }}};
  const auto found = kReaders.find(type);
  return found == kReaders.end() ? nullptr : found->second;
}

bool is_simple(const std::string& type) {
  return is_time(type) || is_text(type) || number_reader(type) != nullptr;
}

/// The full name of a type used in a definition of this package.
std::string full_type(const std::string& package, const std::string& type) {
  if (type == "Header") return "std_msgs/Header";
  return is_simple(type) || type.find('/') != std::string::npos ? short_type(type) : package + '/' + type;
}

std::string package_of(const std::string& type) { return type.substr(0, type.find('/')); }

}  // namespace

std::optional<RosDefinition::Field> RosDefinition::parse_field(const std::string& package,
                                                               const std::string& line) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::string type, name, rest;
  if (!(words >> type >> name)) return std::nullopt;
  words >> rest;
  if (name.find('=') != std::string::npos || rest.starts_with('=')) return std::nullopt;  // a constant
  Field field;
  field.name = name;
  if (const std::size_t bracket = type.find('['); bracket != std::string::npos) {
    const auto count = parse_integer(type.substr(bracket + 1, type.find(']') - bracket - 1));
    field.shape = count && *count >= 0 ? Shape::kFixed : Shape::kCounted;  // T[], T[<=N] or T[N]
    if (field.shape == Shape::kFixed) field.count = static_cast<std::size_t>(*count);
    if (field.count > kMaxCount) return Field{"a list that is too long", name};
    type.resize(bracket);
  }
  type = type.substr(0, type.find("<="));  // a bounded text
  field.type = full_type(package, type);
  return field;
}

std::optional<RosDefinition> RosDefinition::parse(const std::string& type, std::string_view text) {
  RosDefinition definition;
  definition.type_ = type;
  std::string current = type;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("=")) continue;
    if (line.starts_with("MSG:")) {
      std::istringstream(line.substr(4)) >> current;
      current = short_type(current);
      definition.types_[current];
    } else if (const auto field = parse_field(package_of(current), line)) {
      definition.types_[current].push_back(*field);
    }
  }
  if (!definition.types_.contains(type) || !definition.is_complete(type, 0)) return std::nullopt;
  return definition;
}

bool RosDefinition::is_complete(const std::string& type, int depth) const {
  const auto fields = types_.find(type);
  if (fields == types_.end() || depth > kMaxDepth) return false;
  for (const Field& field : fields->second)
    if (!is_simple(field.type) && !is_complete(field.type, depth + 1)) return false;
  return true;
}

std::vector<std::string> RosDefinition::names() const {
  std::vector<std::string> names;
  add_names(type_, "", names);
  return names;
}

void RosDefinition::add_names(const std::string& type, const std::string& scope,
                              std::vector<std::string>& names) const {
  for (const Field& field : types_.at(type))
    if (is_simple(field.type))
      names.push_back(scope + field.name);
    else
      add_names(field.type, scope + field.name + '.', names);
}

void RosDefinition::read(const RosMessage& message, const std::function<void(const RosValue&)>& take) const {
  RosMessageReader reader(message);
  read_fields(reader, type_, "", take);
}

void RosDefinition::read_fields(RosMessageReader& reader, const std::string& type, const std::string& scope,
                                const std::function<void(const RosValue&)>& take) const {
  for (const Field& field : types_.at(type)) {
    const std::size_t count = field.shape == Shape::kCounted ? reader.count(1) : field.count;
    for (std::size_t k = 0; k < count; ++k) {
      const std::string element = field.shape == Shape::kOne ? "" : '[' + std::to_string(k) + ']';
      if (!is_simple(field.type)) {
        read_fields(reader, field.type, scope + field.name + element + '.', take);
        continue;
      }
      RosValue value{scope, field.name + element, 0, false, std::nullopt, ""};
      if (is_text(field.type)) {
        value.text = reader.text();
      } else if (is_time(field.type)) {
        const std::int64_t seconds = reader.i32();
        value.stamp = Stamp{seconds * kNanosecondsPerSecond + reader.u32()};
      } else {
        value.number = number_reader(field.type)(reader);
        value.is_integer = !field.type.starts_with("float");
      }
      take(value);
    }
  }
}

}  // namespace radioslam
