#include "fuzzed.hpp"
#include "radioslam/io/datasets/wifine.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) { mission_of_wifine({{"a", text}}, "input"); });
}
