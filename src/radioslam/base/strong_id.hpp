// Indices that cannot be mistaken for one another.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace radioslam {

/// An index into the container that `Tag` names.
template <class Tag>
struct StrongId {
  std::int32_t value = -1;

  constexpr StrongId() = default;
  constexpr explicit StrongId(std::int32_t v) : value(v) {}
  constexpr explicit StrongId(std::size_t v) : value(static_cast<std::int32_t>(v)) {}

  constexpr std::size_t index() const { return static_cast<std::size_t>(value); }
  constexpr bool valid() const { return value >= 0; }
  constexpr auto operator<=>(const StrongId&) const = default;
};

/// Index into Mission::robots.
using RobotIndex = StrongId<struct RobotTag>;

}  // namespace radioslam
