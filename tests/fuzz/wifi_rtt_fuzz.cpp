#include "fuzzed.hpp"
#include "radioslam/io/datasets/wifi_rtt.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    // The files of the anchors, of the phones and of the ranges between them, separated by lines of '%'.
    WifiRttFiles files;
    std::string content = text.content;
    std::vector<Text> parts;
    for (std::size_t end = content.find('%'); end != std::string::npos; end = content.find('%')) {
      parts.push_back(make_text("part", content.substr(0, end)));
      content.erase(0, end + 1);
    }
    if (!content.empty()) files.phones.push_back(make_text("phone", content));
    if (!parts.empty()) files.phones.push_back(parts[0]);
    if (parts.size() > 1) files.anchors = parts[1];
    if (parts.size() > 2) files.between = parts[2];
    mission_of_wifi_rtt(files, "input");
  });
}
