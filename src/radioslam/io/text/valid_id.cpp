#include "radioslam/io/text/valid_id.hpp"

#include <algorithm>

#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxId = 200;  // file names have at most 255 bytes

bool is_control_character(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

}  // namespace

bool is_valid_id(const std::string& id) {
  if (id.empty() || id.size() > kMaxId || id.front() == '.' || id.front() == '#') return false;
  if (id.find("..") != std::string::npos || trim(id) != id) return false;
  return id.find_first_of("/\\,\"") == std::string::npos &&
         std::none_of(id.begin(), id.end(), is_control_character);
}

}  // namespace radioslam
