#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/text/numbers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  const std::string token(data, data + size);
  if (const auto number = parse_number(token))
    RADIOSLAM_CHECK(parse_number(format_number(*number)) == number, "numbers are exact");
  if (const auto stamp = parse_stamp(token)) {
    RADIOSLAM_CHECK(parse_stamp(format_stamp(*stamp)) == stamp, "stamps are exact");
    RADIOSLAM_CHECK(parse_number(token).has_value(), "a time is a number");
  }
  if (const auto id = parse_id(token)) RADIOSLAM_CHECK(parse_number(token).has_value(), "an id is a number");
  return 0;
}
