#include "radioslam/io/wifi/wifi_capture.hpp"
#include "wifi_log_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  for (const bool every_frame : {false, true}) {
    WifiCaptureParams params;
    params.every_frame = every_frame;
    params.scan_s = every_frame ? 1 : 0;
    try {
      check_wifi_log(read_wifi_capture("input", std::string(data, data + size), params));
    } catch (const InputError&) {
    }
  }
  return 0;
}
