#include "csi_checks.hpp"
#include "fuzzed.hpp"
#include "radioslam/io/csi/csi_capture.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  try {
    check_capture(read_csi_capture("input", std::string(data, data + size)));
  } catch (const InputError&) {
  }
  return 0;
}
