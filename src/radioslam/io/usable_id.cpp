#include "radioslam/io/usable_id.hpp"

#include <algorithm>

#include "radioslam/io/text.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kLongestId = 200;  // a file's name has 255 bytes

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

}  // namespace

bool is_usable_id(const std::string& id) {
  if (id.empty() || id.size() > kLongestId || id.front() == '.' || id.front() == '#') return false;
  if (id.find("..") != std::string::npos || trim(id) != id) return false;
  return id.find_first_of("/\\,\"") == std::string::npos && std::none_of(id.begin(), id.end(), is_control);
}

}  // namespace radioslam
