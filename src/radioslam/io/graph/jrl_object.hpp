// Members of the JSON objects of a JRL file; errors name the object.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

class JrlObject {
 public:
  using Json = nlohmann::ordered_json;

  /// `name` is for error messages: "measurement 2 of entry 5 of robot a". Refuses other values than objects.
  JrlObject(const Text& text, std::string name, const Json& json);

  bool has(const char* member) const { return json_->contains(member); }
  /// Each of these refuses a missing member, and one of another kind.
  const Json& array(const char* member) const;
  const Json& members(const char* member) const;
  JrlObject object(const char* member) const;
  std::string word(const char* member) const;
  double number(const char* member) const;
  /// Metres, at most kMaxCoordinate_m.
  double coordinate(const char* member) const;
  std::uint64_t key(const char* member) const;
  /// The members of an object of type Pose2 or Pose3.
  template <class Pose>
  Pose pose() const;
  /// Inverse of `covariance`, in the order [translation, rotation]; refuses one that is not positive
  /// definite.
  template <class Pose>
  typename Pose::Jacobian information() const;
  /// Root of a `covariance` of one number; refuses one that is not positive.
  double sigma() const;

  [[noreturn]] void fail(const std::string& reason) const { text_->fail(0, name_ + ": " + reason); }

 private:
  const Json& at(const char* member) const;
  /// The numbers of an array of this length.
  template <int N>
  Eigen::Matrix<double, N, 1> numbers(const char* member) const;

  const Text* text_;
  std::string name_;
  const Json* json_;
};

}  // namespace radioslam
