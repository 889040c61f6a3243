#include "radioslam/base/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace radioslam {

void check_failed(std::string_view condition, std::string_view message, const char* file, int line) {
  std::fprintf(stderr, "radioslam: internal error at %s:%d: %.*s (%.*s)\n", file, line,
               static_cast<int>(message.size()), message.data(), static_cast<int>(condition.size()),
               condition.data());
  std::abort();
}

}  // namespace radioslam
