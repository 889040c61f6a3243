// Domains for tests: on the loopback interface without multicast, with a number that other tests of the same
// time do not have.
#pragma once

#include <unistd.h>

#include <chrono>
#include <functional>
#include <thread>

#include "radioslam/io/dds/dds_config.hpp"

namespace radioslam {

inline std::uint32_t test_domain() { return 1 + static_cast<std::uint32_t>(::getpid()) % 200; }

inline DdsConfig test_config() {
  DdsConfig config;
  config.domain = test_domain();
  config.interface = "127.0.0.1";
  config.peers = {"127.0.0.1"};
  return config;
}

/// Waits until something is so; false if it is not after that many seconds.
inline bool becomes_true(const std::function<bool()>& condition, double seconds = 20) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace radioslam
