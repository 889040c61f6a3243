#include "radioslam/io/dds/dds_names.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kTopicPrefix = "rt/", kTypeMiddle = "::msg::dds_::", kRosMiddle = "/msg/";

}  // namespace

std::string dds_topic(std::string_view ros_topic) {
  if (ros_topic.starts_with('/')) ros_topic.remove_prefix(1);
  return std::string(kTopicPrefix) + std::string(ros_topic);
}

std::string dds_type(std::string_view ros_type) {
  const std::size_t first = ros_type.find('/'), last = ros_type.rfind('/');
  if (first == std::string_view::npos) return std::string(ros_type);
  return std::string(ros_type.substr(0, first)) + std::string(kTypeMiddle) +
         std::string(ros_type.substr(last + 1)) + "_";
}

std::string ros_topic(std::string_view dds_topic) {
  if (!dds_topic.starts_with(kTopicPrefix)) return std::string(dds_topic);
  return "/" + std::string(dds_topic.substr(kTopicPrefix.size()));
}

std::string ros_type(std::string_view dds_type) {
  const std::size_t middle = dds_type.find(kTypeMiddle);
  if (middle == std::string_view::npos || !dds_type.ends_with('_')) return std::string(dds_type);
  const std::string_view name = dds_type.substr(middle + kTypeMiddle.size());
  return std::string(dds_type.substr(0, middle)) + std::string(kRosMiddle) +
         std::string(name.substr(0, name.size() - 1));
}

}  // namespace radioslam
