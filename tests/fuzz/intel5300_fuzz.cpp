#include "csi_checks.hpp"
#include "fuzzed.hpp"
#include "radioslam/io/intel5300.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  try {
    check_capture(read_intel5300("input", std::string(data, data + size)));
  } catch (const InputError&) {
  }
  return 0;
}
