#include "radioslam/io/ros/ros_names.hpp"

namespace radioslam {
namespace {

bool is_digit_of_name(char c) { return c >= '0' && c <= '9'; }
bool is_character_of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit_of_name(c) || c == '_';
}

}  // namespace

std::string problem_with_ros_name(std::string_view name) {
  constexpr std::size_t kMaxName = 248;  // of 256 in DDS, whose names have a prefix
  if (name.empty()) return "is empty";
  if (name.size() > kMaxName) return "is longer than " + std::to_string(kMaxName) + " characters";
  if (name.ends_with('/')) return "ends with '/'";
  char before = '/';
  for (std::size_t k = name.front() == '/' ? 1 : 0; k < name.size(); before = name[k++]) {
    const char c = name[k];
    if (c == '/' && before == '/') return "has an empty part";
    if (c != '/' && !is_character_of_name(c))
      return "has a '" + std::string(1, c) + "'; ROS allows letters, digits, '_' and '/'";
    if (before == '/' && is_digit_of_name(c)) return "has a part that begins with a digit";
    if (c == '_' && before == '_') return "has two '_' in a row";
  }
  return {};
}

std::string resolved_ros_name(std::string_view name, std::string_view space) {
  if (name.starts_with('/')) return std::string(name);
  return std::string(space) + '/' + std::string(name);
}

std::string as_ros_name(std::string_view text) {
  std::string part;
  for (const char c : text) {
    if (part.empty() && is_digit_of_name(c)) part = "_";
    const char allowed = is_character_of_name(c) ? c : '_';
    if (allowed != '_' || !part.ends_with('_')) part += allowed;
  }
  return part.empty() ? "_" : part;
}

}  // namespace radioslam
