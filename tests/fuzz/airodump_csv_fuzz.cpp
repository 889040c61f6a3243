#include "radioslam/io/wifi/airodump_csv.hpp"
#include "wifi_log_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  try {
    check_wifi_log(read_airodump(make_tool_output("input", std::string(data, data + size)), {}));
  } catch (const InputError&) {
  }
  return 0;
}
