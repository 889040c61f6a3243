// Domains for tests: on the loopback interface without multicast, with a number that other tests of the same
// time do not have.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "radioslam/io/dds/dds_config.hpp"

namespace radioslam {

/// Held, as long as this process lives, by a socket of this name, which needs no file.
inline bool hold_domain(std::uint32_t domain) {
  const std::string name = "radioslam test domain " + std::to_string(domain);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path + 1, sizeof(address.sun_path) - 1);
  const int held = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (::bind(held, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return true;
  ::close(held);
  return false;
}

inline std::uint32_t test_domain() {
  constexpr std::uint32_t kDomains = 90;  // whose ports are below those that the kernel gives away
  static const std::uint32_t kDomain = [] {
    std::uint32_t domain = 1;
    while (domain < kDomains && !hold_domain(domain)) ++domain;
    return domain;
  }();
  return kDomain;
}

inline DdsConfig test_config() {
  DdsConfig config;
  config.domain = test_domain();
  config.interface = "127.0.0.1";
  config.peers = {"127.0.0.1"};
  return config;
}

/// Waits until something is so; false if it is not after that many seconds.
inline bool becomes_true(const std::function<bool()>& condition, double seconds = 90) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace radioslam
