#include "radioslam/io/live/live_address.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <memory>
#include <string_view>
#include <system_error>

#include "radioslam/base/input_error.hpp"

namespace radioslam {
namespace {

constexpr int kLastPort = 65535;
constexpr const char* kOption = "--live";

/// Why the socket cannot be had; 0 if it can.
int attempt(const addrinfo& at) {
  const int socket = ::socket(at.ai_family, at.ai_socktype | SOCK_CLOEXEC, at.ai_protocol);
  if (socket < 0) return errno;
  const int yes = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  const bool is_had = ::bind(socket, at.ai_addr, at.ai_addrlen) == 0 && ::listen(socket, 1) == 0;
  const int error = is_had ? 0 : errno;
  ::close(socket);
  return error;
}

std::string reason_of(int error) {
  if (error == EADDRINUSE) return "another program has that port";
  if (error == EADDRNOTAVAIL) return "this machine does not have that address";
  if (error == EACCES) return "that port is not for ordinary users";
  return std::generic_category().message(error);
}

}  // namespace

LiveAddress parse_live_address(const std::string& text) {
  LiveAddress address;
  const std::size_t colon = text.rfind(':');
  std::string host = colon == std::string::npos ? "" : text.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  else if (host.find_first_of("[]: /") != std::string::npos)
    host.clear();
  const char* end = text.data() + text.size();
  const char* begin = colon == std::string::npos ? text.data() : text.data() + colon + 1;
  const auto [stop, error] = std::from_chars(begin, end, address.port);
  const bool is_port = error == std::errc() && stop == end && address.port >= 0 && address.port <= kLastPort;
  if (!is_port || (colon != std::string::npos && host.empty()))
    throw InputError(kOption, 0, "'" + text + "' is no PORT, ADDRESS:PORT or [ADDRESS]:PORT");
  if (!host.empty()) address.host = host;
  return address;
}

bool is_loopback(const std::string& host) {
  in_addr v4{};
  const bool is_v4 = ::inet_pton(AF_INET, host.c_str(), &v4) == 1;
  return host == "localhost" || host == "::1" || (is_v4 && host.starts_with("127."));
}

std::string to_string(const LiveAddress& address) {
  const bool is_v6 = address.host.find(':') != std::string::npos;
  return (is_v6 ? '[' + address.host + ']' : address.host) + ':' + std::to_string(address.port);
}

std::string url_of(const LiveAddress& address, const std::string& token) {
  return "http://" + to_string(address) + '/' + (token.empty() ? "" : "?token=" + token);
}

void refuse_unusable(const LiveAddress& address) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int status =
      ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &found);
  if (status != 0) throw InputError(kOption, 0, to_string(address) + ": " + ::gai_strerror(status));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, &::freeaddrinfo);
  int error = 0;
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next)
    if (error = attempt(*at); error == 0) return;
  throw InputError(kOption, 0, to_string(address) + ": " + reason_of(error));
}

std::string drawn_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::system_error(errno, std::generic_category(), "a token cannot be drawn");
  std::string token;
  for (const unsigned byte : bytes) {
    token += "0123456789abcdef"[byte >> 4U];
    token += "0123456789abcdef"[byte & 15U];
  }
  return token;
}

std::string token_of(const LiveAddress& address, const std::string& given) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("._~-").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!std::all_of(given.begin(), given.end(), is_plain))
    throw InputError("--live-token", 0, "a token consists of letters, digits and ._~-");
  return given.empty() && !is_loopback(address.host) ? drawn_token() : given;
}

}  // namespace radioslam
