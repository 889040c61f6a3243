#include "radioslam/io/graph/jrl_object.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "radioslam/io/graph/information.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

std::string quoted(const char* member) { return "'" + std::string(member) + "'"; }

/// Places of [translation, rotation] in a tangent of the file.
template <class Pose>
constexpr auto kPlacesInFile = std::array<int, 3>{0, 1, 2};
template <>
constexpr auto kPlacesInFile<SE3> = std::array<int, 6>{3, 4, 5, 0, 1, 2};

}  // namespace

JrlObject::JrlObject(const Text& text, std::string name, const Json& json)
    : text_(&text), name_(std::move(name)), json_(&json) {
  if (!json.is_object()) fail("expected an object");
}

const JrlObject::Json& JrlObject::at(const char* member) const {
  const auto found = json_->find(member);
  if (found == json_->end()) fail(quoted(member) + " is missing");
  return *found;
}

const JrlObject::Json& JrlObject::array(const char* member) const {
  const Json& value = at(member);
  if (!value.is_array()) fail(quoted(member) + " is not a list");
  return value;
}

const JrlObject::Json& JrlObject::members(const char* member) const {
  const Json& value = at(member);
  if (!value.is_object()) fail(quoted(member) + " is not an object");
  return value;
}

JrlObject JrlObject::object(const char* member) const {
  return {*text_, name_ + ", " + quoted(member), at(member)};
}

std::string JrlObject::word(const char* member) const {
  const Json& value = at(member);
  if (!value.is_string()) fail(quoted(member) + " is not a text");
  return value.get<std::string>();
}

double JrlObject::number(const char* member) const {
  const Json& value = at(member);
  if (!value.is_number()) fail(quoted(member) + " is not a number");
  return value.get<double>();
}

double JrlObject::coordinate(const char* member) const {
  const double value = number(member);
  if (std::abs(value) > kMaxCoordinate_m) fail(quoted(member) + " is not plausible");
  return value;
}

std::uint64_t JrlObject::key(const char* member) const {
  const Json& value = at(member);
  if (!value.is_number_unsigned()) fail(quoted(member) + " is not a key");
  return value.get<std::uint64_t>();
}

template <int N>
Eigen::Matrix<double, N, 1> JrlObject::numbers(const char* member) const {
  const Json& list = array(member);
  const auto is_number = [](const Json& entry) { return entry.is_number(); };
  if (list.size() != N || !std::all_of(list.begin(), list.end(), is_number))
    fail(quoted(member) + " is not a list of " + std::to_string(N) + " numbers");
  Eigen::Matrix<double, N, 1> result;
  for (std::size_t k = 0; k < N; ++k) result[static_cast<Eigen::Index>(k)] = list[k].get<double>();
  return result;
}

template <>
SE2 JrlObject::pose() const {
  if (word("type") != "Pose2") fail("its type is not Pose2");
  return {{coordinate("x"), coordinate("y")}, number("theta")};
}

template <>
SE3 JrlObject::pose() const {
  if (word("type") != "Pose3") fail("its type is not Pose3");
  const Eigen::Vector3d position = numbers<3>("translation");
  if (position.cwiseAbs().maxCoeff() > kMaxCoordinate_m) fail("'translation' is not plausible");
  const Eigen::Vector4d wxyz = numbers<4>("rotation");
  const double norm = wxyz.stableNorm();
  if (std::abs(norm - 1) > kUnitQuaternionTolerance) fail(not_a_unit_quaternion(norm));
  return {position, Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3])};
}

template <class Pose>
typename Pose::Jacobian JrlObject::information() const {
  using Matrix = typename Pose::Jacobian;
  const Matrix stated(numbers<Pose::kDof * Pose::kDof>("covariance").data());
  const Matrix covariance = (stated + stated.transpose()) / 2;
  const auto& places = kPlacesInFile<Pose>;
  const auto information = information_of<Pose::kDof>(covariance(places, places));
  if (!information) fail("the covariance is not positive definite");
  return *information;
}

double JrlObject::sigma() const {
  const double variance = numbers<1>("covariance")[0];
  if (!(variance > 0)) fail("the covariance is not positive");
  return std::sqrt(variance);
}

template SE2::Jacobian JrlObject::information<SE2>() const;
template SE3::Jacobian JrlObject::information<SE3>() const;

}  // namespace radioslam
