// Reads ROS messages of any type by the definition that recordings carry for it.
//
// A definition is text (wiki.ros.org/msg): lines `type name`, for ROS 1 and 2 alike; behind lines of '='
// follow those of the types it contains, each with `MSG: package/Type`.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {

/// One number, time or text in a message.
struct RosValue {
  std::string scope;  ///< "" for fields of the message itself, "nodes[2]." for those of an element
  std::string name;
  double number = 0;
  bool is_integer = false;
  std::optional<Stamp> stamp;  ///< for times; `number` is their seconds
  std::string text;            ///< for texts
};

class RosDefinition {
 public:
  /// Nothing if the text is empty or has a type that it does not define. `type` is the message's.
  static std::optional<RosDefinition> parse(const std::string& type, std::string_view text);

  /// The names of the fields of the message itself and of all types it contains: "id", "nodes.dis".
  std::vector<std::string> names() const;

  /// Passes the values of a message on, in their order. Refuses whatever the reader refuses.
  void read(const RosMessage& message, const std::function<void(const RosValue&)>& take) const;

 private:
  enum class Shape { kOne, kFixed, kCounted };
  struct Field {
    std::string type, name;
    Shape shape = Shape::kOne;
    std::size_t count = 1;
  };
  using Fields = std::vector<Field>;

  static std::optional<Field> parse_field(const std::string& package, const std::string& line);
  bool is_complete(const std::string& type, int depth) const;
  void add_names(const std::string& type, const std::string& scope, std::vector<std::string>& names) const;
  void read_fields(RosMessageReader& reader, const std::string& type, const std::string& scope,
                   const std::function<void(const RosValue&)>& take) const;

  std::string type_;
  std::map<std::string, Fields> types_;
};

}  // namespace radioslam
