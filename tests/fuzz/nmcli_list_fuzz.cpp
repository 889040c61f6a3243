#include "radioslam/io/wifi/nmcli_list.hpp"
#include "wifi_log_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_printed_list(data, size,
                           [](const Text& text) { return read_nmcli_lists(text, default_nmcli_fields()); });
}
