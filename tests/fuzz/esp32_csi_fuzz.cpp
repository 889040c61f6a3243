#include "csi_checks.hpp"
#include "fuzzed.hpp"
#include "radioslam/io/csi/esp32_csi.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  try {
    check_capture(read_esp32_csi("input", std::string(data, data + size)));
  } catch (const InputError&) {
  }
  return 0;
}
